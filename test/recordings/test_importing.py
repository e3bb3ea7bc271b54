# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Videos and frame folders as recordings, and every fault they can have."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from recording_samples import frame_of
from small_recordings import write_video

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.importing import import_recording

HEADER = "frame,x,y,w,h,visible,occ\n"


@pytest.fixture
def frame_folder(tmp_path):
    """Make a frame folder; None leaves a file out."""

    def make(numbers=(1, 2, 3), fps=25.0, truth=None, extension="jpg"):
        folder = tmp_path / "frames"
        (folder / "img").mkdir(parents=True)
        for number in numbers:
            path = folder / "img" / f"{number:06d}.{extension}"
            assert cv2.imwrite(str(path), frame_of(number)[..., ::-1])
        if fps is not None:
            (folder / "sequence.json").write_text(json.dumps({"fps": fps}))
        if truth is not None:
            (folder / "groundtruth.csv").write_text(truth)
        return folder

    return make


def rows(count=3):
    return HEADER + "".join(f"{n},{n}.5,2.0,7.0,5.0,1,0\n" for n in range(1, count + 1))


def test_jpeg_files_keep_their_bytes(frame_folder, tmp_path):
    folder = frame_folder()
    summary, notices = import_recording(folder, tmp_path / "bag")
    recording = Recording(tmp_path / "bag")
    assert recording.image_topic == messages.COMPRESSED_TOPIC
    for number, message in enumerate(recording.messages({messages.COMPRESSED_TOPIC}), start=1):
        assert (folder / "img" / f"{number:06d}.jpg").read_bytes() in message.data
    assert summary == "3 frames of 32x24 px at 25 frames/s, 0 with truth"
    assert not notices
    assert recording.truth() == ()


def test_raw_and_compressed_imports_show_the_same_pixels(frame_folder, tmp_path):
    folder = frame_folder(truth=rows())
    import_recording(folder, tmp_path / "a", format="compressed")
    import_recording(folder, tmp_path / "b", format="raw")
    compressed, raw = Recording(tmp_path / "a"), Recording(tmp_path / "b")
    assert raw.image_topic == messages.IMAGE_TOPIC
    for one, other in zip(compressed.frames(), raw.frames(), strict=True):
        assert one.stamp_ns == other.stamp_ns
        assert np.array_equal(one.frame, other.frame)
    assert compressed.truth() == raw.truth()


@pytest.mark.parametrize(
    ("wanted", "kind"), [(None, messages.IMAGE), ("compressed", messages.COMPRESSED_IMAGE)]
)
def test_png_files_are_raw_unless_asked_otherwise(frame_folder, tmp_path, wanted, kind):
    import_recording(frame_folder(extension="png"), tmp_path / "bag", format=wanted)
    recording = Recording(tmp_path / "bag")
    assert recording.image_type == kind
    for number, found in enumerate(recording.frames(), start=1):
        assert np.array_equal(found.frame, frame_of(number))


def test_stamps_begin_at_one_second_and_do_not_drift(frame_folder, tmp_path):
    numbers = range(1, 32)
    import_recording(frame_folder(numbers, fps=29.97), tmp_path / "bag")
    stamps = [found.stamp_ns for found in Recording(tmp_path / "bag").frames()]
    assert stamps[0] == 1_000_000_000
    assert stamps[1] == 1_033_366_700  # 1e9 / 29.97 = 33366700.03
    assert stamps[30] == 2_001_001_001  # 30e9 / 29.97 = 1001001001.0


def test_a_gap_in_the_numbers_is_a_gap_in_time(frame_folder, tmp_path):
    folder = frame_folder((5, 6, 9), truth=HEADER + "6,1,2,3,4,1,1\n9,1,2,3,4,0,2\n7,1,1,1,1,1,0\n")
    _, notices = import_recording(folder, tmp_path / "bag")
    recording = Recording(tmp_path / "bag")
    assert [f.stamp_ns for f in recording.frames()] == [1_000_000_000, 1_040_000_000, 1_160_000_000]
    assert [t.stamp_ns for t in recording.truth()] == [1_040_000_000, 1_160_000_000]
    assert [t.occlusion for t in recording.truth()] == [Occlusion.PARTIAL, Occlusion.TOTAL]
    assert notices == ["frames of the truth without an image: 1"]


def test_truth_is_exact_and_rows_without_a_box_are_no_truth(frame_folder, tmp_path):
    truth = (
        "\ufeffframe, x,y,w,h,occ\n1,10.5,20,30,40,2\n2,nan,nan,nan,nan,0\n3,,,,,\n4,1,2,0,0,0\n"
    )
    summary, _ = import_recording(frame_folder(range(1, 7), truth=truth), tmp_path / "bag")
    (found,) = Recording(tmp_path / "bag").truth()
    assert found.box == Box(10.5, 20, 30, 40)
    assert found.occlusion is Occlusion.TOTAL
    assert found.visible_fraction is None
    assert summary.startswith("6 frames")
    assert summary.endswith(" 1 with truth")


@pytest.mark.parametrize(
    ("truth", "said"),
    [
        ("", "is empty"),
        (HEADER, "holds no box"),
        (HEADER + "1,nan,nan,nan,nan,1,0\n", "holds no box"),
        ("frame,x,y,w\n1,2,3,4\n", "lacks the column h"),
        (HEADER + "1,two,3,4,5,1,0\n", "line 2 of .* 'two' as x"),
        (HEADER + "1.5,2,3,4,5,1,0\n", "line 2 of .* no integer"),
        (HEADER + ",2,3,4,5,1,0\n", "line 2 of .* no integer"),
        (HEADER + "1,2,3,4,5,1,7\n", "line 2 of .* occ 7"),
        (HEADER + "1,2,3,4,5,1,0\n1,2,3,4,5,1,0\n", "line 3 of .* frame 1 a second time"),
        (HEADER + "70,2,3,4,5,1,0\n", "no frame of the truth .* has an image"),
    ],
)
def test_faulty_truth_is_named(frame_folder, tmp_path, truth, said):
    with pytest.raises(InputError, match=said):
        import_recording(frame_folder(truth=truth), tmp_path / "bag")
    assert not (tmp_path / "bag").exists()


TABLE = [[1, 10.5, 2, 7, 5], [2, 11.5, 2, 7, 5], [3, 12.5, 2, 7, 5]]
NAMES = ["frame", "x", "y", "w", "h"]


def table(delimiter=",", decimal=".", quoted="", names=NAMES, rows=TABLE):
    def line(cells):
        shown = [str(cell).replace(".", decimal) for cell in cells]
        strings = [f'"{cell}"' if quoted in {"all", "names"} else cell for cell in shown]
        return delimiter.join(strings if cells is names or quoted == "all" else shown)

    return "".join(line(cells) + "\n" for cells in [names, *rows])


NUMBERED = [[n, *row] for n, row in enumerate(TABLE, start=1)]


@pytest.mark.parametrize(
    "text",
    [
        table(quoted="names"),  # as of R's write.csv without row names
        table(quoted="all"),  # as of pandas with QUOTE_ALL
        table(quoted="all").replace("\n", "\r\n"),
        table(quoted="names", names=["", *NAMES], rows=NUMBERED),  # as of R's write.csv
        table(names=["", *NAMES], rows=NUMBERED),  # as of pandas with its index
        table(names=[*NAMES, "note"], rows=[[*row, "a"] for row in TABLE]),
        table(names=[name.upper() for name in NAMES]),
        table(";"),
        table(";", ","),  # as of a spreadsheet in German
        table(";", ",", "all"),
        table("\t", ","),
        table("\t"),
        table(" "),
        table(", "),
        "# made by hand\n" + table(),
    ],
)
def test_our_table_is_read_however_its_cells_are_written(frame_folder, tmp_path, text):
    import_recording(frame_folder(truth=text), tmp_path / "bag")
    boxes = [truth.box for truth in Recording(tmp_path / "bag").truth()]
    assert boxes == [Box(10.5, 2, 7, 5), Box(11.5, 2, 7, 5), Box(12.5, 2, 7, 5)]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (table(" ", ",").replace('"', ""), "line 2 of"),  # 1 10,5 2 7 5: two meanings
        ("frame x y w h\n1 1 10.5 2 7 5\n", "line 2 of .* has 6 cells, the first line names 5"),
        (table().replace("10.5", "10;5"), "line 2 of"),
        (table(";").replace("10.5", "1.010,5"), "line 2 of .* '1.010,5' as x"),
        (table().replace("10.5", '"1,010"'), "line 2 of .* '1,010' as x"),
    ],
)
def test_cells_that_may_be_other_numbers_are_refused(frame_folder, tmp_path, text, said):
    with pytest.raises(InputError, match=said):
        import_recording(frame_folder(truth=text), tmp_path / "bag")


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("1,0.3,0.1,0.2,0.2", "all 1 boxes are below one px; are they shares"),
        ("1,320,100,70,50", "no box lies in the image of 32x24 px; are they of another"),
        ("1,-20,2,7,5", "no box lies in the image"),
    ],
)
def test_truth_that_fits_no_image_is_refused(frame_folder, tmp_path, rows, said):
    with pytest.raises(InputError, match=said):
        import_recording(frame_folder(truth=f"frame,x,y,w,h\n{rows}\n"), tmp_path / "bag")


def test_corners_that_are_taken_for_sizes_are_said(frame_folder, tmp_path):
    corners = "frame,x,y,w,h\n1,2,2,9,7\n2,20,2,27,7\n3,22,2,29,7\n"
    _, notices = import_recording(frame_folder(truth=corners), tmp_path / "bag")
    assert any("2 of 3 boxes reach beyond the image of 32x24 px" in one for one in notices)
    edge = "frame,x,y,w,h\n1,2,2,9,7\n2,20,2,13,7\n3,25,2,8,7\n"
    shutil.rmtree(tmp_path / "frames")
    shutil.rmtree(tmp_path / "bag")
    assert not import_recording(frame_folder(truth=edge), tmp_path / "bag")[1]


def test_truth_that_is_no_text_is_named(frame_folder, tmp_path):
    folder = frame_folder()
    (folder / "groundtruth.csv").write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(InputError, match="is not text"):
        import_recording(folder, tmp_path / "bag")


def test_an_unreadable_image_is_named_and_nothing_is_left(frame_folder, tmp_path):
    folder = frame_folder()
    image = folder / "img" / "000002.jpg"
    whole = image.read_bytes()
    for content in (b"", b"no image", whole[: len(whole) // 2]):
        image.write_bytes(content)
        with pytest.raises(InputError, match=r"000002\.jpg cannot be read"):
            import_recording(folder, tmp_path / "bag")
        assert [path.name for path in tmp_path.iterdir()] == ["frames"]


def test_images_of_two_sizes_or_one_number_are_refused(frame_folder, tmp_path):
    folder = frame_folder()
    cv2.imwrite(str(folder / "img" / "000004.jpg"), frame_of(4, 20, 20))
    with pytest.raises(InputError, match=r"000004\.jpg is 20x20 px, those before it 32x24"):
        import_recording(folder, tmp_path / "bag")
    shutil.copy(folder / "img" / "000001.jpg", folder / "img" / "1.jpg")
    with pytest.raises(InputError, match="the same number"):
        import_recording(folder, tmp_path / "bag")


def test_what_cannot_be_imported_is_said(frame_folder, tmp_path):
    with pytest.raises(InputError, match="no file or folder"):
        import_recording(tmp_path / "nothing", tmp_path / "bag")
    with pytest.raises(InputError, match="has no images"):
        import_recording(tmp_path, tmp_path / "bag")
    folder = frame_folder()
    with pytest.raises(InputError, match="compressed, raw"):
        import_recording(folder, tmp_path / "bag", format="zip")
    import_recording(folder, tmp_path / "bag")
    with pytest.raises(InputError, match="a recording already"):
        import_recording(tmp_path / "bag", tmp_path / "again")
    with pytest.raises(InputError, match="not empty"):
        import_recording(folder, tmp_path / "bag")
    summary, _ = import_recording(folder, tmp_path / "bag", overwrite=True)
    assert summary.startswith("3 frames")


@pytest.fixture
def video(tmp_path):
    """A video of 20 frames, each of another brightness, at 12.5 frames per second."""
    frames = [np.full((48, 64, 3), (200, 0, 10 * index), np.uint8) for index in range(20)]
    return write_video(tmp_path / "video.avi", frames, 12.5)


@pytest.mark.parametrize("wanted", [None, "raw"])
def test_a_video_becomes_a_recording(video, tmp_path, wanted):
    totals = []
    summary, notices = import_recording(
        video, tmp_path / "bag", format=wanted, progress=lambda _, total: totals.append(total)
    )
    recording = Recording(tmp_path / "bag")
    frames = list(recording.frames())
    assert summary.startswith("20 frames of ")
    assert " at 12.5 frames/s" in summary
    assert not notices
    assert totals == [20] * 20
    assert [f.stamp_ns for f in frames] == [1_000_000_000 + n * 80_000_000 for n in range(20)]
    assert recording.image_type == (messages.COMPRESSED_IMAGE if wanted is None else messages.IMAGE)
    for index, found in enumerate(frames):
        expected = (200, 0, 10 * index)
        assert np.abs(found.frame.astype(int) - expected).max() <= 6


def test_what_is_no_video_is_said_in_one_line(tmp_path, video):
    """No decoder may chatter on the terminal beside the sentence."""
    (tmp_path / "text.mp4").write_text("no video at all")
    (tmp_path / "empty.mp4").write_bytes(b"")
    (tmp_path / "cut.avi").write_bytes(video.read_bytes()[:300])
    script = (
        "import sys; from pathlib import Path\n"
        "from vehicle_pf_tracker.core.errors import InputError\n"
        "from vehicle_pf_tracker.recordings.importing import import_recording\n"
        "try: import_recording(Path(sys.argv[1]), Path(sys.argv[2]))\n"
        "except InputError as error: print(error)\n"
    )
    (tmp_path / "text001.mp4").write_text("a number makes OpenCV look for a series of images")
    for name in ("text.mp4", "empty.mp4", "cut.avi", "text001.mp4"):
        done = subprocess.run(
            [sys.executable, "-c", script, tmp_path / name, tmp_path / "bag"],
            capture_output=True,
            text=True,
            check=True,
            cwd=Path(__file__).parents[2],
        )
        assert done.stderr == ""
        assert name in done.stdout
        assert done.stdout.count("\n") == 1


def test_a_video_shorter_than_it_states_is_imported_with_a_notice(video, tmp_path):
    whole = video.read_bytes()
    video.write_bytes(whole[: int(0.6 * len(whole))])
    summary, notices = import_recording(video, tmp_path / "bag")
    assert 0 < int(summary.partition(" ")[0]) < 20
    assert "states 20 frames" in notices[0]


def truth_file(tmp_path, *lines):
    path = tmp_path / "truth.csv"
    path.write_text("\n".join(["frame,x,y,w,h,occ", *lines]) + "\n")
    return path


def test_a_video_takes_its_truth_from_a_table(video, tmp_path):
    truth = truth_file(tmp_path, "1,2,3,8,6,0", "3,4,3,8,6,2", "25,9,3,8,6,0")
    summary, notices = import_recording(video, tmp_path / "bag", truth=truth)
    assert summary.endswith(" 2 with truth")
    assert notices == ["frames of the truth without an image: 1"]
    first, third = Recording(tmp_path / "bag").truth()
    assert (first.box, first.occlusion) == (Box(2, 3, 8, 6), Occlusion.NONE)
    assert (third.box, third.occlusion) == (Box(4, 3, 8, 6), Occlusion.TOTAL)
    stamps = [image.stamp_ns for image in Recording(tmp_path / "bag").frames()]
    assert [first.stamp_ns, third.stamp_ns] == [stamps[0], stamps[2]]


def test_truth_that_is_not_there_is_named(video, tmp_path):
    with pytest.raises(InputError, match="cannot read the truth"):
        import_recording(video, tmp_path / "bag", truth=tmp_path / "none.csv")

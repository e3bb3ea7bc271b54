# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Input that once hung, or ended in a traceback: each is one sentence now."""

import json
import os

import cv2
import pytest
import yaml
from recording_samples import frame_of, stamp_of, truth_of

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.recordings.importing import import_recording

NESTED = "[" * 100_000
BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)


pytestmark = pytest.mark.usefixtures("no_hang")


@pytest.fixture
def bag(tmp_path):
    with RecordingWriter(tmp_path / "bag") as writer:
        for index in range(3):
            writer.write_image(stamp_of(index), frame_of(index))
            writer.write_truth(truth_of(index))
    return tmp_path / "bag"


@pytest.fixture
def frames(tmp_path):
    (tmp_path / "frames" / "img").mkdir(parents=True)
    for number in (1, 2):
        cv2.imwrite(str(tmp_path / "frames" / "img" / f"{number:06d}.jpg"), frame_of(number))
    (tmp_path / "frames" / "sequence.json").write_text('{"fps": 25}')
    return tmp_path / "frames"


def refused(said, call, *words):
    with pytest.raises(InputError, match=said) as caught:
        call(*words)
    assert len(str(caught.value)) < 400


def change_metadata(bag, **changed):
    path = bag / "metadata.yaml"
    document = yaml.safe_load(path.read_text())
    document["rosbag2_bagfile_information"] |= changed
    path.write_text(yaml.safe_dump(document))


@pytest.mark.parametrize(
    "fps",
    [0, -1, "fast", True, None, 1e-300, 9e-5, 1.1e6, 1e300, float("inf"), float("nan"), 10**400],
)
def test_frame_rates_that_no_camera_has(frames, tmp_path, fps):
    (frames / "sequence.json").write_text(json.dumps({"fps": fps}))
    refused(r"sequence\.json must be a number from", import_recording, frames, tmp_path / "out")


@pytest.mark.parametrize("fps", [1e-4, 1e6])
def test_frame_rates_at_the_limits(frames, tmp_path, fps):
    (frames / "sequence.json").write_text(json.dumps({"fps": fps}))
    import_recording(frames, tmp_path / "out")
    stamps = [image.stamp_ns for image in Recording(tmp_path / "out").frames()]
    assert stamps[1] - stamps[0] == round(1e9 / fps)


@pytest.mark.parametrize(
    "text",
    ["", "[1]", "3", "{}", "{", NESTED, '{"fps": ' + "1" * 5000 + "}", '{"fps": ' + NESTED],
)
def test_json_without_a_frame_rate(frames, tmp_path, text):
    (frames / "sequence.json").write_text(text)
    refused("does not state the frame rate", import_recording, frames, tmp_path / "out")


def test_an_image_number_of_forty_digits(frames, tmp_path):
    (frames / "img" / "000002.jpg").rename(frames / "img" / f"{'9' * 40}.jpg")
    refused("later than the last time", import_recording, frames, tmp_path / "out")


def test_the_last_number_that_ros_can_stamp(frames, tmp_path):
    (frames / "sequence.json").write_text('{"fps": 1}')
    last = 2**31 - 1  # at one image a second, and with the first image at 1 s
    (frames / "img" / "000002.jpg").rename(frames / "img" / f"{last}.jpg")
    import_recording(frames, tmp_path / "out")
    assert Recording(tmp_path / "out").end_ns == (2**31 - 1) * 10**9
    (frames / "img" / f"{last}.jpg").rename(frames / "img" / f"{last + 1}.jpg")
    refused("later than the last time", import_recording, frames, tmp_path / "more")


@pytest.mark.parametrize("column", range(4))
def test_truth_of_huge_numbers(frames, tmp_path, column):
    cells = ["2", "3", "4", "5"]
    cells[column] = "1e308"
    (frames / "groundtruth.csv").write_text(f"frame,x,y,w,h\n1,{','.join(cells)}\n")
    refused("beyond 16777216 px", import_recording, frames, tmp_path / "out")


@pytest.mark.parametrize("name", ["img/000002.jpg", "sequence.json", "groundtruth.csv"])
def test_pipes_among_the_frames(frames, tmp_path, name):
    (frames / name).unlink(missing_ok=True)
    os.mkfifo(frames / name)
    refused("is not a regular file", import_recording, frames, tmp_path / "out")


def test_pipes_instead_of_videos_and_recordings(tmp_path):
    for name in ("clip.mp4", "bag.mcap"):
        os.mkfifo(tmp_path / name)
    refused("is not a regular file", import_recording, tmp_path / "clip.mp4", tmp_path / "out")
    refused("is not a regular file", Recording, tmp_path / "bag.mcap")


def test_a_folder_whose_only_file_is_a_pipe(tmp_path):
    (tmp_path / "bag").mkdir()
    os.mkfifo(tmp_path / "bag" / "bag_0.mcap")
    refused("holds no recording", Recording, tmp_path / "bag")


@pytest.mark.parametrize("outside", ["../other/bag_0.mcap", "/etc/hostname", "a/../../b.mcap"])
def test_files_outside_of_the_folder_are_not_read(bag, outside):
    change_metadata(bag, relative_file_paths=["bag_0.mcap", outside])
    refused("outside of its folder", Recording, bag)


def test_files_in_folders_below_are_read(bag):
    (bag / "parts").mkdir()
    (bag / "bag_0.mcap").rename(bag / "parts" / "bag_0.mcap")
    change_metadata(bag, relative_file_paths=["parts/bag_0.mcap"])
    assert Recording(bag).frame_count == 3


@pytest.mark.parametrize(
    "text", [NESTED, "a: " + "1" * 5000, "rosbag2_bagfile_information: &a [*a]", "a: 2001-99-99"]
)
def test_metadata_that_cannot_be_read_is_passed_over(bag, text):
    (bag / "metadata.yaml").write_text(text)
    recording = Recording(bag)
    assert recording.frame_count == 3
    assert "is damaged" in recording.notices[0]


@pytest.mark.parametrize("key", ["storage_identifier", "compression_mode"])
def test_metadata_that_grows_without_end_is_not_printed(bag, key):
    text = f"{BOMB}rosbag2_bagfile_information:\n  relative_file_paths: [bag_0.mcap]\n  {key}: *i\n"
    (bag / "metadata.yaml").write_text(text)
    assert "is damaged" in Recording(bag).notices[0]

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth in the formats of data sets and annotation tools, read where it lies."""

import json
import re

import cv2
import pytest
from small_recordings import box_of, frame_of, write_video

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.source import open_source

NONE, PARTIAL, TOTAL = Occlusion
# The vehicle's boxes in the images are 8,24 10,24 12,24 14,24 (from 0), each 16 by 12 px. Every
# file says that it is visible in the first and the fourth, and absent from the third.
FROM_1 = ["9,25,16,12", "11,25,16,12", "NaN,NaN,NaN,NaN", "15,25,16,12"]
TRACK = "1,{id},9,25,16,12{a}\n2,{id},11,25,16,12{b}\n4,{id},15,25,16,12{a}\n"


def track(identity, a="", b=""):
    return TRACK.format(id=identity, a=a, b=b)


def kitti(frame, identity, occluded, left):
    box = f"{left} 24 {left + 16} 36" if identity >= 0 else "1 2 3 4"
    return f"{frame} {identity} Car 0 {occluded} -1.5 {box} 1 1 1 0 0 0 0\n"


def cvat_box(left, *, occluded=0, **stated):
    words = " ".join(f'{name}="{value}"' for name, value in stated.items())
    return (
        f'<box {words} occluded="{occluded}" xtl="{left}" ytl="24.00" xbr="{left + 16}" ybr="36"/>'
    )


def studio_box(left, **stated):
    # of 96 x 64 px
    percent = {"x": left / 0.96, "y": 37.5, "width": 100 / 6, "height": 18.75, "rotation": 0}
    return {**percent, **stated}


def studio(*tasks):
    return json.dumps(
        [
            {"data": data, "annotations": [{"was_cancelled": True}, {"result": regions}]}
            for data, regions in tasks
        ]
    )


CVAT_VIDEO = (
    "<annotations><track id='0' label='van'/><track id='1'>{}</track></annotations>".format(
        cvat_box(8, frame=0, outside=0)
        + cvat_box(10, frame=1, outside=0, occluded=1)
        + cvat_box(12, frame=2, outside=1)
        + cvat_box(14, frame=3, outside=0)
    )
)
TWO_TRACKS = "<annotations>{}</annotations>".format(
    "".join(f"<track id='{n}'>{cvat_box(8, frame=0, outside=0)}</track>" for n in (3, 8))
)
CVAT_IMAGES = "<?xml version='1.0' encoding='utf-8'?>\n<annotations>{}</annotations>".format(
    "".join(
        f'<image id="{3 - index}" name="part/{index + 1:06d}.jpg">{cvat_box(8 + 2 * index)}</image>'
        for index in (0, 1, 3)
    )
)
STUDIO_VIDEO = studio(
    ({"video": "/data/upload/1/clip.mp4"}, [
        {"type": "labels", "value": {}},
        {"type": "videorectangle", "value": {"framesCount": 4, "sequence": [
            {"frame": 1, "enabled": True, **studio_box(8)},
            {"frame": 2, "enabled": False, **studio_box(10)},
            {"frame": 4, "enabled": True, **studio_box(14)},
        ]}},
    ])
)  # fmt: skip
STUDIO_IMAGES = studio(
    *(
        ({"image": f"/data/upload/1/0a1b2c3d-{index + 1:06d}.jpg"},
         [{"type": "rectanglelabels", "value": studio_box(8 + 2 * index)}])
        for index in (0, 1, 3)
    ),
    ({"image": "/data/local-files/?d=000003.jpg"}, []),
)  # fmt: skip

# Name: images, files beside them, words of the command, occlusion in the second image.
FORMATS = {
    "OTB, commas": ("Car1/img/{:04d}.jpg", {"Car1/groundtruth_rect.txt": FROM_1}, "", NONE),
    "OTB, tabs": (
        "Car1/img/{:04d}.jpg",
        {"Car1/groundtruth_rect.txt": ["9\t25\t16\t12", "11\t25\t16\t12", "0\t0\t0\t0",
                                       "15\t25\t16\t12"]}, "", NONE),
    "OTB, targets": (
        "Jogging/img/{:04d}.jpg",
        {"Jogging/groundtruth_rect.1.txt": ["1 1 9 9"] * 4,
         "Jogging/groundtruth_rect.2.txt": [row.replace(",", " ") for row in FROM_1]},
        "--id 2", NONE),
    "TC128": (
        "Car/img/{:04d}.jpg", {"Car/Car_gt.txt": FROM_1, "Car/Car_frames.txt": ["1,4"]},
        "", NONE),
    "UAV123": (
        "data_seq/UAV123/car1/{:06d}.jpg", {"anno/UAV123/car1.txt": FROM_1}, "", NONE),
    "VOT, polygons": (
        "car/color/{:08d}.jpg",
        {"car/groundtruth.txt": ["8,24,24,24,24,36,8,36", "18,24,26,30,18,36,10,30", "0",
                                 "14,24,30,24,30,36,14,36"],
         "car/occlusion.tag": "0110"}, "", PARTIAL),
    "VOT, boxes": (
        "car/color/{:08d}.jpg",
        {"car/groundtruth.txt": ["8,24,16,12", "10,24,16,12", "nan,nan,nan,nan", "14,24,16,12"],
         "car/sequence": ["fps=30"]}, "", NONE),
    "LaSOT": (
        "car-1/img/{:08d}.jpg",
        {"car-1/groundtruth.txt": [*FROM_1[:2], "9,9,9,9", FROM_1[3]],
         "car-1/full_occlusion.txt": ["0,1,0,0"], "car-1/out_of_view.txt": ["0,0,1,0"]},
        "", TOTAL),
    "GOT-10k": (
        "GOT_1/{:08d}.jpg",
        {"GOT_1/groundtruth.txt": [*FROM_1[:2], "9,9,9,9", FROM_1[3]],
         "GOT_1/absence.label": "0010", "GOT_1/cover.label": "8308"}, "", PARTIAL),
    "UAVDT, one target": (
        "UAV-benchmark-S/S0101/img{:06d}.jpg",
        {"UAV-benchmark-SOT_v1.0/anno/S0101_gt.txt": FROM_1}, "", NONE),
    "UAVDT, many": (
        "UAV-benchmark-M/M0101/img{:06d}.jpg",
        {"UAV-benchmark-MOTD_v1.0/GT/M0101_gt_whole.txt":
         track(5, ",1,1,1", ",1,2,1") + track(6, ",1,1,1", ",1,1,1")}, "--id 5", PARTIAL),
    "MOT": (
        "MOT/img1/{:06d}.jpg",
        {"MOT/gt/gt.txt": track(3, ",1,3,1.0", ",1,3,0.05") + track(4, ",1,3,1", ",1,3,1")},
        "--id 3", TOTAL),
    "MOT of CVAT": (
        "MOT/img1/{:06d}.jpg",
        {"MOT/gt/gt.txt": track(3, ",1,1,1", ",1,1,0.5").replace(",25,", ",24,")
         .replace(",9,", ",8,").replace(",11,", ",10,").replace(",15,", ",14,"),
         "MOT/gt/labels.txt": ["car"]}, "", PARTIAL),
    "KITTI": (
        "training/image_02/0003/{:06d}.png",
        {"training/label_02/0003.txt": kitti(1, 0, 0, 8) + kitti(1, -1, -1, 0) + kitti(2, 0, 2, 10)
         + kitti(4, 0, 3, 14) + kitti(2, 1, 0, 50)}, "--id 0", PARTIAL),
    "CVAT, video": ("c/images/frame_{:06d}.jpg", {"c/annotations.xml": CVAT_VIDEO}, "", PARTIAL),
    "CVAT, images": ("c/images/{:06d}.jpg", {"c/annotations.xml": CVAT_IMAGES}, "", NONE),
    "Label Studio, video": (
        "c/images/{:06d}.jpg", {"c/project-1-at-2026-11-23.json": STUDIO_VIDEO}, "", NONE),
    "Label Studio, images": (
        "c/images/{:06d}.jpg", {"c/project-1-at-2026-11-23.json": STUDIO_IMAGES}, "", NONE),
}  # fmt: skip


@pytest.fixture
def lay(tmp_path):
    """Lay images and files into a folder; return that of the images, above img, color and so on."""

    def lay(images="images/{:06d}.jpg", files=()):
        for index in range(4):
            path = tmp_path / "data" / images.format(index + 1)
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), frame_of(index)[:, :, ::-1])
        for name, content in dict(files).items():
            other = tmp_path / "data" / name
            other.parent.mkdir(parents=True, exist_ok=True)
            is_flags = other.suffix in (".tag", ".label")
            is_whole = isinstance(content, str) and not is_flags
            other.write_text(content if is_whole else "".join(f"{line}\n" for line in content))
        return (
            path.parent.parent
            if path.parent.name in ("img", "img1", "color", "images")
            else path.parent
        )

    return lay


@pytest.mark.parametrize("name", FORMATS)
def test_each_format_is_imported_and_scored_where_it_lies(lay, tmp_path, name):
    images, files, words, occlusion = FORMATS[name]
    folder, out = str(lay(images, files)), tmp_path / "out"
    assert main(["import", folder, str(tmp_path / "bag"), *words.split()]) == 0
    truths = Recording(tmp_path / "bag").truth()
    assert [one.stamp_ns for one in truths] == [
        found.stamp_ns
        for index, found in enumerate(Recording(tmp_path / "bag").frames())
        if index != 2
    ]
    for truth, index in zip(truths, (0, 1, 3), strict=True):
        box, wanted = truth.box, box_of(index)
        assert (box.x, box.y) == pytest.approx((wanted.x, wanted.y))
        assert (box.width, box.height) == pytest.approx((wanted.width, wanted.height))
    assert [one.occlusion for one in truths] == [NONE, occlusion, NONE]
    assert main(["run", folder, "--variant", "ms", "-o", str(out), *words.split()]) == 0
    metrics = json.loads((out / "metrics.json").read_text())
    assert (metrics["frames_scored"], metrics["frames_without_truth"]) == (3, 1)


def test_a_video_takes_truth_in_any_format(tmp_path):
    video = write_video(tmp_path / "clip.avi", map(frame_of, range(4)))
    truth = tmp_path / "export.json"
    truth.write_text(STUDIO_VIDEO)
    source = open_source(video, truth=truth)
    wanted = [one.truth for one in source.frames()]
    assert [one is not None for one in wanted] == [True, True, False, True]
    assert source.truth() == [one for one in wanted if one is not None]
    words = ["--truth", str(truth), "--variant", "ms", "-o", str(tmp_path / "out")]
    assert main(["run", str(video), *words]) == 0
    assert json.loads((tmp_path / "out" / "metrics.json").read_text())["frames_scored"] == 3


def test_truth_that_is_named_takes_the_place_of_what_lies_there(lay, tmp_path):
    folder = lay("Car1/img/{:04d}.jpg", {"Car1/groundtruth_rect.txt": FROM_1})
    other = tmp_path / "other.txt"
    other.write_text("31 41 5 6\n")
    (truth,) = FrameFolder(folder, truth=other).truth()
    assert (truth.box.x, truth.box.y) == (30, 40)


@pytest.mark.parametrize("parts", [("car1_2.txt",), ("car1_1.txt", "car1_2.txt")])
@pytest.mark.parametrize("places", [("data_seq/UAV123/car1", "anno/UAV123"), ("car1", "anno")])
def test_parts_of_a_video_are_said_and_not_read(lay, tmp_path, capsys, parts, places):
    images, truth = places
    files = {f"{truth}/{part}": FROM_1[2:] for part in parts}
    folder = lay(images + "/{:06d}.jpg", files)
    assert main(["import", str(folder), str(tmp_path / "bag")]) == 0
    told = capsys.readouterr()
    assert "0 with truth" in told.out
    assert f"{parts[0]} is the truth of a part of a video" in told.err


def test_the_name_of_a_folder_is_no_pattern(lay):
    folder = lay("anno/../car[1]/{:06d}.jpg", {"anno/car[1].txt": FROM_1, "anno/car1.txt": ["x"]})
    assert len(FrameFolder(folder, fps=10).truth()) == 3


UNREADABLE = {
    "empty": ("gt/gt.txt", "", "is empty"),
    "no number": ("groundtruth.txt", "1,2,3,4\n1,2,3,four\n", "'four' as number 4"),
    "own table": ("groundtruth.csv", "frame,x,y\n1,2,3\n", "lacks the column w"),
    "several": ("gt/gt.txt", track(3) + track(8), "has the truth of 2 vehicles"),
    "other frames": ("gt/gt.txt", "70,1,2,3,4,5\n", "no frame of the truth .* has an image"),
    "no text": ("groundtruth.csv", "\ud800", "is not text"),
}


@pytest.mark.parametrize("case", UNREADABLE)
def test_a_run_with_a_target_outlives_truth_that_cannot_be_read(lay, tmp_path, capsys, case):
    name, content, said = UNREADABLE[case]
    folder = lay(files={name: "" if case == "no text" else content})
    if case == "no text":
        (folder / name).write_bytes(b"\xff\xfe\x00\x80")
    out = tmp_path / "out"
    words = ["run", str(folder), "--variant", "ms", "-o", str(out), "--overwrite"]
    assert main([*words, "--target", "8,24,16,12"]) == 0
    assert re.search(said, capsys.readouterr().err)
    assert (out / "estimates.csv").read_text().count("\n") == 5
    assert not (out / "metrics.json").exists()
    assert main(words) == 2
    assert re.search(said, capsys.readouterr().err)


def test_truth_that_is_named_must_be_read_even_with_a_target(lay, tmp_path, capsys):
    folder = lay(files={"other.txt": "1,2,3,4\n1,2,3,four\n"})
    words = ["run", str(folder), "--target", "8,24,16,12", "-o", str(tmp_path / "out")]
    assert main([*words, "--truth", str(tmp_path / "data" / "other.txt")]) == 1
    assert "'four' as number 4" in capsys.readouterr().err


def test_a_target_that_is_not_there_ends_a_run(lay, tmp_path):
    folder = str(lay(files={"gt/gt.txt": track(3)}))
    words = ["run", folder, "--target", "8,24,16,12", "-o", str(tmp_path / "out")]
    assert main([*words, "--id", "4"]) == 1


@pytest.mark.parametrize("case", UNREADABLE)
def test_traffic_does_not_read_truth(lay, tmp_path, capsys, case):
    name, content, said = UNREADABLE[case]
    folder = lay(files={name: "" if case == "no text" else content})
    words = ["traffic", str(folder), "--target", "8,24,16,12", "--detector", "none"]
    assert main([*words, "-o", str(tmp_path / "out")]) == 0
    assert not re.search(said, capsys.readouterr().err)


def test_tc128_states_the_images_that_its_rows_begin_at(lay):
    files = {"Car/Car_gt.txt": FROM_1[:2], "Car/Car_frames.txt": ["3,4"]}
    folder = FrameFolder(lay("Car/img/{:04d}.jpg", files), fps=10)
    assert {number: one.box.x for number, one in folder.truths.items()} == {3: 8, 4: 10}


def test_the_truth_above_the_folder_of_the_images_is_found(lay):
    folder = lay("Car1/img/{:04d}.jpg", {"Car1/groundtruth_rect.txt": FROM_1})
    assert len(FrameFolder(folder / "img").truth()) == 3


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("groundtruth.txt", "m4,5,2,3,100", "is in no format that is read"),
        ("car_groundtruth.mat", "MATLAB 5.0", "is in no format that is read"),
        ("annotations/1.txt", "", "annotations is not a regular file"),
        ("annotations.xml", "<annotations><track", "is not whole XML"),
        ("annotations.xml", "<annotation><object/></annotation>", "holds no box"),
        (
            "annotations.xml",
            f"<annotations><image id='0'>{cvat_box(1) * 2}</image></annotations>",
            "has several boxes in an image, and no tracks",
        ),
        ("project-1.json", '[{"image": "1.jpg"}]', "is not Label Studio's export as JSON"),
    ],
)
def test_what_is_seen_and_not_read_is_said(lay, tmp_path, capsys, name, content, said):
    folder = lay(files={name: content})
    assert main(["import", str(folder), str(tmp_path / "bag")]) == 0
    told = capsys.readouterr()
    assert "0 with truth" in told.out
    assert main(["run", str(folder), "-o", str(tmp_path / "out")]) == 2
    for err in (told.err, capsys.readouterr().err):
        assert re.search(said, err)


@pytest.mark.parametrize(
    ("name", "content", "words", "said"),
    [
        ("gt/gt.txt", track(3), {"identity": 9}, "no target 9; it has 3"),
        ("gt/gt.txt", track(3) * 2, {}, r"line 4 .* names frame 1 a second time"),
        ("gt/gt.txt", "1,2,3,4,5,6\n2,2,3,4,5\n", {}, "line 2 .* 5 cells, of at least 6"),
        ("gt/gt.txt", "1,2.5,3,4,5,6\n", {}, "no integer as its target"),
        ("groundtruth.txt", "1,2,3,4\n1,2,3,4,5\n", {}, "line 2 .* 5 numbers; a box has 4"),
        ("groundtruth.txt", "1,2,3,4\n1,2,3,four\n", {}, "line 2 .* 'four' as number 4"),
        ("groundtruth.csv", "nan,nan,nan,nan\n", {}, "holds no box"),
        ("project-1.json", STUDIO_VIDEO.replace('"rotation": 0', '"rotation": 3'), {}, "rotated"),
    ],
)
def test_a_fault_is_named(lay, name, content, words, said):
    with pytest.raises(InputError, match=said):
        FrameFolder(lay(files={name: content}), **words)


@pytest.mark.parametrize(
    ("name", "content"), [("gt/gt.txt", track(3) + track(8)), ("annotations.xml", TWO_TRACKS)]
)
def test_truth_of_several_vehicles_asks_which(lay, tmp_path, capsys, name, content):
    folder = str(lay(files={name: content}))
    assert main(["import", folder, str(tmp_path / "bag")]) == 1
    assert "has the truth of 2 vehicles; choose one with --id: 3, 8" in capsys.readouterr().err
    assert not (tmp_path / "bag").exists()
    assert main(["run", folder, "-o", str(tmp_path / "out")]) == 2
    assert "choose one with --id: 3, 8" in capsys.readouterr().err
    assert main(["import", folder, str(tmp_path / "bag"), "--id", "8"]) == 0


def test_the_end_of_a_track_may_be_written_twice(lay):
    ends = cvat_box(12, frame=2, outside=1) * 2
    track = cvat_box(8, frame=0, outside=0) + cvat_box(10, frame=1, outside=0)
    text = f"<annotations><track id='1'>{track}{ends}</track></annotations>"
    assert list(FrameFolder(lay(files={"annotations.xml": text}), fps=10).truths) == [1, 2]


@pytest.mark.parametrize("second", [cvat_box(10, frame=0, outside=0),
                                    cvat_box(8, frame=0, outside=1)])  # fmt: skip
def test_two_states_in_one_frame_are_a_contradiction(lay, second):
    text = f"<annotations><track id='1'>{cvat_box(8, frame=0)}{second}</track></annotations>"
    with pytest.raises(InputError, match="frame 1 a second time"):
        FrameFolder(lay(files={"annotations.xml": text}))


POLYGON = '<polygon frame="1" outside="0" points="1,2;3,4;5,6"/>'
ROTATED_STUDIO = STUDIO_VIDEO.replace('"rotation": 0', '"rotation": 3')
UPRIGHT_AND_ROTATED = cvat_box(8, frame=0) + cvat_box(10, frame=1, rotation=30.5)
UNREAD = {
    "CVAT": (
        "annotations.xml",
        f"<annotations><track id='1'>{UPRIGHT_AND_ROTATED}</track></annotations>",
        "track 1 of .* is rotated; only upright boxes"),
    "CVAT, image": (
        "annotations.xml",
        f"<annotations><image id='0'>{cvat_box(8, rotation=-30)}</image></annotations>",
        "image 0 of .* is rotated; only upright boxes"),
    "CVAT, polygon": (
        "annotations.xml", f"<annotations><track id='1'>{POLYGON}</track></annotations>",
        "track 1 of .* is a polygon; only upright boxes"),
    "Label Studio": ("project-1.json", ROTATED_STUDIO, "region 1 of .* is rotated; only upright"),
    "Label Studio, polygon": (
        "project-1.json", studio(({"video": "a.mp4"}, [{"type": "polygonlabels", "value": {}}])),
        "is a polygon; only upright boxes"),
}  # fmt: skip


@pytest.mark.parametrize("case", UNREAD)
def test_what_is_no_upright_box_is_refused_by_every_reader(lay, case):
    name, text, said = UNREAD[case]
    with pytest.raises(InputError, match=said):
        FrameFolder(lay(files={name: text}))


def test_other_shapes_beside_the_target_are_said(lay):
    box = f"<track id='1'>{cvat_box(8, frame=0, outside=0)}</track>"
    rotated = f"<track id='2'>{cvat_box(8, frame=0, outside=0, rotation=9)}</track>"
    others = f"<track id='3'>{POLYGON}</track><image id='1'>{POLYGON}</image>{rotated}"
    place = lay(files={"annotations.xml": f"<annotations>{box}{others}</annotations>"})
    folder = FrameFolder(place, fps=10)
    assert list(folder.truths) == [1]
    assert "3 targets or shapes are not read: track 3 of" in folder.notices[-1]
    with pytest.raises(InputError, match=r"track 2 of .* is rotated"):
        FrameFolder(place, fps=10, identity=2)


@pytest.mark.parametrize("turn", ["0.0", "360", "-360.00"])
def test_a_full_turn_is_upright(lay, turn):
    box = cvat_box(8, frame=0, outside=0, rotation=turn)
    text = f"<annotations><track id='1'>{box}</track></annotations>"
    assert list(FrameFolder(lay(files={"annotations.xml": text})).truths) == [1]


def test_mot_of_eight_columns_is_no_polygon(lay):
    folder = FrameFolder(lay(files={"gt/gt.txt": "1,3,9,25,16,12,1,1\n"}), fps=10)
    assert folder.truths[1].box.x == 8


def test_the_truth_of_other_frames_of_a_video_is_refused(tmp_path):
    video = write_video(tmp_path / "clip.avi", map(frame_of, range(4)))
    truth = tmp_path / "t.csv"
    truth.write_text("frame,x,y,w,h\n5,8,24,16,12\n900,8,24,16,12\n")
    with pytest.raises(InputError, match="it has frames 5 to 900, the images are 1 to 4"):
        open_source(video, truth=truth)
    truth.write_text("frame,x,y,w,h\n0,8,24,16,12\n1,8,24,16,12\n")
    assert (
        "has frame 0; frames of a video count from 1" in open_source(video, truth=truth).notices[0]
    )


def test_fewer_rows_than_images_are_said(lay):
    folder = FrameFolder(lay(files={"groundtruth.txt": FROM_1[:2]}), fps=10)
    assert any("has 2 rows for 4 images; its first is taken for image 1" in one
               for one in folder.notices)  # fmt: skip


def test_a_recording_has_its_own_truth(tmp_path):
    with pytest.raises(InputError, match="a recording, with its own truth"):
        open_source(tmp_path / "a.mcap", identity=1)

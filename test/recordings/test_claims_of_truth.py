# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth of a few bytes that claims counts, indices and lengths without end: read within seconds."""

import json
import time
import tracemalloc

import cv2
import pytest
from small_recordings import frame_of, write_video

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder
from vehicle_pf_tracker.recordings.source import open_source

HUGE = [10**7, 10**10, 10**18, 2**63, 10**300, 10**400, -(10**10), "1" * 5000]
LONGEST_S = 10
MOST_BYTES = 100 << 20


@pytest.fixture
def bounded():
    """Fail a test that takes long, or much memory."""
    tracemalloc.start()
    began = time.monotonic()
    yield
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert time.monotonic() - began < LONGEST_S
    assert peak < MOST_BYTES


@pytest.fixture
def place(tmp_path):
    for index in range(3):
        path = tmp_path / "a" / "car" / f"{index + 1:06d}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(path), frame_of(index)[:, :, ::-1])
    return tmp_path / "a" / "car"


def studio(keys, count=4):
    value = {"framesCount": count, "sequence": keys}
    region = {"type": "videorectangle", "value": value}
    return json.dumps([{"data": {"video": "v.mp4"}, "annotations": [{"result": [region]}]}])


def key(frame, **more):
    box = {"x": 10, "y": 40, "width": 15, "height": 20, "rotation": 0}
    return {"frame": frame, "enabled": True, **box, **more}


def cvat(**stated):
    words = {"frame": 0, "outside": 0, "xtl": 8, "ytl": 24, "xbr": 24, "ybr": 36, **stated}
    box = "".join(f' {name}="{value}"' for name, value in words.items())
    return f"<annotations><track id='{stated.get('id', 1)}'><box{box}/></track></annotations>"


def texts(huge):
    """Return each format of truth with a claim of this size in each place that has one."""
    return {
        "groundtruth.csv": [f"frame,x,y,w,h\n{huge},1,2,3,4\n", f"frame,x,y,w,h\n1,{huge},2,3,4\n"],
        "groundtruth_rect.txt": [f"{huge},2,3,4\n", f"1 2 {huge} 4\n"],
        "groundtruth.txt": [f"{huge},2,3,4,5,6,7,8\n", f"{huge}\n1,2,3,4\n"],
        "car_gt.txt": [f"9,25,{huge},12\n"],
        "gt/gt.txt": [f"{huge},1,9,25,16,12\n", f"1,{huge},9,25,16,12\n"],
        "annotations.xml": [cvat(frame=huge), cvat(id=huge), cvat(xbr=huge), cvat(rotation=huge)],
        "project-1.json": [
            studio([key(1), key(huge)]),
            studio([key(huge)]),
            studio([key(huge), key(1)]),
            studio([key(1)], huge),
            studio([key(1, x=huge)]),
            studio([key(1, rotation=huge)]),
        ],
        "../anno/car.txt": [f"9,25,{huge},12\n"],
        "../../label_02/car.txt": [f"{huge} 0 Car 0 0 0 8 24 24 36 1 1 1 0 0 0 0\n",
                                   f"0 {huge} Car 0 0 0 8 24 24 36 1 1 1 0 0 0 0\n"],
        "../other/anno/car_gt.txt": [f"9,25,{huge},12\n"],
        "../other/GT/car_gt_whole.txt": [f"{huge},1,9,25,16,12,1,1,1\n"],
    }  # fmt: skip


@pytest.mark.usefixtures("bounded")
@pytest.mark.parametrize("huge", HUGE, ids=lambda value: str(value)[:25])
def test_no_format_believes_a_claim(place, huge):
    for name, contents in texts(huge).items():
        path = place / name
        path.parent.mkdir(parents=True, exist_ok=True)
        for content in contents:
            path.write_text(content)
            try:
                assert set(FrameFolder(place, fps=10).truths) <= {1, 2, 3}
            except InputError as error:
                assert len(str(error)) < 500 + len(str(place))
        path.unlink()


@pytest.mark.usefixtures("bounded")
@pytest.mark.parametrize("huge", HUGE[:4])
def test_a_key_frame_beyond_the_video_ends_there(tmp_path, huge):
    video = write_video(tmp_path / "clip.avi", map(frame_of, range(4)))
    truth = tmp_path / "t.json"
    truth.write_text(studio([key(1), key(huge, x=70)], huge))
    numbers = [truth.stamp_ns for truth in open_source(video, truth=truth).truth()]
    assert len(numbers) == 4


@pytest.mark.usefixtures("bounded")
@pytest.mark.parametrize("first", ["0", "2", str(10**10), "1e400", "nan", "", "x"])
def test_tc128_may_begin_at_any_image_that_it_likes(place, first):
    (place / "car_gt.txt").write_text("9,25,16,12\n")
    (place / "car_frames.txt").write_text(f"{first},9\n")
    try:
        assert set(FrameFolder(place, fps=10).truths) <= {1, 2}
    except InputError as error:
        assert "car_frames.txt" in str(error)


@pytest.mark.usefixtures("bounded")
@pytest.mark.parametrize(
    "line",
    [
        "1" * 50_000 + "x",
        "1" + " " * 20_000 + "x",
        "1 " * 20_000 + "x",
        "1," * 20_000 + "x",
        "1" + "\t" * 20_000 + "x",
        "1" + ";," * 20_000 + "x",
        '"' * 40_001,
        '"1' + '""' * 20_000,
        "1" * 200_000 + '"',
        "-" * 50_000,
        "1e" * 20_000,
        ".1" * 20_000,
        "<" * 50_000,
        "[" * 50_000,
        "frame," * 20_000,
        "# " * 20_000,
    ],
    ids=lambda line: line[:4],
)
def test_a_line_of_any_letters_is_refused_within_seconds(place, line):
    for name in ("groundtruth_rect.txt", "groundtruth.csv", "gt/gt.txt"):
        path = place / name
        path.parent.mkdir(exist_ok=True)
        for text in (f"{line}\n", f"1,2,3,4\n{line}\n", f"frame,x,y,w,h\n{line}\n"):
            path.write_text(text)
            try:
                folder = FrameFolder(place, fps=10)
            except InputError as error:
                assert len(str(error)) < 500 + len(str(place))
            else:
                assert not folder.truths or text.startswith("1,2,3,4")
        path.unlink()

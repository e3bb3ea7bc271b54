# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Any source of images by its name: what it is taken for, its times, its truth."""

from __future__ import annotations

import json
import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_recordings import write_video

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.importing import import_recording
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.recordings.video import VideoFile

START = 1_000_000_000


def write_images(folder: Path, names) -> Path:
    folder.mkdir(parents=True)
    for index, name in enumerate(names):
        cv2.imwrite(str(folder / name), np.full((24, 32, 3), 20 * index, np.uint8))
    return folder


def video_of(path: Path, fps: float = 12.5) -> Path:
    return write_video(path, [np.full((24, 32, 3), 20 * n, np.uint8) for n in range(6)], fps)


def stamps(source) -> list[int]:
    return [found.stamp_ns - START for found in source.frames()]


def test_a_plain_folder_of_images_is_numbered_by_the_ends_of_their_names(tmp_path):
    folder = write_images(tmp_path / "a", ["cam_0004.jpg", "cam_0002.jpg", "cam_0003.png"])
    source = open_source(folder, fps=10)
    assert source.frame_count == 3
    assert stamps(source) == [0, 100_000_000, 200_000_000]
    brightness = [int(found.frame.mean()) for found in source.frames()]
    assert brightness == [20, 40, 0]
    assert source.notices == []


def test_a_broken_image_of_a_folder_keeps_its_place_and_is_counted_and_said_once(tmp_path):
    folder = write_images(tmp_path / "a", ["1.jpg", "2.jpg", "3.jpg", "4.png"])
    for name in ("1.jpg", "3.jpg"):
        (folder / name).write_bytes(b"no image")
    source = open_source(folder, fps=10)
    for _ in range(2):
        images = list(source.frames())
        assert [found.frame is None for found in images] == [True, False, True, False]
        assert images[3].stamp_ns - images[0].stamp_ns == 300_000_000
        (notice,) = source.notices
        assert notice.startswith("images that cannot be read: 2; ") and "1.jpg" in notice


def test_a_folder_of_broken_images_is_an_input_error(tmp_path):
    folder = write_images(tmp_path / "a", ["1.jpg", "2.jpg"])
    for path in folder.iterdir():
        path.write_bytes(b"no image")
    with pytest.raises(InputError, match=r"1\.jpg cannot be read"):
        list(open_source(folder, fps=10).frames())


def test_a_folder_of_images_of_another_format_says_what_to_do(tmp_path):
    for number in (1, 2):
        (tmp_path / f"{number:03}.bmp").touch()
    with pytest.raises(InputError, match=r"has no images .*; convert its 2 images as .*bmp to png"):
        open_source(tmp_path)


def test_images_without_numbers_follow_their_names(tmp_path):
    folder = write_images(tmp_path / "a", ["b.png", "a.png", "c7.png"])
    brightness = [int(found.frame.mean()) for found in open_source(folder, fps=10).frames()]
    assert brightness == [20, 0, 40]


@pytest.mark.parametrize(
    ("name", "text", "period"),
    [
        ("sequence.json", json.dumps({"fps": 25}), 40_000_000),
        ("seqinfo.ini", "[Sequence]\nname=x\nframeRate=20\n", 50_000_000),
    ],
)
def test_a_folder_states_its_frame_rate(tmp_path, name, text, period):
    folder = tmp_path / "a"
    write_images(folder / "img1", ["000001.png", "000002.png"])
    (folder / name).write_text(text)
    source = open_source(folder)
    assert stamps(source) == [0, period]
    assert source.notices == []


def test_a_rate_that_nothing_states_is_assumed_and_said(tmp_path):
    source = open_source(write_images(tmp_path / "a", ["1.png", "2.png"]))
    assert stamps(source) == [0, 33_333_333]
    (notice,) = source.notices
    assert "states no frame rate; 30 frames/s are assumed" in notice


@pytest.mark.parametrize("text", ["", "[Sequence]\n", "[Sequence]\nframeRate=fast\n"])
def test_a_broken_seqinfo_is_named(tmp_path, text):
    folder = tmp_path / "a"
    write_images(folder / "img1", ["000001.png"])
    (folder / "seqinfo.ini").write_text(text)
    with pytest.raises(InputError, match=r"seqinfo\.ini does not state the frame rate"):
        open_source(folder)


def test_the_truth_of_a_folder_is_known_before_it_is_read(tmp_path):
    folder = write_images(tmp_path / "a", ["2.png", "3.png"])
    (folder / "groundtruth.csv").write_text("frame,x,y,w,h\n3,1,2,9,8\n")
    (truth,) = open_source(folder, fps=10).truth()
    assert (truth.stamp_ns - START, truth.box.x) == (100_000_000, 1.0)


def test_the_truth_beside_a_folder_is_left_out_where_that_is_asked_for(tmp_path):
    folder = write_images(tmp_path / "MOT" / "img1", ["000001.png", "000002.png"])
    truth = folder.with_name("gt") / "gt.txt"
    truth.parent.mkdir()
    truth.write_text("1,1,2,3,9,8,1,1,1\n1,2,12,3,9,8,1,1,1\n")
    with pytest.raises(InputError, match="the truth of 2 vehicles"):
        open_source(folder)
    assert "the truth of 2 vehicles" in str(open_source(folder, beside="noted").notices)
    ignored = open_source(folder, beside="ignored")
    assert len(list(ignored.frames())) == 2
    assert not ignored.truths
    with pytest.raises(InputError, match="one of needed, noted, ignored, not False"):
        open_source(folder, beside=False)


def test_a_video_of_an_even_rate_keeps_to_it_to_the_nanosecond(tmp_path):
    source = open_source(video_of(tmp_path / "v.avi", fps=30))
    assert stamps(source) == [round(n * 1e9 / 30) for n in range(6)]
    assert isinstance(source, VideoFile)


def test_a_rate_given_takes_the_place_of_the_one_stated(tmp_path):
    source = open_source(video_of(tmp_path / "v.avi"), fps=100)
    assert stamps(source) == [n * 10_000_000 for n in range(6)]


class StatedTimes:
    """A video whose frames state these times in ms."""

    def __init__(self, times) -> None:
        self.times = times
        self.index = -1

    def read(self):
        self.index += 1
        if self.index == len(self.times):
            return None
        return np.zeros((4, 4, 3), np.uint8), self.times[self.index]

    def close(self):
        pass


def state_times(monkeypatch, decoder):
    """Let videos be decoded by this from now on."""
    name = "vehicle_pf_tracker.recordings.video.open_decoder"
    monkeypatch.setattr(name, lambda path: decoder)


def test_the_times_of_a_variable_rate_are_kept(tmp_path, monkeypatch):
    video = VideoFile(video_of(tmp_path / "v.avi"))
    video.fps = 1000 / 60
    state_times(monkeypatch, StatedTimes([0.0, 40.0, 120.0, 160.0, 240.0]))
    assert [p.stamp_ns - START for p in video.frames()] == [
        0, 40_000_000, 120_000_000, 160_000_000, 240_000_000
    ]  # fmt: skip


def test_frames_without_a_time_follow_at_the_rate(tmp_path, monkeypatch):
    video = VideoFile(video_of(tmp_path / "v.avi"))
    state_times(monkeypatch, StatedTimes([0.0, math.nan, 200.0]))
    video.fps = 100.0
    assert [p.stamp_ns - START for p in video.frames()] == [0, 10_000_000, 200_000_000]
    assert any("for 1 frame; it follows" in notice for notice in video.notices)


def test_times_that_go_back_are_replaced_and_counted(tmp_path, monkeypatch):
    video = VideoFile(video_of(tmp_path / "v.avi"))
    state_times(monkeypatch, StatedTimes([0.0, 0.0, 0.0, 500.0]))
    video.fps = 100.0
    found = [p.stamp_ns - START for p in video.frames()]
    assert found == [0, 10_000_000, 20_000_000, 500_000_000]
    assert any("for 2 frames" in notice for notice in video.notices)


def test_recordings_are_opened_as_such(tmp_path):
    import_recording(video_of(tmp_path / "v.avi"), tmp_path / "bag")
    assert isinstance(open_source(tmp_path / "bag"), Recording)
    (mcap,) = (tmp_path / "bag").glob("*.mcap")
    assert isinstance(open_source(str(mcap)), Recording)
    with pytest.raises(InputError, match="leave --fps out"):
        open_source(tmp_path / "bag", fps=30)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("old.bag", "a ROS 1 bag; convert it to MCAP: rosbags-convert --src"),
        ("data_0.db3", "is not a bag in SQLite"),
        ("nothing.mp4", "no file or folder"),
        ("rtsp://127.0.0.1:9/none", "cannot be opened"),
        ("97", "the camera 97 cannot be opened"),
    ],
)
def test_what_cannot_be_opened_is_said_with_the_remedy(tmp_path, monkeypatch, name, words):
    monkeypatch.chdir(tmp_path)
    if name.endswith((".bag", ".db3")):
        Path(name).touch()
    with pytest.raises(InputError, match=words):
        open_source(name)


def test_only_recordings_have_topics(tmp_path):
    with pytest.raises(InputError, match="leave --topic out"):
        open_source(video_of(tmp_path / "v.avi"), topic="/image")

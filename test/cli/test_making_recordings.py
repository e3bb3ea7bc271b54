# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import cv2
import numpy as np
import pytest
from small_recordings import COUNT, box_of, frame_folder

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene

SHORT = ["--set", "speed=40", "--set", "width=0"]


def call(*words):
    assert main([str(word) for word in words]) == 0


def test_a_frame_folder_becomes_a_recording(tmp_path, capsys):
    source = frame_folder(tmp_path / "source")
    call("import", source, tmp_path / "bag")
    recording = Recording(tmp_path / "bag")
    assert recording.image_type == "sensor_msgs/msg/CompressedImage"
    assert recording.frame_count == COUNT
    assert recording.truth()[3].box == box_of(3)
    told = capsys.readouterr().out
    assert "bag: 12 frames of 96x64 px at 25 frames/s, 12 with truth\n" in told


def test_a_scene_becomes_a_recording_with_its_frames_and_truth(tmp_path, capsys):
    call("synth", "bar", tmp_path / "bag", "--seed", "3", *SHORT)
    scene = make_scene("bar", seed=3, settings={"speed": 40.0, "width": 0.0})
    recording = Recording(tmp_path / "bag")
    rendered = [frame.frame for frame in scene.frames()]
    read = [image.frame for image in recording.frames()]
    assert len(read) == len(rendered) == scene.frame_count
    assert all(map(np.array_equal, read, rendered))
    assert [truth.stamp_ns for truth in recording.truth()] == [
        scene.stamp_ns(index) for index in range(scene.frame_count)
    ]
    assert f"{scene.frame_count} frames of 640x480 px" in capsys.readouterr().out


def test_a_scene_becomes_a_video_with_its_truth_beside_it(tmp_path, capsys):
    call("synth", "bar", tmp_path / "clip.mp4", *SHORT)
    scene = make_scene("bar", settings={"speed": 40.0, "width": 0.0})
    rendered = list(scene.frames())
    out = capsys.readouterr().out
    first = rendered[0].truth.box
    assert f"--target {first.x:.0f},{first.y:.0f},{first.width:.0f},{first.height:.0f}" in out
    call("import", tmp_path / "clip.mp4", tmp_path / "bag", "--truth", tmp_path / "clip.csv")
    recording = Recording(tmp_path / "bag")
    for read, made in zip(recording.truth(), rendered, strict=True):
        assert np.allclose(read.box.corners, made.truth.box.corners, rtol=0, atol=1e-3)
        assert read.occlusion == made.truth.occlusion
    frames = [image.frame.astype(int) for image in recording.frames()]
    assert len(frames) == len(rendered)
    assert all(np.abs(f - m.frame).mean() < 6 for f, m in zip(frames, rendered, strict=True))


@pytest.mark.parametrize("there", ["clip.mp4", "clip.csv"])
def test_a_video_replaces_nothing_unless_asked(tmp_path, capsys, there):
    (tmp_path / there).write_text("mine")
    words = ["synth", "bar", str(tmp_path / "clip.mp4"), *SHORT]
    assert main(words) == 1
    assert f"{there} exists; give --overwrite to replace it" in capsys.readouterr().err
    assert (tmp_path / there).read_text() == "mine"
    assert [path.name for path in tmp_path.iterdir()] == [there]
    call(*words, "--overwrite")
    assert cv2.VideoCapture(str(tmp_path / "clip.mp4")).get(cv2.CAP_PROP_FRAME_COUNT) > 0


def test_the_list_names_scenes_and_settings(capsys):
    call("synth", "--list")
    out = capsys.readouterr().out
    assert all(f"{name}: {kind.summary}" in out for name, kind in SCENES.items())
    assert "  width=30.0 [px, from 0 to 120]: " in out

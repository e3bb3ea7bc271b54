# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many vehicles from Python, and the programs of docs/examples.md."""

import copy
import json
import os
import pickle
import re
import shutil
import subprocess
import sys
import warnings
from ast import literal_eval
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from onnx_networks import yolov8_anywhere

from vehicle_pf_tracker import TrafficTracker, read_counts, read_tracks
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.showing.traffic_drawing import identity_colour
from vehicle_pf_tracker.showing.video_file import video_writer

ROOT = Path(__file__).parents[2]
PROGRAMS = dict(
    re.findall(
        r"^## (.*?)\n```py\n(.*?)```", (ROOT / "docs" / "examples.md").read_text(), re.S | re.M
    )
)
GROUND = np.random.default_rng(0).integers(90, 130, (240, 320, 3)).astype(np.uint8)


def drive(frames=60, first=0):
    """Images of two vehicles that drive to the right, with their boxes, scores and classes."""
    for index in range(first, first + frames):
        boxes = [(10 + 4 * index, 60, 40, 30), (30 + 3 * index, 150, 50, 36)]
        frame = GROUND.copy()
        for shade, (x, y, w, h) in zip((20, 230), boxes, strict=True):
            frame[y : y + h, x : x + w] = shade
        yield frame, boxes, [0.9, 0.8], ["car", "bus"]


def test_without_boxes_what_moves_is_followed():
    tracker = TrafficTracker(frame_rate=25)
    for frame in [GROUND] * 25:
        assert tracker.update(frame) == ()
    for frame, *_ in drive(40):
        tracks = tracker.update(frame)
    assert sorted(track.id for track in tracks) == [1, 2]
    upper = min(tracks, key=lambda one: one.box.y)
    assert upper.box.centre == pytest.approx((10 + 4 * 39 + 20, 75), abs=4)


@pytest.mark.parametrize("at", [150, 230])
def test_a_lorry_that_its_cab_and_all_of_it_have_counted_counts_once(tmp_path, at):
    """Cab and trailer are 1 and 2; the box of all of it takes the latter's number for a while."""
    ground = np.repeat(GROUND, 2, axis=1)  # 640 px
    lines = tmp_path / "lines.yaml"
    lines.write_text(f"lines:\n  stop: {{from: [{at}, 240], to: [{at}, 0]}}\n")
    tracker = TrafficTracker(frame_rate=30, lines=lines)
    crossed, withdrawn, counts = [], [], []
    for index in range(75):
        x = 8 * index - 100
        boxes = np.array(
            [[x, 60, x + (100 if index > 28 else 60), 140], [x + 65, 75, x + 100, 140]]
        )
        boxes = boxes.clip(0, 640)
        boxes = boxes[boxes[:, 2] - boxes[:, 0] > 8]
        tracker.update(ground, boxes, [0.9] * len(boxes), format="xyxy")
        crossed += [one.identity for one in tracker.crossings]
        withdrawn += [one.identity for one in tracker.withdrawn]
        counts.append(tracker.counter.count("stop", "in"))
    assert (crossed, withdrawn) == ([1, 2], [2])
    assert (max(counts), counts[-1]) == (2, 1)


def test_stamps_tell_a_dropped_frame_and_mistakes_are_said():
    tracker = TrafficTracker(frame_rate=25)
    for index, (frame, *found) in enumerate(drive(50)):
        if index != 45:
            tracks = tracker.update(frame, *found, stamp_ns=index * 40_000_000)
    assert tracks[0].velocity == pytest.approx((4, 0), abs=0.3)
    with pytest.raises(ValueError, match="as many"):
        tracker.update(frame, [(1, 1, 5, 5)], [0.1, 0.2])
    with pytest.raises(ValueError, match="left, top, width and height"):
        tracker.update(frame, np.ones((4, 5)))  # corners and a score, for instance
    for image in (np.zeros((4, 4), np.uint8), None):  # None: the video has ended
        with pytest.raises(InputError, match="a frame must be"):
            tracker.update(image)


def test_what_cannot_be_meant_is_refused_at_the_start():
    with pytest.raises(InputError, match=r"'lost_aftr'.*did you mean 'lost_after'"):
        TrafficTracker(25, {"lost_aftr": 1.0})
    with pytest.raises(InputError, match="frame rate"):
        TrafficTracker(0)  # as OpenCV states for many a camera


def test_rows_may_lack_the_score():
    assert TrafficTracker(25).update_with_rows(GROUND, [[1, -1, 5, 5, 20, 20]]).shape == (0, 10)


def truth(index):
    """Boxes of the clip's image of this number: none before the vehicles come."""
    return np.array([(10 + 4 * index, 60, 40, 30), (30 + 3 * index, 150, 50, 36)], float)


@pytest.fixture(scope="module")
def clips(tmp_path_factory):
    """A folder with what the programs read: a clip of two vehicles, their boxes, and a line."""
    folder = tmp_path_factory.mktemp("clips")
    (folder / "clips").mkdir()
    with video_writer(folder / "traffic.mp4", (320, 240), 25) as write:
        for index, frame in enumerate([GROUND] * 25 + [frame for frame, *_ in drive(40)]):
            write(frame, index / 25)
    for name in ("north.mp4", "south.mp4", "clips/a.mp4", "clips/b.mp4"):
        shutil.copy(folder / "traffic.mp4", folder / name)
    rows = [[26 + k, -1, *box, 0.9] for k in range(40) for box in truth(k)]
    np.savetxt(folder / "det.txt", rows, fmt="%g", delimiter=",")
    (folder / "lines.yaml").write_text("lines: {gate: {from: [120, 240], to: [120, 0]}}")
    return folder


class Values(np.ndarray):
    """An array that looks like a tensor."""

    def cpu(self):
        return self

    def numpy(self):
        return np.array(self)


class Yolo:
    """Stand-in of Ultralytics, which runs a network of YOLOv8's form as Ultralytics does.

    Square BGR images as wide as the network's input; the network is the file's, with `.onnx`.
    """

    def __init__(self, name):
        runtime = pytest.importorskip("onnxruntime")
        self._session = runtime.InferenceSession(str(Path(name).with_suffix(".onnx")))
        self.names = literal_eval(self._session.get_modelmeta().custom_metadata_map["names"])

    def __call__(self, frame, conf, verbose):
        planes = np.float32(frame[:, :, ::-1].transpose(2, 0, 1)[None] / 255)
        (output,) = self._session.run(None, {"images": planes})
        rows = output[0].T
        scores = rows[:, 4:].max(axis=1)
        kinds = rows[:, 4:].argmax(axis=1)
        boxes = np.hstack([rows[:, :2] - rows[:, 2:4] / 2, rows[:, 2:4]])
        kept = np.array(cv2.dnn.NMSBoxes(boxes, scores, conf, 0.7), int)
        corners = np.hstack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]])
        names = ("xyxy", corners), ("conf", scores), ("cls", kinds)
        found = SimpleNamespace(
            **{name: np.asarray(values[kept], float).view(Values) for name, values in names}
        )
        return [SimpleNamespace(boxes=found)]


def output(path):
    """Run a program in its folder; return the lines that it prints."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, path]
    done = subprocess.run(
        command, cwd=path.parent, env=env, capture_output=True, text=True, check=False
    )
    return done.stdout.splitlines() or [done.stderr]


@pytest.fixture
def program(clips, monkeypatch, capsys):
    """Run a program of the page in the folder of clips; return what it prints."""
    monkeypatch.chdir(clips)
    monkeypatch.setitem(sys.modules, "ultralytics", SimpleNamespace(YOLO=Yolo))

    def call(name):
        exec(compile(PROGRAMS[name], name, "exec"), {"__name__": "__main__"})
        return capsys.readouterr().out

    return call


def test_there_are_eight_programs():
    assert len(PROGRAMS) == 8


def test_the_program_for_ultralytics_names_each_vehicle(program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    side, size, step = 32, 320, 4
    yolov8_anywhere(tmp_path / "yolov8n.onnx", size, side, step)
    ground = np.vstack([GROUND, GROUND])[:size]
    tops = {(255, 0, 0): 60, (0, 0, 255): 200}  # a red car and a blue truck
    with video_writer(tmp_path / "traffic.mp4", (size, size), 25) as write:
        for index in range(50):
            frame = ground.copy()
            for colour, top in tops.items():
                left = step * (index + 5)
                frame[top : top + side, left : left + side] = colour
            write(frame, index / 25)
    lines = program("With the detections of Ultralytics").splitlines()
    words = [line.split(maxsplit=3) for line in lines]
    assert {tuple(line[:3]) for line in words} == {
        ("1", "car", "TRACKING"), ("2", "truck", "TRACKING"),
    }  # fmt: skip
    # Every box is a vehicle's: the last ones stand where it stands.
    for line, top in zip(words[-2:], tops.values(), strict=True):
        left_and_top = list(map(float, line[3].split(",")))[:2]
        assert left_and_top == pytest.approx([step * 54, top], abs=3)


def test_the_program_for_rows_writes_tracks(program, clips):
    program("Rows of MOTChallenge")
    rows = np.loadtxt(clips / "tracks.txt", delimiter=",")
    assert set(rows[:, 1]) == {1, 2}
    last = rows[rows[:, 0] == 65]
    assert last[:, 2:6] == pytest.approx(truth(39), abs=2)
    assert (last[:, 7:] == -1).all()


def test_the_program_that_counts_says_who_crossed(program):
    lines = program("Count").splitlines()
    assert sorted(line.split()[2] for line in lines[:-1]) == ["1", "2"]
    assert "'gate: in': 2" in lines[-1]


def test_the_notebook_shows_pictures_with_boxes(program, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    shown = []
    monkeypatch.setattr(pyplot, "imshow", shown.append)
    monkeypatch.setattr(pyplot, "show", lambda: None)
    program("Pictures in a notebook")
    assert len(shown) == 2
    assert (shown[1] == identity_colour(1)).all(axis=2).sum() > 100


def test_the_cameras_are_followed_in_processes(clips):
    path = clips / "cameras.py"
    path.write_text(PROGRAMS["Several cameras in processes"])
    assert output(path) == ["[2, 2]"]


def test_a_folder_of_clips_gives_tables(program, clips):
    pytest.importorskip("dask.bag", reason="Dask is not installed")
    path = clips / "folder.py"
    path.write_text(PROGRAMS["A folder of clips with Dask"])
    assert output(path)[-1] == "[0, 0]"
    shutil.copytree(clips / "results" / "a", clips / "results" / "north")
    pytest.importorskip("pandas")
    said = program("The tables of a run").splitlines()
    assert said[0].startswith("2 vehicles, the widest of ")
    assert said[1].split() == ["min", "max"]
    rows = read_tracks(clips / "results" / "a")
    assert rows.dtype["stamp_ns"] == rows.dtype["id"] == np.int64
    assert np.isnan(rows.score[rows.mode == "OCCLUDED"]).all()
    with pytest.raises(InputError, match=r"cannot read the table .*counts\.csv"):
        read_counts(clips / "results" / "a")


DETECT = """
import numpy as np
import supervision as sv

index = -26


def detect(frame):
    global index
    index += 1
    if index < 0:
        return sv.Detections.empty()
    left = np.array([[10 + 4 * index, 60], [30 + 3 * index, 150]], float)
    corners = np.hstack([left, left + [[40, 30], [50, 36]]])
    named = {"class_name": np.array(["car", "bus"])}
    score, number = np.array([0.9, 0.8]), np.array([2, 5])
    return sv.Detections(xyxy=corners, confidence=score, class_id=number, data=named)


"""
CHECK = """
numbers, classes = tracked.tracker_id.tolist(), tracked.class_id.tolist()
print(numbers, sorted(classes), sorted(tracked.data["class_name"].tolist()))
print(type(tracked) is sv.Detections, len(tracked[tracked.data["mode"] == "TRACKING"]))
print(tracked.xyxy.round().astype(int).tolist())
empty = tracker.update_with_detections(frame, sv.Detections.empty())
print(len(empty), sv.VideoInfo.from_video_path("seen.mp4").total_frames)
"""


def test_supervision_s_own_detections_come_in_and_go_out(clips):
    pytest.importorskip("supervision", reason="supervision is not installed")
    path = clips / "seen.py"
    path.write_text(DETECT + PROGRAMS["With supervision"] + CHECK)
    numbers, kind, corners, rest = output(path)
    assert numbers == "[1, 2] [2, 5] ['bus', 'car']"
    assert kind == "True 2"
    boxes = np.array(json.loads(corners), float)
    boxes[:, 2:] -= boxes[:, :2]
    assert boxes == pytest.approx(truth(39), abs=2)
    assert rest == "2 65"  # a detector that saw nothing leaves both for a while


def test_a_copy_goes_on_with_the_same_numbers():
    """Pickled and copied, by motion and with boxes given, bit for bit."""
    rng = np.random.default_rng(4)
    road = rng.integers(90, 130, (120, 160, 3), np.uint8)
    car = rng.integers(0, 255, (16, 28, 3), np.uint8)

    def image(index):
        frame = road + rng.integers(0, 3, road.shape, np.uint8)
        frame[60:76, 2 * index : 2 * index + 28] = car
        return frame

    for is_given in (True, False):
        tracker = TrafficTracker(25.0)
        for index in range(30):
            boxes = [[2.0 * index, 60.0, 28.0, 16.0]] if is_given else None
            tracker.update(image(index), boxes)
        copies = [pickle.loads(pickle.dumps(tracker)), copy.deepcopy(tracker)]
        for index in range(30, 60):
            frame, boxes = image(index), [[2.0 * index, 60.0, 28.0, 16.0]] if is_given else None
            tracker.update(frame, boxes)
            for other in copies:
                other.update(frame, boxes)
                assert repr(other.estimates) == repr(tracker.estimates)
        assert tracker.estimates


def test_the_forms_of_boxes_say_the_same():
    frame = np.zeros((120, 160, 3), np.uint8)
    forms = {"ltwh": [10, 20, 40, 30], "xyxy": [10, 20, 50, 50], "cxcywh": [30, 35, 40, 30]}
    results = set()
    for form, box in forms.items():
        tracker = TrafficTracker(25.0)
        for index in range(40):
            moved = np.array([box], float)
            moved[:, [0, 2] if form == "xyxy" else 0] += 2 * index
            shown = tracker.update(frame, moved, format=form)
        results.add(repr(shown))
    assert len(results) == 1 and results != {"()"}
    with pytest.raises(ValueError, match="format is one of 'ltwh', 'xyxy', 'cxcywh', not 'xywh'"):
        TrafficTracker(25.0).update(frame, [[1, 2, 3, 4]], format="xywh")


def test_corners_taken_for_sizes_are_warned_of_once():
    frame = np.zeros((120, 160, 3), np.uint8)
    tracker = TrafficTracker(25.0)
    with pytest.warns(UserWarning, match="not two corners"):
        tracker.update(frame, [[60, 50, 120, 90]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tracker.update(frame, [[60, 50, 120, 90]])
        TrafficTracker(25.0).update(frame, [[150, 50, 30, 20]])  # a vehicle that drives in
        TrafficTracker(25.0).update(frame, [[60, 50, 120, 90]], format="xyxy")


def test_one_of_several_corners_beyond_the_image_is_enough():
    frame = np.zeros((120, 160, 3), np.uint8)
    corners = [[10, 10, 50, 40], [90, 60, 130, 90]]  # as sizes the second one ends at x = 220
    tracker = TrafficTracker(25.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tracker.update(frame, corners)
        tracker.update(frame, corners)  # of four boxes only
    with pytest.warns(UserWarning, match="3 of 6 boxes reach beyond"):
        tracker.update(frame, corners)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        true = TrafficTracker(25.0)
        for _ in range(10):  # one drives in from the right, none could be two corners
            true.update(frame, [[60, 30, 40, 30], [140, 60, 40, 30]])


def test_images_of_opencv_are_said_once():
    rng = np.random.default_rng(1)
    frames = [rng.integers(0, 255, (120, 160, 3), np.uint8) for _ in range(30)]
    ours, theirs = TrafficTracker(25.0), TrafficTracker(25.0, colour="bgr")
    for index, frame in enumerate(frames):
        boxes = [[2.0 * index, 60.0, 28.0, 16.0]]
        assert repr(ours.update(frame, boxes)) == repr(theirs.update(frame[..., ::-1], boxes))
    with pytest.raises(ValueError, match="colour is one of 'rgb', 'bgr', not 'BGR'"):
        TrafficTracker(25.0, colour="BGR")

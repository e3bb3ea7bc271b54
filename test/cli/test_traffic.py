# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`traffic` from the command line, with a tracker that follows whatever is detected."""

import csv
import json
import math
import os
import re
import signal
import socket
import sys
import threading
from pathlib import Path
from urllib.request import ProxyHandler, build_opener

import cv2
import numpy as np
import pytest
from page_visitors import when_one_waits
from small_recordings import write_video

from vehicle_pf_tracker import read_zones
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.following import counted_vehicles
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

COUNT = 20
HIDDEN = range(8, 12)
"""Frames (from 1) in which the first vehicle is not detected."""
LINES = """
lines:
  exit: {from: [0, 60], to: [96, 60], directions: [down, up]}
zones:
  yard: [[0, 0], [96, 0], [96, 40], [0, 40]]
"""


class Follower:
    """Stand-in of the tracker: the k-th detection is vehicle k, hidden where it is missing."""

    def __init__(self, parameters=None, road=None):
        self.parameters, self.frame_period, self.seed = parameters, 0.0, 7
        self._boxes, self._given, self._next = {}, {}, 100

    def step(self, frame, detections=None, elapsed=1.0):
        seen = {} if detections is None else dict(enumerate(detections.boxes.tolist(), start=1))
        # The first detection is the left one.
        seen = {1 if box[0] < 40 else 2: box for box in seen.values()}
        found = []
        for identity in sorted({*self._boxes, *seen}):
            mode = TrackMode.TRACKING if identity in seen else TrackMode.OCCLUDED
            last = self._boxes.get(identity, seen.get(identity))
            x, y, width, height = seen.get(identity) or (last[0], last[1] + 3, *last[2:])
            self._boxes[identity] = (x, y, width, height)
            found.append(self._estimate(identity, Box(x, y, width, height), mode))
        for identity, (box, label) in self._given.items():
            found.append(self._estimate(identity, box, TrackMode.TRACKING, label))
        return tuple(found)

    def add(self, box, label=""):
        self._next += 1
        self._given[self._next] = box, label
        return self._next

    def remove(self, identity):
        return self._given.pop(identity, None) is not None

    def reset(self):
        self._boxes.clear()

    @staticmethod
    def _estimate(identity, box, mode, label="car"):
        return TrackEstimate(
            identity, box, (0.0, 3.0), mode, 0.9, label, math.nan, 1.0, None, identity
        )


@pytest.fixture(autouse=True)
def _tracker(monkeypatch, request):
    if "real" not in request.fixturenames:
        monkeypatch.setattr(counted_vehicles, "MultiVehicleTracker", Follower)


@pytest.fixture
def real():
    """Ask for the package's own tracker."""


@pytest.fixture
def bag(tmp_path):
    """A recording of grey noise, and det.txt with two vehicles that drive down."""
    rows = []
    with RecordingWriter(tmp_path / "bag") as writer:
        for index in range(COUNT):
            frame = np.random.default_rng(index).integers(90, 120, (96, 128, 3), np.uint8)
            writer.write_image(1_000_000_000 + index * 40_000_000, frame)
            if index + 1 not in HIDDEN:
                rows.append(f"{index + 1},-1,20,{3 * index + 10},16,12,0.9,-1,-1,-1")
            rows.append(f"{index + 1},-1,60,{3 * index + 5},16,12,0.8,-1,-1,-1")
    (tmp_path / "det.txt").write_text("\n".join(rows) + "\n")
    (tmp_path / "lines.yaml").write_text(LINES)
    return tmp_path / "bag"


@pytest.fixture
def run(bag, tmp_path):
    """Call `traffic` on the recording with its detections; return the folder it wrote."""

    def call(*words, status=0, detections=True):
        out = tmp_path / "out"
        given = ["--detections", str(tmp_path / "det.txt")] if detections else []
        assert main(["traffic", str(bag), "-o", str(out), *given, *map(str, words)]) == status
        return out

    return call


def table(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_tracks_of_every_frame_are_written(run):
    out = run()
    assert {path.name for path in out.iterdir()} == {
        "tracks.csv", "tracks.txt", "run.json", "summary.png", "heat.png",
    }  # fmt: skip
    rows = table(out / "tracks.csv")
    assert len(rows) == 2 * COUNT
    assert [row["frame"] for row in rows[:4]] == ["1", "1", "2", "2"]
    assert {row["frame"] for row in rows if row["mode"] == "OCCLUDED"} == set(map(str, HIDDEN))
    mot = [line.split(",") for line in (out / "tracks.txt").read_text().splitlines()]
    assert len(mot) == 2 * COUNT
    assert mot[0][:6] == ["1", "1", "20.00", "10.00", "16.00", "12.00"]


def test_a_region_of_interest_alone_counts_nothing(run, tmp_path):
    (tmp_path / "roi.yaml").write_text("roi: {a: {outside: [[0, 0], [50, 0], [50, 96], [0, 96]]}}")
    out = run("--lines", tmp_path / "roi.yaml")
    assert {row["x"] for row in table(out / "tracks.csv")} == {"68.0"}  # of the second vehicle
    assert not (out / "counts.csv").exists()


def test_counts_at_lines_and_in_zones(run, tmp_path, capsys):
    out = run("--lines", tmp_path / "lines.yaml")
    counts = table(out / "counts.csv")
    # The lower edges pass y = 60 in frames 14 and 15, and y = 40 in frames 7 to 9.
    downs = [(row["id"], row["frame"]) for row in counts if row["direction"] == "down"]
    assert [one for one, _ in downs] == ["1", "2"]
    assert {row["place"] for row in counts} == {"exit", "yard"}
    speeds = [float(row["speed_px_s"]) for row in counts if row["place"] == "exit"]
    assert speeds == pytest.approx([75.0, 75.0])  # 3 px in 0.04 s
    info = json.loads((out / "run.json").read_text())["summary"]
    assert {"place": "exit", "direction": "down", "class": "car", "count": 2} in info["counts"]
    both = [(one["class"], one["direction"]) for one in info["intervals"]]
    assert both == [(None, "down"), ("car", "down"), (None, "up")]
    downs = [one for one in info["intervals"] if one["direction"] == "down"]
    assert all(one["low"] <= 2 <= one["high"] for one in downs)
    text = capsys.readouterr().out
    assert "line exit: 2 down (2 car), 0 up; 90 % intervals " in text
    assert "zone yard: 0 entered, 2 left; " in text
    (yard,) = info["zones"]
    assert (yard["zone"], yard["seconds"], yard["max"]) == ("yard", 0.8, 2)
    (row,) = table(out / "zones.csv")
    assert (row["mean"], row["occupied"]) == (f"{yard['mean']:.4f}", f"{yard['occupied']:.4f}")
    # Lower edges are above y = 40 in the first seven and nine of twenty images.
    assert yard["mean"] == pytest.approx((7 + 9) / COUNT, abs=2 / COUNT)
    assert f"{yard['mean']:.1f} inside on average, at most 2, occupied" in text


def test_the_occupancy_of_zones_is_a_table_of_intervals(run, tmp_path):
    rows = table(run("--lines", tmp_path / "lines.yaml", "--interval", 0.2) / "zones.csv")
    assert [row["zone"] for row in rows] == ["yard"] * 4
    assert [row["seconds"] for row in rows] == ["0.200"] * 4
    assert [row["max"] for row in rows] == ["2", "2", "0", "0"]
    assert rows[0]["mean"] == "2.0000" and rows[0]["occupied"] == "1.0000"
    assert 0 < float(rows[1]["mean"]) < 2
    assert read_zones(tmp_path / "out")["max"].tolist() == [2, 2, 0, 0]
    run("--overwrite")
    assert not (tmp_path / "out" / "zones.csv").exists()


def test_the_summary_is_for_people(run, capsys):
    run()
    out, err = capsys.readouterr()
    assert "2 vehicles in 20 frames, at most 2 at once (2 car)" in out
    assert "1 occlusion survived under the same number; 0 vehicles not seen again" in out
    assert [line for line in err.splitlines() if not line.startswith("tracked")] == []


def test_run_json_says_how_it_was_made(run, tmp_path):
    info = json.loads((run("--set", "lost_after=1.5") / "run.json").read_text())
    assert info["command"][:2] == ["vehicle-pf-tracker", "traffic"]
    assert info["parameters"]["lost_after"] == 1.5
    assert info["detector"] == str(tmp_path / "det.txt")
    assert (info["variant"], info["seed"]) == ("traffic", 7)
    assert info["versions"]["numpy"] == np.__version__
    assert info["summary"]["vehicles"] == 2


def test_a_part_of_the_source_keeps_its_numbers(run):
    rows = table(run("--start", 5, "--end", 9) / "tracks.csv")
    assert {row["frame"] for row in rows} == set("56789")
    # Detections belong to the frames' numbers in the source.
    assert float(rows[0]["y"]) == 3 * 4 + 10 + 6


def test_the_package_s_own_tracker_counts_both_vehicles_and_repeats_itself(run, tmp_path, real):
    # Boxes of one size that drive down: a camera that looks straight down.
    words = ["--lines", tmp_path / "lines.yaml", "--seed", 5, "--set", "motion.horizon=-50"]
    out = run(*words)
    names = ("tracks.csv", "tracks.txt", "counts.csv")
    first = [(out / name).read_bytes() for name in names]
    downs = [row["id"] for row in table(out / "counts.csv") if row["direction"] == "down"]
    assert len(downs) == len(set(downs)) == 2
    hidden = [row for row in table(out / "tracks.csv") if row["frame"] in set(map(str, HIDDEN))]
    assert len({row["id"] for row in hidden}) == 2
    run(*words, "--overwrite")
    assert [(out / name).read_bytes() for name in names] == first


def test_motion_is_found_without_any_detections(tmp_path, real, capsys):
    rng = np.random.default_rng(0)
    ground, paint = (rng.integers(low, low + 30, (120, 160, 3)) for low in (90, 180))
    with RecordingWriter(tmp_path / "bag") as writer:
        for index in range(100):
            frame = ground + rng.integers(0, 5, ground.shape)
            left = 2 * (index - 60)  # the road is empty at first
            if left >= 0:
                frame[60:84, left : left + 36] = paint[:24, :36]
            writer.write_image(1_000_000_000 + index * 40_000_000, frame.astype(np.uint8))
    out = tmp_path / "out"
    assert main(["traffic", str(tmp_path / "bag"), "-o", str(out)]) == 0
    assert capsys.readouterr().out.startswith("1 vehicle in 100 frames")
    last = table(out / "tracks.csv")[-1]
    assert float(last["x"]) == pytest.approx(2 * 39 + 18, abs=4)


def still(count):
    return [np.full((96, 128, 3), 90, np.uint8)] * count


def cuts(count):
    """A scene that is another one every ten frames."""
    scenes = np.random.default_rng(0).integers(0, 255, (9, 12, 16, 3), np.uint8)
    large = [cv2.resize(one, (128, 96), interpolation=cv2.INTER_NEAREST) for one in scenes]
    return [large[index // 10] for index in range(count)]


@pytest.mark.parametrize(
    ("frames", "detection", "roi", "why"),
    [
        (still(10), "", "", "too few to learn what stands, which takes 10 to 20 images"),
        (still(40), "", "", "nothing moves in them"),
        (cuts(90), "", "", "the camera moves"),
        (still(10), "99,-1,20,20,16,12,0.9", "", "det.txt has no box in them"),
        (
            still(10),
            "5,-1,20,20,16,12,0.9",
            "",
            "stand still with scores too low",
        ),
        (still(10), "5,-1,20,20,16,12,0.9", "[[60, 0], [90, 0], [90, 90]]", "all 1 detections are"),
    ],
)
def test_a_clip_without_vehicles_says_why(tmp_path, real, capsys, frames, detection, roi, why):
    video = write_video(tmp_path / "clip.avi", frames)
    (tmp_path / "det.txt").write_text(detection)
    (tmp_path / "roi.yaml").write_text(f"roi: {{near: {{inside: {roi}}}}}")
    words = ["--detections", str(tmp_path / "det.txt")] if detection else []
    words += ["--lines", str(tmp_path / "roi.yaml")] if roi else []
    assert main(["traffic", str(video), "-o", str(tmp_path / "out"), *words]) == 0
    said, results = capsys.readouterr().out.splitlines()
    assert said.startswith(f"no vehicle was found in {len(frames)} frames: ")
    assert why in said
    # A picture without vehicles shows no path.
    assert results == f"results are in {tmp_path / 'out'}"


def test_results_that_exist_are_told_before_a_network_is_loaded(run, capsys):
    run()
    run("--model", "none.onnx", status=1, detections=False)
    assert "tracks.csv exists; give --overwrite" in capsys.readouterr().err


def test_a_run_that_fails_keeps_the_results_before(run, capsys):
    out = run()
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    run("--overwrite", "--target", "500,500,10,10", status=1)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


def test_the_video_has_every_frame(run, tmp_path):
    run("--lines", tmp_path / "lines.yaml", "--video", tmp_path / "out.mp4")
    video = cv2.VideoCapture(str(tmp_path / "out.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == COUNT
    assert video.get(cv2.CAP_PROP_FPS) == pytest.approx(25, abs=0.1)


def test_targets_given_by_hand_are_followed_from_their_frame(run):
    words = ["--target", "van@3:50,50,20,10", "--target", "5,5,10,10", "--detector", "none"]
    rows = table(run(*words, detections=False) / "tracks.csv")
    by_id = {}
    for row in rows:
        by_id.setdefault((row["id"], row["label"]), []).append(int(row["frame"]))
    # Followed in the frames after the one that they are given in.
    assert {key: min(frames) for key, frames in by_id.items()} == {
        ("101", ""): 2,
        ("102", "van"): 4,
    }


def test_what_can_have_no_effect_is_said(run, tmp_path, capsys):
    (tmp_path / "far.yaml").write_text("lines: {far: {from: [500, 0], to: [500, 90]}}")
    run("--lines", tmp_path / "far.yaml", "--target", "van@99:50,50,20,10")
    err = capsys.readouterr().err
    assert "'far' is outside the image, so that nothing counts there" in err
    assert "the target 50,50,20,10 is in frame 99, and no such frame was read" in err


@pytest.mark.parametrize(
    ("words", "detections", "said", "status"),
    [
        (["--detector", "none"], False, "without a detector nothing is followed", 2),
        (["--detector", "motion"], True, "give either --detections, or --detector", 2),
        (["--detector", "none", "--model", "a.onnx"], False, "--model is not used by", 2),
        (["--classes", "car", "--conf", ".3"], False, "are for a network; give it with", 2),
        (["--detector", "model"], False, "detector.model names no .onnx file", 1),
        (["--set", "lost_afterr=1"], True, "did you mean 'lost_after'", 1),
        (["--set", "target.width=5", "--set", "target.height=5"], True, "give --target", 1),
        (["--set", "road.from_tf=true", "--set", "road.intrinsics=1,1,1,1"], True, "for nodes", 1),
        (["--target", "500,500,10,10"], True, "in frame 1, the target", 1),
        (["--video", "a.avi"], True, "must end in .mp4", 1),
        (["--start", "99"], True, "no frame lies between", 1),
        (["--lines", "none.yaml"], True, "cannot read the counting lines none.yaml", 1),
        (["--detector", "nothing"], False, "invalid choice", 2),
        (["--serve", "70000"], True, "'70000' is not [HOST:]PORT, with a port from 0", 2),
        (["--serve", "a:b"], True, "'a:b' is not [HOST:]PORT", 2),
        (["--serve", "--token", "a/b"], True, "a token has 8 to 100 letters", 2),
    ],
)  # fmt: skip
def test_a_mistake_is_one_sentence(run, tmp_path, capsys, words, detections, said, status):
    out = run(*words, status=status, detections=detections)
    err = capsys.readouterr().err
    assert said in err
    assert "Traceback" not in err
    assert not out.exists() or not any(out.iterdir())


def test_without_scipy_the_extra_is_named(run, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    out = run(status=1)
    assert "pip install 'vehicle_pf_tracker[video]'" in capsys.readouterr().err
    assert not out.exists()


def test_a_page_shows_picture_and_counts_meanwhile(run, monkeypatch, tmp_path, capsys):
    answers, waits = [], when_one_waits(monkeypatch)

    class Watched(Follower):
        """Has somebody ask for the picture while the third image is followed."""

        steps = 0

        def step(self, frame, detections=None, elapsed=1.0):
            self.steps += 1
            if self.steps == 3:
                (url,) = re.findall(
                    r"open (http://127\.0\.0\.1:\d+/\S+/) in", capsys.readouterr().out
                )
                Watched.asking = threading.Thread(target=self.ask, args=[url])
                Watched.asking.start()
                assert waits.wait(30)
            return super().step(frame, detections, elapsed)

        def ask(self, url):
            get = build_opener(ProxyHandler({})).open
            answers.extend(get(url + name).read() for name in ("picture.jpg", "counts.json"))

    monkeypatch.setattr(counted_vehicles, "MultiVehicleTracker", Watched)
    run("--serve", "--lines", tmp_path / "lines.yaml")
    Watched.asking.join(30)
    picture, facts = answers
    assert picture.startswith(b"\xff\xd8")
    assert json.loads(facts) == {
        "vehicles": 2,
        "summary": "0:00.1, frame 3, 2 vehicles in view",
        "tables": [
            {"title": "in view", "columns": ["class", "vehicles"], "rows": [["car", 2]]},
            {
                "title": "lines",
                "columns": ["line", "direction", "counted", "last minute", "km/h", "90 %"],
                "rows": [["exit", to, 0, 0, None, "0 to 0"] for to in ("down", "up")],
            },
            {
                "title": "zones",
                "columns": ["zone", "inside", "entered", "left"],
                "rows": [["yard", 2, 0, 0]],
            },
        ],
        "ended": False,
    }


def test_an_interrupt_keeps_what_was_written(run, monkeypatch, capsys):
    class Interrupted(Follower):
        steps = 0

        def step(self, frame, detections=None, elapsed=1.0):
            self.steps += 1
            if self.steps == 9:
                os.kill(os.getpid(), signal.SIGINT)
            return super().step(frame, detections, elapsed)

    monkeypatch.setattr(counted_vehicles, "MultiVehicleTracker", Interrupted)
    out = run(status=130)
    assert {row["frame"] for row in table(out / "tracks.csv")} == set("123456789")
    assert (out / "summary.png").exists()
    assert json.loads((out / "run.json").read_text())["summary"]["frames"] == 9
    assert "a signal ended the run after 9 of 20 frames" in capsys.readouterr().err


def test_an_unexpected_error_costs_its_frame_alone(run, monkeypatch):
    class Failing(Follower):
        steps = 0

        def step(self, frame, detections=None, elapsed=1.0):
            self.steps += 1
            if self.steps == 9:
                raise ZeroDivisionError("by zero")
            return super().step(frame, detections, elapsed)

    monkeypatch.setattr(counted_vehicles, "MultiVehicleTracker", Failing)
    out = run()
    frames = {int(row["frame"]) for row in table(out / "tracks.csv")}
    assert frames == {*range(1, 21)} - {9}
    notices = json.loads((out / "run.json").read_text())["notices"]
    assert "frame 9 was rejected: unexpected ZeroDivisionError: by zero" in notices


def block(language):
    """The one block of code of this language on the page."""
    page = Path(__file__).parents[2] / "docs" / "counting.md"
    (code,) = re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)
    return code


def test_the_lines_of_the_page_are_counted_at(run, tmp_path):
    (tmp_path / "page.yaml").write_text(block("yaml"))
    counts = table(run("--lines", tmp_path / "page.yaml") / "counts.csv")
    # The first vehicle begins below the line, and drives past its end at x = 40.
    assert [(row["place"], row["direction"], row["id"]) for row in counts] == [("exit", "in", "2")]


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        ("heat_picture.HeatPicture.add", "heat.png"),
        ("heat_picture.HeatPicture.write", "heat.png"),
        ("path_picture.PathPicture.add", "summary.png"),
        ("path_picture.PathPicture.write", "summary.png"),
        ("video_file.replacing", "made.mp4"),
    ],
)
def test_a_picture_that_fails_costs_itself_alone(run, tmp_path, monkeypatch, capsys, broken, told):
    def fail(*_, **__):
        raise RuntimeError("it fails")

    monkeypatch.setattr(f"vehicle_pf_tracker.showing.{broken}", fail)
    out = run("--lines", tmp_path / "lines.yaml", "--video", tmp_path / "made.mp4", status=1)
    err = capsys.readouterr().err
    assert f"{told}: it fails; all else is written" in err and "Traceback" not in err
    assert table(out / "tracks.csv") and table(out / "counts.csv")
    (notice,) = json.loads((out / "run.json").read_text())["notices"]
    assert told in notice
    made = {path.name for path in [*out.iterdir(), *tmp_path.iterdir()]}
    assert told not in made
    # The heat is drawn over the frame that the paths were drawn over.
    rest = {"heat.png", "summary.png", "made.mp4"} - {told}
    assert rest - ({"heat.png"} if broken == "path_picture.PathPicture.add" else set()) <= made


def test_a_port_that_is_taken_costs_the_page_alone(run, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        out = run("--serve", taken.getsockname()[1], status=1)
    assert "cannot serve at port" in capsys.readouterr().err
    assert table(out / "tracks.csv")

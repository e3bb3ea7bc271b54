# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The comparison of `traffic` with other trackers, its files and its page."""

import json

import numpy as np
import pytest

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.mot_folder import write_mot_folder
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE, follow
from vehicle_pf_tracker.evaluation.traffic.comparison import cases_of, compare
from vehicle_pf_tracker.evaluation.traffic.comparison_report import write_traffic_report
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

SETTINGS = {"frames": 12, "vehicles": 4}


@pytest.fixture(scope="module")
def sequence(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mot") / "few"
    write_mot_folder(make_traffic_scene("traffic-lanes", settings=SETTINGS), folder, 0)
    for path in (folder / "det").glob("*.txt"):
        if path.stem not in {"good", "misses"}:
            path.unlink()
    return read_sequence(folder)


class Echo:
    """A tracker that gives every detection its place in the list as its identity."""

    def __init__(self, parameters):
        self.seed = parameters.seed
        self.frame_period = 1.0

    def step(self, frame, detections, elapsed):
        assert frame.shape == (360, 640, 3)
        modes = (TrackMode.TRACKING, TrackMode.OCCLUDED, TrackMode.TENTATIVE, TrackMode.LOST)
        return tuple(
            TrackEstimate(
                0 if modes[i % 4] is TrackMode.TENTATIVE else i + 1,
                Box(*box),
                (0, 0),
                modes[i % 4],
                1.0,
                "",
                1.0,
                1.0,
                None,
                i + 1,
            )
            for i, box in enumerate(detections.boxes.tolist())
        )


class Worker:
    """Scores tracks by their number, and tracks nothing."""

    def score(self, sequence, tracks):
        names = ("HOTA", "DetA", "AssA", "LocA", "IDF1", "MOTA")
        return {**dict.fromkeys(names, float(len(tracks))), "IDSW": 3, "Frag": 1, "FP": 0, "FN": 0}

    def track(self, name, sequence, detections):
        self.asked = name, len(detections)
        return np.empty((0, 6)), 0.001


def test_cases_are_all_sources_or_those_asked_for(sequence):
    assert [source for _, source in cases_of([sequence])] == ["good", "misses", MOTION_SOURCE]
    assert cases_of([sequence], ["misses"]) == [(sequence, "misses")]


def test_tracked_and_occluded_vehicles_are_the_tracks(sequence):
    (case,) = cases_of([sequence], ["good"])
    tracks, detections, seconds = follow(case, TrafficParameters(), Echo)
    assert (detections == sequence.detections["good"]).all()
    assert set(tracks[:, 1]) == {1, 2}
    first = detections[detections[:, 0] == 12][:2]
    assert tracks[tracks[:, 0] == 12][:, 2:].tolist() == first[:, 1:5].tolist()
    assert seconds > 0


def test_the_tracker_runs_on_what_moves_and_passes_it_on(sequence):
    (case,) = cases_of([sequence], [MOTION_SOURCE])
    tracks, detections, _ = follow(case, TrafficParameters())
    assert tracks.shape[1:] == detections.shape[1:] == (6,)
    assert set(detections[:, 0]) <= set(range(1, 13))
    again = follow(case, TrafficParameters())
    assert (again[0] == tracks).all()
    assert (again[1] == detections).all()


@pytest.fixture(scope="module")
def results(sequence):
    worker = Worker()
    cases = cases_of([sequence], ["misses", "good"])
    progress = []
    found = list(
        compare(
            cases, worker, TrafficParameters(), range(2), baselines=["sort"], make=Echo,
            on_progress=lambda *counts: progress.append(counts),
        )
    )  # fmt: skip
    assert progress == [(12, 24), (24, 24)]
    assert worker.asked == ("sort", len(sequence.detections["misses"]))
    return found


def test_seeds_are_ours_and_baselines_run_once(results):
    assert [(one.source, one.system, one.seed) for one in results] == [
        (source, system, seed)
        for source in ("good", "misses")
        for system, seed in (("traffic", 0), ("traffic", 1), ("sort", None))
    ]


def test_files_hold_means_over_seeds(results, tmp_path):
    tables = write_traffic_report(results, tmp_path, {"command": ["evaluate", "<few>"]})
    assert list(tables) == ["few, good", "few, misses"]
    header, rows = tables["few, good"]
    assert header[:3] == ["system", "HOTA", "DetA"]
    assert [row[0] for row in rows] == ["traffic", "sort"]
    assert rows[0][header.index("switches")] == "3"
    assert rows[1][header.index("ms")] == "1.0"
    assert rows[1][header.index("never found")] == "4 of 4"  # the baseline tracks nothing
    assert rows[1][header.index("false numbers")] == "0"
    assert "## few, good" in (tmp_path / "traffic.md").read_text()
    assert (tmp_path / "traffic.csv").read_text().count("\n") == 5
    document = json.loads((tmp_path / "traffic.json").read_text())
    assert len(document["results"]) == 6
    assert document["lines"][0]["runs"] == 2

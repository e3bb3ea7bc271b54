# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The client of the traffic baselines and its worker."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scored_scenes import scene

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation import baseline_process as client
from vehicle_pf_tracker.evaluation.baseline_process import BASELINES_VARIABLE, DEFAULT_INTERPRETER
from vehicle_pf_tracker.evaluation.traffic.baselines import TRAFFIC_BASELINES, TrafficWorker

PYTHON = Path(sys.executable)
FRAMES, SIZE = 30, (200, 120)


def environment():
    """The interpreter that `make baselines` builds, if it has what is needed."""
    python = Path(os.environ.get(BASELINES_VARIABLE) or DEFAULT_INTERPRETER)
    probe = [str(python), "-c", "import trackers, trackeval"]
    if not python.is_file() or subprocess.run(probe, capture_output=True, check=False).returncode:
        pytest.skip("needs TrackEval and trackers: `make baselines`")
    return python


@pytest.fixture(scope="module")
def real():
    with TrafficWorker(environment()) as started:
        yield started


def lanes():
    """Rows of two vehicles side by side: frame, identity, left, top, width, height."""
    return np.array(
        [[f, i, 2.0 * f, 40.0 * i, 20, 12] for f in range(1, FRAMES + 1) for i in (1, 2)],
        dtype=float,
    )


def test_perfect_tracks_have_perfect_scores(real):
    scores = real.score(scene(lanes(), SIZE), lanes())
    assert [scores[name] for name in ("HOTA", "DetA", "AssA", "IDF1", "MOTA")] == [100] * 5
    assert [scores[name] for name in ("IDSW", "Frag", "FP", "FN")] == [0] * 4


def test_an_exchange_of_identities_half_way_is_scored_as_one(real):
    tracks = lanes()
    late = tracks[:, 0] > FRAMES / 2
    tracks[late, 1] = 3 - tracks[late, 1]
    scores = real.score(scene(lanes(), SIZE), tracks)
    assert scores["IDSW"] == 2
    assert scores["DetA"] == 100
    assert scores["AssA"] == pytest.approx(100 / 3)  # 15 of 15 + 15 + 15 for each pair
    assert scores["IDF1"] == pytest.approx(50)
    assert scores["MOTA"] == pytest.approx(100 * (1 - 2 / 60))


@pytest.mark.parametrize("name", TRAFFIC_BASELINES)
def test_every_baseline_follows_what_is_easy(real, name):
    detections = np.column_stack([lanes()[:, [0, 2, 3, 4, 5]], np.full(2 * FRAMES, 0.9)])
    tracks, seconds = real.track(name, scene(lanes(), SIZE), detections)
    assert seconds > 0
    scores = real.score(scene(lanes(), SIZE), tracks)
    assert scores["IDSW"] == 0
    assert scores["MOTA"] > 85  # some need three frames before they believe


@pytest.mark.parametrize("name", ["bytetrack", "ocsort", "cbiou"])
def test_low_scores_are_lost_on_default_thresholds_only(real, name):
    detections = np.column_stack([lanes()[:, [0, 2, 3, 4, 5]], np.full(2 * FRAMES, 0.4)])
    assert len(real.track(name, scene(lanes(), SIZE), detections)[0]) == 0
    assert len(real.track(f"{name}-low", scene(lanes(), SIZE), detections)[0]) > FRAMES


ECHO = """
import json, sys
print(json.dumps({"trackers": "0", "trackeval": "0"}), flush=True)
for line in sys.stdin:
    print(json.dumps(json.loads(line)), flush=True)
"""
FAILS = 'print("{}", flush=True); input(); print(\'{"error": "ValueError: too much"}\', flush=True)'


def start(monkeypatch, tmp_path, text):
    script = tmp_path / "worker.py"
    script.write_text(text)
    monkeypatch.setattr(client, "WORKER", script)
    return TrafficWorker(PYTHON)


def test_only_what_is_to_be_scored_is_sent(monkeypatch, tmp_path):
    truth = lanes()
    with start(monkeypatch, tmp_path, ECHO) as started:
        sent = started.score(scene(truth, SIZE), np.column_stack([truth, np.ones(len(truth))]))[
            "score"
        ]
    assert sent["frames"] == FRAMES
    assert sent["truth"] == sent["tracks"] == truth.tolist()


def test_a_failure_of_the_libraries_is_told(monkeypatch, tmp_path):
    with (
        start(monkeypatch, tmp_path, FAILS) as started,
        pytest.raises(InputError, match="the traffic baselines cannot go on: ValueError: too much"),
    ):
        started.score(scene(lanes(), SIZE), lanes())


def test_an_environment_without_the_libraries_is_told():
    with pytest.raises(InputError, match=r"PackageNotFoundError.*trackers"):
        TrafficWorker(PYTHON)

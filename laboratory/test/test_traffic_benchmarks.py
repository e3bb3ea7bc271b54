# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Benchmarks of many vehicles: which identity is whose, and the scenes that are timed."""

import numpy as np
import pytest

from benchmarks.traffic_cost import made, place
from laboratory.scenes import make_traffic_scene
from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.traffic.clips import Row, read_truth, report
from laboratory.traffic.occluders import judged
from laboratory.traffic.perturbed import PERTURBATIONS
from laboratory.traffic.spread import Run, summary
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence


@pytest.fixture
def truth(tmp_path):
    folder = tmp_path / "van"
    folder.mkdir()
    rows = [
        f"{n},{10 * n},20,30,15,1,{2 if 4 <= n <= 6 else 1 if n == 3 else 0}" for n in range(1, 11)
    ]
    path = folder / "groundtruth.csv"
    path.write_text("frame,x,y,w,h,visible,occ\n" + "\n".join(rows) + "\n")
    return path


def test_truth_is_placed_in_the_clip_and_hidden_where_it_is_most(truth):
    rows = read_truth(truth, 408)
    assert rows[0] == Row(408, (10, 20, 30, 15), hidden=False)
    assert [row.frame for row in rows if row.hidden] == [411, 412, 413]


@pytest.mark.parametrize(("late", "kept"), [(5, "yes"), (8, "no"), (None, "no")])
def test_an_identity_is_that_of_the_track_under_the_true_box(truth, capsys, late, kept):
    tracks = [np.empty((0, 5)) for _ in range(30)]
    for row in read_truth(truth, 10):
        number = 5 if row.frame < 14 else late
        if number is not None:
            left, *rest = row.box
            tracks[row.frame] = np.array([[number, left + 3, *rest], [99, 300, 20, 30, 15]])
    report(truth, 0, read_truth(truth, 10), tracks)
    after = late or "–"
    assert f"| van | 0 | 13 to 15 | 5 | {after} | {kept} |" in capsys.readouterr().out


def test_vehicles_come_again_on_the_other_side():
    box = Box(0, 10, 30, 15)
    assert place(box, 0.0, 2.0, 100) == Box(155, 10, 30, 15)
    assert place(box, 700.0, 2.0, 60) == Box(45, 10, 30, 15)
    assert place(box, 10.0, -2.0, 10) == Box(675, 10, 30, 15)


def test_the_timed_scene_has_as_many_vehicles_as_said(tmp_path):
    sequence = made(20, tmp_path / "cost", frames=3)
    shown = [np.count_nonzero(sequence.truth[:, 0] == frame) for frame in (1, 2, 3)]
    assert all(18 <= count <= 22 for count in shown)


def test_the_occluder_is_judged_against_the_scene(tmp_path):
    scene = make_traffic_scene("traffic-pair", settings={"frames": 112})
    write_mot_folder(scene, tmp_path / "pair", 0)
    sequence = read_sequence(tmp_path / "pair")
    found = judged(sequence, "good")  # a lorry hides a car in 26 frames
    assert found["right"] > 13
    assert found["wrong"] == 0
    path = tmp_path / "pair" / "gt" / "occluders.csv"
    head, *rows = (line.split(",") for line in path.read_text().splitlines())
    other = [head, *([*row[:3], "99", row[4]] for row in rows)]
    path.write_text("".join(",".join(row) + "\n" for row in other))
    assert judged(sequence, "good")["wrong"] == found["right"]


def test_a_spread_is_a_mean_and_a_standard_deviation():
    runs = [Run(60, 80, 1, float("nan"), 0), Run(62, 84, 1, float("nan"), 4)]
    assert summary(runs) == "61.0 (1.4) | 82.0 (2.8) | 1.0 (0.0) | – | 2.0 (2.8)"


def rows():
    numbers = np.arange(1, 821, dtype=float)
    return np.column_stack([np.repeat(numbers, 5), np.ones((4100, 4)), np.full(4100, 0.6)])


def test_a_fifth_is_dropped_and_always_the_same():
    kept = PERTURBATIONS["dropped"](rows())
    assert len(kept) / 4100 == pytest.approx(0.8, abs=0.02)
    assert (PERTURBATIONS["dropped"](rows()) == kept).all()


@pytest.mark.parametrize(("name", "length"), [("gap20", 20), ("gap40", 40)])
def test_gaps_begin_every_two_hundred_frames(name, length):
    missing = sorted(set(range(1, 821)) - set(PERTURBATIONS[name](rows())[:, 0].astype(int)))
    starts = (100, 300, 500, 700)
    assert missing == [frame for start in starts for frame in range(start, start + length)]


def test_scores_are_squared_or_halved_and_boxes_stay():
    assert (PERTURBATIONS["squared"](rows())[:, 5] == 0.6**2).all()
    halved = PERTURBATIONS["halved"](rows())
    assert (halved[:, 5] == 0.3).all()
    assert (halved[:, :5] == rows()[:, :5]).all()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scores of runs that were counted by hand."""

from collections import namedtuple

import pytest

from laboratory.stress import Reliability, score_estimates
from laboratory.stress.report import write_report
from laboratory.stress.running import Result
from laboratory.stress.summary import difference, groups
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.results.estimates import EstimateRow

STAMP = 10**8
BOX = Box(10.0, 10.0, 30.0, 40.0)
"""Its diagonal is 50 px, so that an error below 25 px is on target."""


def truths(flags):
    return [Truth(i * STAMP, BOX, Occlusion(flag)) for i, flag in enumerate(flags)]


def rows(errors, modes, confidences=None):
    x, y = BOX.centre
    confidences = confidences or [0.9] * len(errors)
    return [
        EstimateRow(
            i + 1, i * STAMP, x + error, y, 30.0, 40.0, mode, confidence, None, None
        )
        for i, (error, mode, confidence) in enumerate(
            zip(errors, modes, confidences, strict=True)
        )
    ]  # fmt: skip


T, O, L = "TRACKING", "OCCLUDED", "LOST"  # noqa: E741


def test_a_short_run_counted_by_hand():
    score = score_estimates(
        truths([0, 0, 1, 1, 2, 2, 0, 0, 0, 0]),
        rows([0, 15, 0, 30, 60, 60, 60, 60, 24, 25], [T, T, O, L, T, O, T, T, T, T]),
    )
    assert (score.frames, score.visible, score.hidden) == (10, 8, 2)
    assert score.on_target == pytest.approx(4 / 8)  # 0, 15, 0 and 24; 25 is not below
    half = (30 - 15) / (30 + 15)
    assert score.mean_iou == pytest.approx((1 + half + 1 + 0 + 0 + 0 + 6 / 54 + 5 / 55) / 8)
    squares = 15**2 + 30**2 + 60**2 + 60**2 + 24**2 + 25**2
    assert score.rmse_visible_px == pytest.approx((squares / 8) ** 0.5)
    assert score.lost is True
    assert score.doubted == pytest.approx(2 / 8)
    assert score.doubted_in_full_view == 0.0
    assert score.claimed_hidden == pytest.approx(1 / 2)
    assert score.longest_false_tracking == 2
    assert (score.recovered, score.judged) == (0, 0)
    assert score.occlusions == ((2, None),)


def test_recoveries_are_judged_by_the_rule_of_the_evaluation():
    flags = [0] * 5 + [2] * 6 + [0] * 40
    good = score_estimates(truths(flags), rows([60] * 24 + [5] * 27, [T] * 51))
    bad = score_estimates(truths(flags), rows([5] * 24 + [60] * 27, [T] * 51))
    assert (good.recovered, good.judged, good.occlusions) == (1, 1, ((6, True),))
    assert (bad.recovered, bad.judged) == (0, 1)
    assert bad.longest_false_tracking == 27


def test_a_fault_leaves_nothing_on_target():
    score = score_estimates(truths([0] * 5), rows([0, 0], [T, T]), fault="it broke")
    assert (score.on_target, score.lost, score.fault) == (0.0, True, "it broke")
    assert score.doubted == pytest.approx(3 / 5)


def test_frames_without_truth_do_not_count():
    known = truths([0] * 4)
    known[2] = None
    score = score_estimates(known, rows([0, 0, 99, 0], [T] * 4), fps=10)
    assert (score.frames, score.on_target) == (3, 1.0)


def test_calibration_by_hand():
    score = score_estimates(
        truths([0, 0, 0, 0, 2]),
        rows([0, 0, 60, 0, 60], [T] * 5, [1.0, 0.85, 0.85, 0.15, 0.4]),
    )
    # The first frame is given. Bin 0.8 to 0.9: two frames, one on target; bin 0.1: one, on target.
    visible = score.reliability_visible
    assert visible.counts == (0, 1, 0, 0, 0, 0, 0, 0, 2, 0)
    assert visible.hits == (0, 1, 0, 0, 0, 0, 0, 0, 1, 0)
    assert visible.calibration_error == pytest.approx((abs(1.7 - 1) + abs(0.15 - 1)) / 3)
    assert visible.diagram()[1] == {"frames": 2, "confidence": 0.85, "on_target": 0.5}
    assert score.reliability_hidden.counts == (0, 0, 0, 0, 1, 0, 0, 0, 0, 0)
    assert Reliability().calibration_error is None


Stub = namedtuple("Stub", "name sequence camera kind labels")
Stub.label = lambda self, name: dict(self.labels).get(name, "")


def result(case, camera, errors, seed=0, system="mine", **labels):
    stub = Stub(case, case, camera, labels.pop("kind", "plain"), tuple(labels.items()))
    return Result(
        stub,
        system,
        seed,
        score_estimates(truths([0] * len(errors)), rows(errors, [T] * len(errors))),
    )


def test_means_are_over_seeds_then_cases_then_cameras(tmp_path):
    results = [
        result("a1", "A", [0, 0]), result("a1", "A", [0, 60], seed=1), result("a2", "A", [0, 0]),
        result("b1", "B", [60, 60]),
    ]  # fmt: skip
    by_name = {(group.by, group.name): group for group in groups(results)}
    everything = by_name["(all)", "(all)"]
    assert everything.cases == 3
    assert everything.summary("on_target").mean == pytest.approx(((0.75 + 1) / 2 + 0) / 2)
    assert everything.summary("on_target").count == 2
    assert by_name["camera", "A"].summary("on_target").mean == pytest.approx(0.875)
    assert by_name["camera", "A"].summary("on_target").count == 2
    write_report(results, tmp_path)
    text = (tmp_path / "stress.md").read_text()
    assert "| A | `mine` | 2 | 0.875 (0.750–1.000) |" in text
    lines = (tmp_path / "stress.csv").read_text().splitlines()
    assert lines[0] == "by,name,system,measure,unit,count,mean,spread,low,high"
    assert any(line.startswith("kind,plain,mine,on_target,,2,0.4375,") for line in lines)


def test_differences_are_paired_by_case_and_seed():
    results = [
        result("a1", "A", [0, 0]), result("a2", "A", [0, 0]), result("b1", "B", [60, 0]),
        result("a1", "A", [0, 60], system="other"),
        result("b1", "B", [60, 60], system="other"),
        result("b1", "B", [0, 0], seed=1, system="other"),
    ]  # fmt: skip
    gain = difference(results, "mine", "other", "on_target")
    assert (gain.count, gain.mean) == (2, 0.5)
    assert difference(results, "mine", "nobody", "on_target") is None


def test_occlusions_are_told_apart_by_path_and_speed():
    results = [
        result(
            "a", "A", [0], kind="lorry", path="turning", course="turning", speed="fast", hidden="5"
        ),
        result("b", "A", [0], kind="pole", path="straight", hidden="0"),
    ]
    names = {(group.by, group.name) for group in groups(results)}
    assert ("occlusion", "fast lorry turning") in names
    assert ("path", "turning") in names
    assert ("course", "turning") in names
    assert ("path", "straight") not in names

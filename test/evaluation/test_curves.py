# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Curves by hand, and against an implementation that shares no code with ours."""

import numpy as np
import pytest
from scoring_samples import PERIOD_NS, scored

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.curves import curves
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames
from vehicle_pf_tracker.results.estimates import EstimateRow


def test_precision_by_hand():
    curve = curves([scored(1, 0), scored(2, 10), scored(3, 10.5), scored(4, 99)])["precision"]
    assert curve.shares[[0, 9, 10, 11, 50]].tolist() == [0.25, 0.25, 0.5, 0.75, 0.75]
    # 0.25 at 51 thresholds, 0.25 more at 41, and at 40.
    assert curve.auc == pytest.approx((51 + 41 + 40) * 0.25 / 51)


def test_success_by_hand():
    # 24 px wide: moved by 12 px a third is shared, and by 24 px nothing.
    curve = curves([scored(1, 0), scored(2, 12), scored(3, 24), scored(4, 0)])["success"]
    assert curve.shares.tolist() == [0.75] * 7 + [0.5] * 13 + [0]
    assert curve.at(0.5) == 0.5


def test_an_overlap_equal_to_the_threshold_does_not_pass():
    assert curves([scored(1, 0)])["success"].auc == pytest.approx(20 / 21)
    assert curves([scored(1, 24)])["success"].auc == 0


def test_normalised_precision_by_hand():
    # 6 px of 24 are 0.25 widths.
    curve = curves([scored(1, 0), scored(2, 6)])["normalised"]
    assert curve.shares[[0, 24, 25, 50]].tolist() == [0.5, 0.5, 1, 1]
    metrics = measure(Scores((scored(1, 0), scored(2, 6))))
    assert metrics.normalised_precision_20 == 0.5
    assert metrics.normalised_precision_auc == pytest.approx((51 + 26) * 0.5 / 51)


def test_no_frames_no_curves():
    assert curves([]) == {}


# Boxes as files of the benchmark have them, (x, y, width, height) by row, and its formulas.


def otb_success(estimated, true):
    """Wu, Lim, Yang 2013, section 4."""
    left_top = np.maximum(estimated[:, :2], true[:, :2])
    right_bottom = np.minimum(estimated[:, :2] + estimated[:, 2:], true[:, :2] + true[:, 2:])
    inside = np.prod(np.clip(right_bottom - left_top, 0, None), axis=1)
    union = estimated[:, 2:].prod(axis=1) + true[:, 2:].prod(axis=1) - inside
    return [np.count_nonzero(inside / union > t) / len(true) for t in np.arange(0, 1.05, 0.05)]


def otb_precision(estimated, true):
    distances = np.linalg.norm(
        estimated[:, :2] + estimated[:, 2:] / 2 - true[:, :2] - true[:, 2:] / 2, axis=1
    )
    return [np.count_nonzero(distances <= t) / len(true) for t in range(51)]


@pytest.fixture(scope="module", params=[1, 2, 3])
def boxes(request):
    rng = np.random.default_rng(request.param)
    true = np.column_stack([rng.uniform(0, 400, (500, 2)), rng.uniform(10, 80, (500, 2))])
    moved = rng.normal(0, 15, (500, 2)) * rng.choice([0.1, 1, 4], (500, 1))
    sized = true[:, 2:] * rng.uniform(0.6, 1.6, (500, 2))
    return np.column_stack([true[:, :2] + moved, sized]), true


def scores_of(estimated, true):
    rows, truths = [], []
    for n, (e, t) in enumerate(zip(estimated.tolist(), true.tolist(), strict=True), start=1):
        (x, y), (width, height) = Box(*e).centre, e[2:]
        rows.append(EstimateRow(n, n * PERIOD_NS, x, y, width, height, "TRACKING", 1, 1, 1))
        truths.append(Truth(n * PERIOD_NS, Box(*t), Occlusion.NONE))
    return score_frames(rows, truths)


def test_agrees_with_otb_on_the_same_boxes(boxes):
    scores = scores_of(*boxes)
    success, precision = otb_success(*boxes), otb_precision(*boxes)
    assert curves(scores.counted)["success"].shares == pytest.approx(success, abs=1e-9)
    assert curves(scores.counted)["precision"].shares == pytest.approx(precision, abs=1e-9)
    metrics = measure(scores)
    assert metrics.success_auc == pytest.approx(np.mean(success), abs=1e-9)
    assert metrics.precision_auc == pytest.approx(np.mean(precision), abs=1e-9)
    assert metrics.precision_20px == pytest.approx(precision[20], abs=1e-9)
    assert 0.2 < metrics.success_auc < 0.8  # so that the comparison says something

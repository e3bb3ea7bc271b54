# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json
import math

import pytest
from scoring_samples import NONE, PARTIAL, PERIOD_NS, TOTAL, row, run_of, scored, truth

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, EstimateRow


def metrics_of(*frames):
    return measure(Scores(frames))


def test_error_is_the_distance_of_the_centres():
    scores = score_frames([row(1, 103.0, 104.0)], [truth(1)])
    assert scores.frames[0].error == 5.0


def test_errors_over_all_and_over_visible_frames():
    metrics = metrics_of(scored(1, 3), scored(2, 4), scored(3, 5, PARTIAL), scored(4, 12, TOTAL))
    assert metrics.rmse_px == pytest.approx(math.sqrt((9 + 16 + 25 + 144) / 4))
    assert metrics.rmse_visible_px == pytest.approx(math.sqrt(50 / 3))
    assert metrics.median_px == 4.5
    assert metrics.max_px == 12


def test_shares_at_their_thresholds():
    errors = (14.9, 15.0, 20.0, 20.1)
    metrics = metrics_of(*(scored(i, e) for i, e in enumerate(errors, start=1)))
    assert metrics.p_error_lt_15px == 0.25  # below
    assert metrics.precision_20px == 0.75  # at most
    assert metrics.on_target == 0.5  # below half the diagonal of 40 px


def test_on_target_leaves_hidden_frames_out_and_follows_the_true_size():
    small = scored(2, 6, sides=(6.0, 8.0))  # half the diagonal is 5 px
    metrics = metrics_of(scored(1, 6), small, scored(3, 0, TOTAL), scored(4, 6, PARTIAL))
    assert metrics.on_target == pytest.approx(2 / 3)


def test_modes_and_claims_of_an_occlusion_by_hand():
    metrics = metrics_of(
        scored(1, 0, mode="OCCLUDED"),
        scored(2, 0, PARTIAL, mode="OCCLUDED"),
        scored(3, 0, TOTAL, mode="OCCLUDED"),
        scored(4, 0, TOTAL, mode="OCCLUDED"),
        scored(5, 0, TOTAL, mode="LOST"),
        scored(6, 0, NONE, mode="LOST"),
        scored(7, 0, NONE, mode="LOST"),
        scored(8, 0, TOTAL),
        scored(9, 0, PARTIAL),
        scored(10, 0),
    )
    assert (metrics.occluded_precision, metrics.occluded_precision_partial) == (0.5, 0.75)
    assert metrics.occluded_recall == 0.5
    assert (metrics.lost_hidden, metrics.lost_visible) == (1, 2)
    assert metrics.visible_tracking == pytest.approx(2 / 6)
    assert metrics.hidden_not_tracking == 0.75
    assert metrics.frames_by_mode == {
        "TRACKING": 3, "OCCLUDED": 4, "LOST": 3, WAITING_MODE: 0, REJECTED_MODE: 0,
    }  # fmt: skip


def test_waiting_frames_and_frames_without_truth_are_counted_and_not_scored():
    rows = [EstimateRow.without(1, PERIOD_NS, WAITING_MODE), row(2, 103.0), row(3, 500.0)]
    metrics = measure(score_frames(rows, [truth(1), truth(2), truth(9)]))
    assert (metrics.frames, metrics.frames_scored) == (3, 1)
    assert (metrics.frames_waiting, metrics.frames_without_truth) == (1, 1)
    assert metrics.truths_unmatched == 1
    assert metrics.rmse_px == metrics.max_px == 3.0
    assert metrics.on_target == metrics.p_error_lt_15px == 1.0


def test_a_frame_without_an_estimate_is_a_miss_but_has_no_error():
    metrics = metrics_of(scored(1, 4), scored(2, None, mode=REJECTED_MODE))
    assert metrics.rmse_px == 4
    assert metrics.p_error_lt_15px == metrics.precision_20px == metrics.on_target == 0.5
    assert metrics.visible_tracking == 0.5
    assert metrics.frames_by_mode[REJECTED_MODE] == 1


def test_an_estimate_that_is_not_finite_is_a_miss():
    metrics = metrics_of(scored(1, 4), scored(2, math.nan), scored(3, math.inf))
    assert metrics.rmse_px == metrics.max_px == 4
    assert metrics.on_target == pytest.approx(1 / 3)


def test_without_truth_there_are_no_errors_but_modes_and_times():
    metrics = measure(score_frames([row(1, 5.0), row(2, 6.0, mode="LOST")], []))
    errors = (
        metrics.rmse_px, metrics.rmse_visible_px, metrics.median_px, metrics.max_px,
        metrics.p_error_lt_15px, metrics.precision_20px, metrics.on_target,
        metrics.hidden_not_tracking, metrics.visible_tracking,
    )  # fmt: skip
    assert set(errors) == {None}
    assert (metrics.frames_without_truth, metrics.recovered) == (2, ())
    assert metrics.frames_by_mode["LOST"] == 1
    assert metrics.step_ms_p50 == 1.0


def test_truth_of_another_time_is_an_error_that_shows_both_times():
    with pytest.raises(InputError, match=r"\(50\.000 to 50\.000 s and 0\.100 to 0\.200 s\)"):
        score_frames([row(1, 0.0), row(2, 0.0)], [truth(500)])


def test_stamps_near_each_other_belong_together_if_the_user_says_so():
    shifted = [row(1, 100.0), row(2, 100.0)]
    with pytest.raises(InputError, match="--max-diff"):
        score_frames(shifted, [truth(3)], max_diff=0.05)
    assert score_frames(shifted, [truth(3)], max_diff=0.1).frames[1].truth == truth(3)


def test_json_has_everything_and_no_number_that_json_does_not_have():
    metrics = measure(run_of((1, 0, NONE), (5, 1, TOTAL), (30, 2, NONE), (5, 1, TOTAL)))
    document = json.loads(json.dumps(metrics.to_json(), allow_nan=False))
    assert document["recovered"] == [True, None]
    assert document["occlusions_not_judged"] == 1
    assert document["occlusions"][0]["first_frame"] == 2
    assert {"rmse_px", "rmse_visible_px", "p_error_lt_15px", "precision_20px", "frames_by_mode",
            "step_ms_p50", "step_ms_p95", "on_target"} <= set(document)  # fmt: skip

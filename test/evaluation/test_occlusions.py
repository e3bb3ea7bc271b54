# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from scoring_samples import NONE, PARTIAL, PERIOD_NS, TOTAL, row, run_of, scored

from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.occlusion_scores import score_occlusions
from vehicle_pf_tracker.evaluation.scores import FrameScore, count_failures
from vehicle_pf_tracker.results.estimates import EstimateRow


def judged(*parts):
    return score_occlusions(run_of(*parts).counted)


def test_one_occlusion_by_hand():
    # Hidden 11 to 20; 15 frames later is frame 35, so that 35 to 44 are judged.
    (score,) = judged((10, 0, NONE), (10, 30, TOTAL), (14, 99, PARTIAL), (10, 7, NONE))
    assert (score.first_frame, score.last_frame, score.hidden_frames) == (11, 20, 10)
    assert score.error_inside_px == 30
    assert (score.judged_frames, score.error_after_px) == (10, 7)
    assert score.threshold_px == 20  # half the diagonal of 24 x 32
    assert score.recovered is True


@pytest.mark.parametrize(("error", "recovered"), [(19.99, True), (20.0, False), (300.0, False)])
def test_recovered_means_below_the_threshold(error, recovered):
    (score,) = judged((5, 0, TOTAL), (14, 0, NONE), (5, error, NONE))
    assert score.recovered is recovered


@pytest.mark.parametrize(("error", "recovered"), [(14.9, True), (15.0, False)])
def test_small_vehicles_are_judged_by_15_px(error, recovered):
    small = (6.0, 8.0)
    frames = [scored(1, 0, TOTAL, sides=small)]
    frames += [scored(n, error, sides=small) for n in range(2, 30)]
    (score,) = score_occlusions(frames)
    assert score.threshold_px == 15
    assert score.recovered is recovered


def test_the_threshold_follows_a_vehicle_that_changes_its_size():
    frames = [scored(1, 0, TOTAL)]
    frames += [scored(n, 18, sides=(24.0, 32.0) if n % 2 else (6.0, 8.0)) for n in range(16, 36)]
    (score,) = score_occlusions(frames)
    assert score.threshold_px == 17.5
    assert score.recovered is False


def test_with_fewer_than_five_frames_nothing_is_said():
    (four,) = judged((5, 0, TOTAL), (14, 0, NONE), (4, 1, NONE))
    assert (four.judged_frames, four.error_after_px, four.recovered) == (4, 1, None)
    (five,) = judged((5, 0, TOTAL), (14, 0, NONE), (5, 1, NONE))
    assert five.recovered is True


def test_an_occlusion_until_the_end_is_not_judged():
    (score,) = judged((5, 0, NONE), (5, 3, TOTAL))
    assert (score.last_frame, score.judged_frames, score.error_after_px) == (10, 0, None)
    assert (score.threshold_px, score.recovered) == (None, None)


def test_the_next_occlusion_ends_what_is_judged():
    first, second = judged((1, 0, TOTAL), (24, 1, NONE), (2, 50, TOTAL), (40, 30, NONE))
    assert (first.judged_frames, first.error_after_px, first.recovered) == (10, 1, True)
    assert (second.first_frame, second.last_frame) == (26, 27)
    assert (second.judged_frames, second.error_after_px, second.recovered) == (26, 30, False)


def test_frames_are_counted_by_number_where_truth_is_missing():
    # Frames 2 to 20 have no truth; 16 is the first that would be judged.
    frames = [scored(1, 0, TOTAL), *(scored(n, 2) for n in range(21, 26))]
    (score,) = score_occlusions(frames)
    assert (score.judged_frames, score.recovered) == (5, True)


def test_frames_without_an_estimate_do_not_judge():
    frames = [scored(1, 0, TOTAL), *(scored(n, 2) for n in range(16, 20))]
    frames += [scored(n, None, mode="REJECTED") for n in range(20, 40)]
    (score,) = score_occlusions(frames)
    assert (score.judged_frames, score.recovered) == (4, None)


def test_exit_and_return_by_hand():
    # Hidden to frame 5, off for 3 frames, from frame 9 on the vehicle (20 px and less).
    (score,) = judged((5, 0, TOTAL), (3, 40, NONE), (30, 2, NONE))
    assert (score.error_at_exit_px, score.frames_to_recover) == (40, 4)


def test_a_pass_over_the_vehicle_is_no_return():
    (score,) = judged((5, 0, TOTAL), (4, 2, NONE), (1, 90, NONE), (4, 2, NONE), (9, 90, NONE))
    assert score.frames_to_recover is None
    (score,) = judged((5, 0, TOTAL), (4, 2, NONE), (1, 90, NONE), (5, 2, NONE), (9, 90, NONE))
    assert score.frames_to_recover == 6


@pytest.mark.parametrize("frames", range(5))
def test_too_few_frames_are_no_return(frames):
    assert judged((5, 0, TOTAL), (frames, 2, NONE))[0].frames_to_recover is None


def test_the_next_occlusion_ends_the_search():
    first, second = judged((1, 0, TOTAL), (4, 2, NONE), (2, 0, TOTAL), (5, 2, NONE))
    assert (first.frames_to_recover, second.frames_to_recover) == (None, 1)


# Boxes are 24 px wide: at 12 px a third of the union is shared, from 24 px on nothing.


def frames_of(*parts):
    return run_of(*parts).frames


@pytest.mark.parametrize(("error", "fails"), [(0, False), (23.9, False), (24.0, True), (99, True)])
def test_a_failure_shares_nothing_with_the_truth(error, fails):
    assert count_failures([scored(1, error)]) == fails


def test_what_nobody_can_see_is_no_failure():
    assert count_failures([scored(1, 99, TOTAL)]) == 0
    assert count_failures([scored(1, 99, PARTIAL)]) == 1
    assert count_failures([FrameScore(row(1, 500.0), None)]) == 0
    waiting = EstimateRow.without(1, PERIOD_NS, "WAITING")
    assert count_failures([FrameScore(waiting, None)]) == 0


def test_failures_are_counted_by_stretches():
    assert count_failures(frames_of((9, 0, NONE))) == 0
    assert count_failures(frames_of((3, 0, NONE), (3, 50, NONE), (2, 0, NONE), (1, 50, NONE))) == 2
    # Lost before an occlusion and still lost behind it: once.
    assert count_failures(frames_of((2, 50, NONE), (5, 50, TOTAL), (2, 50, NONE))) == 1
    assert measure(run_of((3, 0, NONE), (3, 50, NONE))).failures == 1

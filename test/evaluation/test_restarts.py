# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Restarts after failure, by hand: an estimate 100 px off has no overlap with the vehicle."""

import math

import pytest
from scoring_samples import NONE, PARTIAL, PERIOD_NS, TOTAL, row, truth

from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.restarts import measure_restarts, with_restarts
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.results.estimates import EstimateRow

SIZE = (400, 200)
WITHIN_S = 0.01


def rows_of(errors, first=1):
    return [row(first + i, 100.0 + error) for i, error in enumerate(errors)]


def restart(errors, truths, wait, lasting=5):
    """Run with restarts a system that, started, is right for `lasting` frames and then wrong."""
    starts, closed = [], []

    def start(index, box):
        starts.append((index + 1, box))
        try:
            for number in range(index, len(errors)):
                yield row(number + 1, 100.0 + 100.0 * (number - index >= lasting))
        finally:
            closed.append(index + 1)

    found = with_restarts(rows_of(errors), truths, WITHIN_S, wait, SIZE, start)
    assert [one for one, _ in starts] == closed
    return found, [one for one, _ in starts]


def modes(rows):
    return "".join(one.mode[0] for one in rows)


def test_a_failure_is_followed_by_a_start_from_the_truth_so_many_frames_later():
    truths = [truth(number) for number in range(1, 21)]
    found, starts = restart([0] * 3 + [100] * 17, truths, wait=5)
    # Right in frames 1 to 3, wrong in 4; from 9 to 13, wrong in 14; from 19 to the end.
    assert starts == [9, 19]
    assert [one.frame for one in found] == list(range(1, 21))
    assert modes(found) == "TTTTWWWWTTTTTTWWWWTT"
    scores = measure_restarts(score_frames(found, truths))
    assert scores.failures == 2
    assert scores.frames == 12
    assert scores.robustness == pytest.approx(math.exp(-100 * 2 / 12))
    assert scores.accuracy is None  # no start is ten frames old


def test_without_a_failure_it_is_the_run_itself():
    truths = [truth(number) for number in range(1, 16)]
    found, starts = restart([6.0] * 15, truths, wait=1)
    assert found == rows_of([6.0] * 15)
    assert not starts
    scores = measure_restarts(score_frames(found, truths))
    # Boxes of 24 px that are 6 px apart share 18 of 30; the first ten frames are left out.
    assert (scores.accuracy, scores.failures, scores.robustness) == (pytest.approx(0.6), 0, 1.0)


def test_accuracy_leaves_out_ten_frames_of_each_start_and_those_that_fail():
    truths = [truth(number) for number in range(1, 41)]
    found, starts = restart([6.0] * 12 + [100] * 28, truths, wait=1, lasting=99)
    assert starts == [14]
    assert modes(found) == "T" * 40
    scores = measure_restarts(score_frames(found, truths))
    # Two frames of .6 before the failure, and 40 - 13 - 10 = 17 of 1.
    assert scores.accuracy == pytest.approx((2 * 0.6 + 17) / 19)
    assert scores.failures == 1


@pytest.mark.parametrize(
    ("later", "start"),
    [
        ([NONE] * 6, 5),
        ([TOTAL] * 3 + [PARTIAL] * 3, 6),
        ([TOTAL] * 6, None),
        ([None, None, None, None, NONE, NONE], 7),
    ],
)
def test_it_starts_where_the_vehicle_can_be_seen_and_its_box_is_known(later, start):
    of_frames = [NONE, NONE, *later]
    truths = [truth(i, one) for i, one in enumerate(of_frames, start=1) if one is not None]
    found, starts = restart([0, 100] + [100] * 6, truths, wait=3)
    assert starts == ([] if start is None else [start])
    assert len(found) == 8


def test_it_starts_neither_in_a_rejected_image_nor_on_a_box_that_no_tracker_takes():
    truths = [truth(number) for number in range(1, 7)]
    truths[3] = truth(4, centre=(500.0, 100.0))
    rows = rows_of([0, 100, 100, 100, 100, 100])
    rows[2] = EstimateRow.without(3, 3 * PERIOD_NS, "REJECTED")
    starts = []

    def start(index, box):
        starts.append(index + 1)
        yield from rows_of([0] * (6 - index), index + 1)

    with_restarts(rows, truths, WITHIN_S, 1, SIZE, start)
    assert starts == [5]


def test_a_hidden_vehicle_is_no_failure():
    hidden = [NONE, NONE, TOTAL, TOTAL, NONE]
    truths = [truth(number, one) for number, one in enumerate(hidden, start=1)]
    found, starts = restart([0, 0, 100, 100, 0], truths, wait=1)
    assert not starts
    assert measure_restarts(score_frames(found, truths)).frames == 3


def test_the_metrics_without_restarts_have_no_word_of_them():
    truths: list[Truth] = [truth(1)]
    assert "restarts" not in measure(score_frames(rows_of([0]), truths)).to_json()

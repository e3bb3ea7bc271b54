# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scoring_samples import PERIOD_NS, row, truth

from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, EstimateRow


def silent(frame, mode=REJECTED_MODE):
    return EstimateRow.without(frame, frame * PERIOD_NS, mode)


def errors(rows):
    scores = score_frames(rows, [truth(r.frame, centre=(100.0 + r.frame, 100.0)) for r in rows])
    return [frame.error for frame in scores.frames]


def test_normalised_error_is_in_sizes_of_the_true_box():
    # 12 px to the right of a width of 24, 8 px below in a height of 32.
    frame = score_frames([row(1, 112.0, 108.0)], [truth(1)]).frames[0]
    assert frame.normalised_error == pytest.approx(math.hypot(0.5, 0.25))


def test_the_last_estimate_stands_where_there_is_none():
    rows = [row(1, 101.0), silent(2), row(3, math.nan), silent(4, "LOST"), row(5, 105.0)]
    assert errors(rows) == [0, 1, 2, 3, 0]


def test_a_lost_estimate_is_scored_as_it_stands():
    assert errors([row(1, 101.0), row(2, 140.0, mode="LOST")]) == [0, 38]


def test_before_the_first_estimate_nothing_stands():
    assert errors([silent(1), row(2, 102.0)]) == [None, 0]


def test_a_new_wait_forgets_the_estimate_of_the_target_before():
    rows = [row(1, 101.0), silent(2, WAITING_MODE), silent(3), row(4, 104.0)]
    scores = score_frames(rows, [truth(n, centre=(100.0 + n, 100.0)) for n in (1, 3, 4)])
    assert [frame.error for frame in scores.frames] == [0, None, None, 0]


def test_frames_in_which_an_estimate_stands_are_counted_where_they_are_scored():
    rows = [row(1, 101.0), silent(2), silent(3)]
    metrics = measure(score_frames(rows, [truth(1), truth(2)]))
    assert (metrics.frames_standing, metrics.frames_scored) == (1, 2)


@given(st.lists(st.one_of(st.none(), st.floats(0, 500)), min_size=2, max_size=12))
def test_silence_is_scored_as_holding_still(xs):
    xs = [100.0, *xs]
    held, last = [], 100.0
    for x in xs:
        last = last if x is None else x
        held.append(last)
    frames = range(1, len(xs) + 1)
    silences = [silent(n) if x is None else row(n, x) for n, x in zip(frames, xs, strict=True)]
    assert errors(silences) == errors([row(n, x) for n, x in zip(frames, held, strict=True)])

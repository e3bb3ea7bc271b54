# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Decisions of `traffic`, fitted with one camera left out."""

import pytest

from laboratory.traffic.camera_clips import read_clip
from laboratory.traffic.decision_table import best_for_others, mean_and_error, row
from laboratory.traffic.decisions import FITTED_DECISIONS, Decision
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.motion_thresholds import SHIPPED_THRESHOLDS

PIECE = Decision("detection.blobs:_PIECE", (0.5, 0.7), 0.0)
SCORES = {
    0.08: {"day": 60.0, "dusk": 40.0, "close": 50.0},
    0.5: {"day": 90.0, "dusk": 30.0, "close": 45.0},
    0.7: {"day": 50.0, "dusk": 45.0, "close": 52.0},
    0.0: {"day": 99.0, "dusk": 10.0, "close": 10.0},
}


@pytest.mark.parametrize("decision", FITTED_DECISIONS, ids=lambda one: one.place)
def test_every_decision_exists_and_is_as_before_after_a_trial(decision):
    shipped = decision.get()
    with decision.at(decision.values[0]):
        assert decision.get() == decision.values[0] != shipped
    assert decision.get() == shipped


def test_a_field_of_a_frozen_table_is_tried_and_put_back():
    decision = Decision("detection.motion_thresholds:SHIPPED_THRESHOLDS.shadow", (0.9,))
    with pytest.raises(ZeroDivisionError), decision.at(0.9):
        assert SHIPPED_THRESHOLDS.shadow == 0.9
        raise ZeroDivisionError
    assert SHIPPED_THRESHOLDS.shadow == 0.6


def test_a_camera_has_no_vote_on_the_value_that_it_is_judged_with():
    values = [0.08, 0.5, 0.7]
    # Without the day: 45, 37.5 and 48.5; without the dusk: 55, 67.5 and 51.
    assert best_for_others(SCORES, values, "day") == 0.7
    assert best_for_others(SCORES, values, "dusk") == 0.5
    assert best_for_others(SCORES, values, "close") == 0.5


def test_a_row_has_what_is_seen_what_is_left_out_and_what_it_is_worth():
    assert row(PIECE, SCORES) == [
        "detection.blobs:_PIECE",
        "0.08",
        "0.7, 0.5, 0.5",
        f"{(50 + 30 + 45) / 3:.1f}",
        "50.0",
        f"{(99 + 10 + 10) / 3:.1f}",
        # Differences of -39, 30 and 40: a standard deviation of 43.0, over the root of three.
        "+10.3 ± 24.8",
    ]


def test_a_decision_matters_only_where_it_can_act():
    motion = Decision("detection.blobs:_PIECE", (0.5,))
    scores = Decision("trackers.traffic.existence:_SCORE_DOUBT", (0.3,), 0.0, True)
    always = Decision("trackers.traffic.misses:_MISSED", (0.15,))
    for decision, expected in ((motion, (True, False)), (scores, (False, True))):
        assert (decision.matters("motion"), decision.matters("yolox")) == expected
    assert always.matters("motion")
    assert always.matters("yolox")


def test_one_camera_has_no_standard_error():
    assert mean_and_error([-1.25]) == "-1.2"
    assert mean_and_error([1.0, 3.0]) == "+2.0 ± 1.0"


def test_a_clip_without_a_camera_is_refused(tmp_path):
    with pytest.raises(InputError, match="CAMERA=FOLDER"):
        read_clip(str(tmp_path), "motion")

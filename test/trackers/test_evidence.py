# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.evidence import EvidenceJudge
from vehicle_pf_tracker.trackers.parameters import CommonParameters, EvidenceParameters

EVIDENCE = EvidenceParameters(occluded_below=0.6, clear_above=0.8, minimum=0.2, level_rate=0.1)
PARAMETERS = CommonParameters(evidence=EVIDENCE, lost_after=3.0)


def modes(judge, similarities, *, left_image=False):
    return [judge.judge(s, 1.0, PARAMETERS, left_image=left_image) for s in similarities]


def test_the_clear_level_is_a_mean_at_first_and_then_follows():
    judge = EvidenceJudge()
    modes(judge, [1.0, 0.8])
    assert judge.level == pytest.approx(0.9)
    modes(judge, [0.9] * 8)
    assert judge.level == pytest.approx(0.9)
    modes(judge, [0.8])
    assert judge.level == pytest.approx(0.9 - 0.1 * 0.1)


def test_hysteresis_between_leaving_and_returning():
    judge = EvidenceJudge()
    modes(judge, [1.0] * 5)
    # Level 1: still clear at 0.61, occluded at 0.59, not yet back at 0.79, back at 0.81.
    assert modes(judge, [0.61])[0] is Mode.TRACKING
    level = judge.level
    assert modes(judge, [0.59 * level, 0.79 * level]) == [Mode.OCCLUDED] * 2
    assert judge.level == level, "hidden frames do not count for the clear level"
    assert modes(judge, [0.81 * level]) == [Mode.TRACKING]


def test_below_the_minimum_there_is_never_evidence():
    judge = EvidenceJudge()
    assert modes(judge, [0.19]) == [Mode.OCCLUDED]
    assert judge.confidence(0.19) == 0.0


def test_lost_after_the_time_without_evidence_until_it_is_back():
    judge = EvidenceJudge()
    modes(judge, [1.0])
    assert modes(judge, [0.1] * 5) == [Mode.OCCLUDED] * 2 + [Mode.LOST] * 3
    assert modes(judge, [0.9, 0.1]) == [Mode.TRACKING, Mode.OCCLUDED]


def test_leaving_the_image_without_evidence_is_lost_at_once():
    judge = EvidenceJudge()
    modes(judge, [1.0])
    assert modes(judge, [0.9], left_image=True) == [Mode.TRACKING]
    assert modes(judge, [0.1], left_image=True) == [Mode.LOST]
    assert modes(judge, [0.1]) == [Mode.LOST], "and stays so"


def test_confidence_is_the_share_of_the_clear_level():
    judge = EvidenceJudge()
    modes(judge, [0.8])
    assert judge.confidence(0.4) == pytest.approx(0.5)
    assert judge.confidence(0.9) == 1.0


def test_thresholds_have_to_be_in_order():
    with pytest.raises(InputError, match="occluded_below"):
        EvidenceParameters(occluded_below=0.9, clear_above=0.8).validate()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signs of crossings and of tracks that ended, added and taken back."""

from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.sign_tally import SignTally

CAR, BUS = ("line", "in", "car", Sign.SEEN), ("line", "in", "bus", Sign.SEEN)
BROKEN = ("line", "in", "car", Sign.BROKEN)


def at(tally, *more, place="line", direction="in", is_asked=lambda label: True):
    return tally.at(place, direction, is_asked, more)


def test_signs_of_all_classes_that_are_asked_for_add_up():
    tally = SignTally()
    for sign in (
        CAR,
        CAR,
        BUS,
        ("line", "out", "car", Sign.SEEN),
        ("other", "in", "car", Sign.SEEN),
    ):
        tally.add(sign)
    assert at(tally) == {Sign.SEEN: 3}
    assert at(tally, BROKEN, CAR) == {Sign.SEEN: 4, Sign.BROKEN: 1}
    assert at(tally, is_asked="bus".__eq__) == {Sign.SEEN: 1}
    assert at(tally, direction="out") == at(tally, place="other") == {Sign.SEEN: 1}


def test_a_track_that_comes_back_takes_its_signs_back_once():
    tally = SignTally()
    tally.end(7, [BROKEN])
    tally.end(8, [BROKEN, CAR])
    assert at(tally) == {Sign.BROKEN: 2, Sign.SEEN: 1}
    tally.withdraw(8)
    tally.withdraw(8)
    tally.withdraw(9)
    assert at(tally) == {Sign.BROKEN: 1}


def test_a_track_that_does_not_come_back_keeps_its_signs():
    tally = SignTally()
    tally.end(7, [BROKEN])
    tally.keep(7)
    tally.keep(9)
    tally.withdraw(7)
    assert at(tally) == {Sign.BROKEN: 1}


def test_a_clear_tally_has_nothing_to_take_back():
    tally = SignTally()
    tally.add(CAR)
    tally.end(7, [BROKEN])
    tally.clear()
    tally.withdraw(7)
    assert at(tally) == {}
    tally.add(BROKEN)
    assert at(tally) == {Sign.BROKEN: 1}


def test_detections_are_no_blobs_until_it_is_said():
    assert not SignTally().has_blobs

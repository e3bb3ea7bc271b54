# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that detections are a straight drive."""

import math

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.paths import Paths

MEASUREMENT = MeasurementModel((200, 150), 0.05)


def way(*places):
    paths = Paths.unknown(1)
    for time, (x, y) in enumerate(places):
        paths = (paths.older(1.0) if time else paths).added(
            np.array([[x - 5, y - 5, x + 5, y + 5]])
        )
    return paths


def evidence(*places):
    return float(way(*places).evidence()[0])


def test_a_way_is_measured_from_the_first_detection_in_widths():
    here = np.array([[25.0, 2, 45, 12]])
    assert way((5, 7), (9, 7)).lengths(here) == pytest.approx(30 / 20)
    assert way().lengths(here) == 0
    assert way((5, 7), (9, 7)).matches == 2


FIRST = np.array([[40.0, 40, 60, 60]])


@pytest.mark.parametrize(
    ("now", "length"),
    [
        ((55, 40, 75, 60), 15 / 20),  # drives across
        ((40, 30, 60, 50), 10 / 20),  # and away
        ((35, 42, 65, 75), 5 / 30),  # comes near: the sides move as it grows
        ((40, 52, 60, 60), 0),  # is learnt from above, as the digit of a clock
        ((20, 40, 60, 60), 0),  # a hole, from which what left it parts
        ((40, 40, 60, 60), 0),
    ],
)
def test_two_edges_share_a_drive(now, length):
    paths = Paths.unknown(1).added(FIRST)
    shared = paths.shared_lengths(np.array([now], float), MEASUREMENT)
    assert shared == pytest.approx(length)


def test_an_edge_that_the_border_cuts_moves_as_the_opposite_one():
    paths = Paths.unknown(1).added(np.array([[0.0, 40, 12, 60]]))
    coming = np.array([[0.0, 40, 30, 60]])
    assert paths.shared_lengths(coming, MEASUREMENT) == pytest.approx(18 / 30)
    later = coming + np.array([50, 0, 50, 0])
    assert paths.shared_lengths(later, MEASUREMENT) == pytest.approx(68 / 30)
    assert Paths.unknown(1).shared_lengths(coming, MEASUREMENT) == 0


def test_the_drive_explains_a_share_of_the_scatter():
    # Times have a scatter of 5, places of 2.75, both together of 3.5.
    share = 3.5**2 / 5 / 2.75
    assert evidence((0, 7), (1, 7), (2, 7), (2, 7)) == pytest.approx(-2 * math.log(1 - share))


def test_a_longer_drive_tells_more():
    drives = [evidence(*((2 * k, k + k % 2) for k in range(count))) for count in (5, 10, 20)]
    assert 0 < drives[0] < drives[1] < drives[2]


@pytest.mark.parametrize(
    "places", [[], [(3, 4)], [(3, 4)] * 9, [(0, 0)] * 5 + [(9, 0)] * 5, [(0, 0), (9, 0)] * 5]
)
def test_what_stands_leaps_or_flickers_drives_not(places):
    assert evidence(*places) == 0


@pytest.mark.parametrize("before", [15, 200])
def test_what_has_stood_drives_off_as_if_it_had_just_come(before):
    drive = [(2 * step, 0.3 * step) for step in range(12)]
    stood = way(*[(0, 0)] * before, *drive)
    assert stood.evidence() == pytest.approx(way(*drive).evidence(), rel=0.15)
    assert stood.matches == before + 12
    assert not stood.stands


def test_a_stand_that_shakes_by_too_much_to_be_told_is_no_debt():
    # An eighth of its width from the middle, so that each is too far from the one before.
    stand = [(1.25 * (-1) ** step, 0) for step in range(30)]
    drive = [(0.5 * step, 0) for step in range(1, 21)]
    assert not way(*stand).stands
    assert way(*stand).latest_evidence() == 0
    # One in a thousand by the latest 20, though all 50 lie on no line.
    assert evidence(*stand, *drive) == 0
    assert way(*stand, *drive).latest_evidence() > 7


def test_what_creeps_by_a_third_of_its_width_in_a_second_does_not_stand():
    assert not way(*[(0.11 * step, 0) for step in range(100)]).stands
    assert way(*[(0.05 * step, 0) for step in range(100)]).stands

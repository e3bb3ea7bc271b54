# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that detections are a straight drive."""

import math

import pytest

from vehicle_pf_tracker.trackers.traffic.straight_drive import StraightDrive


def evidence(*places):
    drive = StraightDrive()
    for time, (x, y) in enumerate(places):
        drive.add(time, x, y)
    return drive.evidence()


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

# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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

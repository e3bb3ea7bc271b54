# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""End of the tracks of vehicles that leave the image."""

import pytest
from traffic_samples import step_of, track

from vehicle_pf_tracker.trackers.traffic.ending import end
from vehicle_pf_tracker.trackers.traffic.state import Experience, State

# Boxes are 40 px wide, and the image 320.


def ends(left, **facts):
    """Tell whether the track of a vehicle with its left edge there ends."""
    state = State(track(1, left, confirmed=True, **facts), Experience())
    return not len(end(state, step_of()).tracks)


@pytest.mark.parametrize(
    ("left", "undetected", "expected"),
    [
        (315.0, 1.0, False),  # an eighth of it is inside
        (318.0, 1.0, True),  # a twentieth
        (318.0, 0.0, False),
        (321.0, 0.0, True),
    ],
    ids=["partly inside", "hardly inside", "hardly inside, detected", "outside, detected"],
)
def test_a_vehicle_has_left_when_hardly_any_of_it_is_inside_unless_it_is_detected(
    left, undetected, expected
):
    assert ends(left, undetected=undetected) == expected

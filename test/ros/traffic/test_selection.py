# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.node.notices import Notices
from vehicle_pf_tracker.ros.traffic.vehicles import NO_VEHICLE, Selection
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode


def vehicle(identity, x, y, width=20.0, height=10.0, mode=TrackMode.TRACKING):
    return TrackEstimate(
        identity, Box(x, y, width, height), (0.0, 0.0), mode, 1.0, "", 1.0, 1.0, None
    )


VEHICLES = (
    vehicle(3, 0, 0, 100, 60),
    vehicle(5, 40, 20),
    vehicle(8, 200, 100),
    vehicle(9, 300, 100, mode=TrackMode.LOST),
)


@pytest.mark.parametrize(
    ("point", "identity"),
    [
        ((10, 10), 3),
        ((45, 25), 5),  # the smaller one, in front of the larger
        ((205, 105), 8),
        ((195, 97), 8),  # beside it
    ],
)
def test_a_click_chooses_the_vehicle_there(point, identity):
    selection = Selection()
    selection.choose_at(point, VEHICLES)
    assert selection.identity == identity
    assert selection.of(VEHICLES).identity == identity


@pytest.mark.parametrize("point", [(150, 90), (305, 105), (-1e9, 0)])
def test_a_click_beside_all_vehicles_changes_nothing(point):
    selection = Selection()
    selection.choose(8, VEHICLES)
    with pytest.raises(InputError, match="there is no vehicle at"):
        selection.choose_at(point, VEHICLES)
    assert selection.identity == 8


def test_a_number_that_no_vehicle_has_is_refused_with_those_there_are():
    selection = Selection()
    with pytest.raises(InputError, match=r"no vehicle has the number 4; there are 3, 5, 8, 9$"):
        selection.choose(4, VEHICLES)
    with pytest.raises(InputError, match="the number 4; there is none"):
        selection.choose(4, ())
    many = [vehicle(number, 0, 0) for number in range(1, 21)]
    with pytest.raises(InputError, match=r"8, 9, 10, …$"):
        selection.choose(-1, many)
    assert selection.identity == NO_VEHICLE


def test_a_selected_vehicle_that_is_gone_has_no_estimate():
    selection = Selection()
    selection.choose(3, VEHICLES)
    assert selection.of(VEHICLES[1:]) is None
    selection.choose(NO_VEHICLE, ())
    assert selection.of(VEHICLES) is None


def test_a_sentence_of_each_kind_is_written_every_few_seconds():
    said, now = [], [0.0]
    notices = Notices(said.append, lambda: now[0])
    for count in range(100):
        now[0] = 0.06 * count
        notices.say("late", f"late {count}")
        notices.say("missed", f"missed {count}")
    assert said == ["late 0", "missed 0", "late 84", "missed 84"]

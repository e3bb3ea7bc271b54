# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that were in view when another one was hidden: seen, merged, cut and gone."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.known_others import KnownOthers

SPEED = 2.0


def car(time, width=20.0, height=12.0):
    """Its box, centred at 50, 30 in frame 0."""
    middle = np.array([50.0 + SPEED * time, 30.0])
    half = np.array([width, height]) / 2
    return np.stack([middle - half, middle + half])


def expected_at(others, time):
    return bool(others.has(np.array([50.0 + SPEED * time, 30.0]), float(time)))


def watched(frames=10):
    others = KnownOthers.begun(car(0)[np.newaxis], 0.0)
    for time in range(1, frames):
        others = others.seen(car(time)[np.newaxis], float(time))
    return others


def test_it_is_where_it_is_seen():
    others = watched()
    assert expected_at(others, 9)
    assert not others.has(np.array([68.0, 40.0]), 9.0)


@pytest.mark.parametrize(
    "boxes",
    [
        lambda time: np.empty((0, 2, 2)),
        lambda time: car(time - 6, 32.0)[np.newaxis],
        lambda time: car(time, 8.0)[np.newaxis],
    ],
    ids=["lost", "merged", "cut"],
)
def test_where_its_outline_is_not_its_own_it_is_expected_at_its_velocity_for_a_second(boxes):
    others = watched()
    for time in range(10, 45):
        others = others.seen(boxes(time), float(time))
        assert expected_at(others, time) is (time < 9 + 30)


def test_without_others_no_position_is_theirs():
    assert not KnownOthers().has(np.zeros((3, 2)), 5.0).any()

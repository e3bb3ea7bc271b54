# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that hide one another: who is nearer, and what is left in sight."""

import numpy as np
from seen_roads import road
from traffic_samples import step_of, together, track

from vehicle_pf_tracker.trackers.traffic.occlusion import find_occlusions, nearest_first
from vehicle_pf_tracker.trackers.traffic.state import Experience, State


def standing(number, left, bottom):
    return track(number, left, bottom - 30.0)


def test_the_order_in_depth_is_that_on_the_road():
    lower, higher = standing(1, 500.0, 302.0), standing(2, 100.0, 300.0)
    both = together(higher, lower)
    assert nearest_first(both, None).tolist() == [1, 0]
    assert nearest_first(both, road()).tolist() == [1, 0]
    # The left of the image shows what is nearer, where the camera is rolled.
    (left, right) = (road(roll=-0.1).to_road(np.array(feet)) for feet in ((120, 300), (520, 302)))
    assert left[1] < right[1]
    assert nearest_first(both, road(roll=-0.1)).tolist() == [0, 1]


def test_a_nearer_vehicle_hides_the_share_that_its_box_covers():
    # Of 40 x 30 px, 30 x 10 px are below the upper edge of the nearer box.
    far, near = track(1, 100.0, 100.0), track(2, 110.0, 120.0, confirmed=True)
    tracks = find_occlusions(State(together(far, near), Experience()), step_of()).tracks
    assert tracks.names.serial.tolist() == [2, 1]
    assert tracks.visibility.uncovered.tolist() == [1, 0.75]
    assert tracks.visibility.hidden_by.tolist() == [0, 0]  # by a quarter: no good part
    assert tracks.visibility.covers[1].tolist() == [[110, 120, 150, 150]]


def test_what_is_mostly_covered_is_hidden_by_that_vehicle():
    far, near = track(1, 100.0, 100.0), track(2, 100.0, 110.0, confirmed=True)
    tracks = find_occlusions(State(together(far, near), Experience()), step_of()).tracks
    assert tracks.visibility.hidden_by.tolist() == [0, 2]


def test_what_is_not_known_to_be_a_vehicle_or_was_long_unseen_hides_nothing():
    far = track(1, 100.0, 100.0)
    for near in (track(2, 100.0, 110.0), track(2, 100.0, 110.0, confirmed=True, unseen=4.0)):
        tracks = find_occlusions(State(together(far, near), Experience()), step_of()).tracks
        assert tracks.visibility.uncovered.tolist() == [1, 1]

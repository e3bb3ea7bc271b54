# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes of parts of a vehicle, and of several vehicles."""

from dataclasses import replace

import numpy as np
import pytest
from measured_vehicle import BOX, Vehicle, exactly
from traffic_samples import together, track_of

from vehicle_pf_tracker.trackers.traffic.parts import grow_to_enclosing, inside_of, shrink_joined

WHOLE = np.array([[90.0, 96, 150, 134]])


@pytest.mark.parametrize(
    ("other", "is_several"),
    [
        ((118.0, 98, 142, 114), True),  # farther, where the detection lacks a part
        ((118.0, 112, 142, 136), False),  # nearer: it hides the part
        ((101.0, 115, 117, 129), False),  # inside: a part of the same vehicle
    ],
)
def test_a_box_that_was_several_vehicles_becomes_the_nearest_one(other, is_several):
    drives, own = Vehicle().tracks.drives, np.array([[100.0, 114, 118, 130]])
    every = np.vstack([own, other])
    for _ in range(4):
        assert (drives.gaussians.edges[0] == BOX).all()  # fewer may be wrong
        drives = shrink_joined(drives, own, every)
    assert (drives.gaussians.edges == pytest.approx(own)) is is_several


def test_a_part_without_another_detection_is_not_taken_for_several():
    drives, own = Vehicle().tracks.drives, np.array([[100.0, 114, 118, 130]])
    for _ in range(20):
        drives = shrink_joined(drives, own, own)
    assert (drives.gaussians.edges[0] == BOX).all()


def test_a_bonnet_is_inside_its_vehicle_and_a_second_larger_box_is_by_either():
    bonnet, beside, around = (100, 110, 130, 130), (125, 100, 165, 130), (94, 96, 148, 136)
    boxes = np.array([bonnet, beside, around], float)
    assert inside_of(BOX[None], boxes).tolist() == [True, False, False]
    assert inside_of(BOX[None], boxes, either=True).tolist() == [True, False, True]


def missed(left=100.0, *, matches=6):
    """A confirmed vehicle that no detection was given to."""
    box = BOX + np.array([left - 100, 0, left - 100, 0])
    return track_of(exactly(box), confirmed=True, matches=matches, undetected=1.0)


def test_boxes_around_a_vehicle_do_not_count_for_one_that_is_several():
    _, tracks = looks(missed(), 3)
    own = np.array([[100.0, 114, 118, 130]])
    every = np.vstack([own, [118.0, 98, 142, 114]])
    assert shrink_joined(tracks.drives, own, every).gaussians.edges[0] == pytest.approx(BOX)


def test_detections_beside_its_own_do_not_count_for_one_that_was_a_part():
    tracks = missed()
    own = np.array([[100.0, 114, 118, 130]])
    every = np.vstack([own, [118.0, 98, 142, 114]])
    drives = tracks.drives
    for _ in range(3):
        drives = shrink_joined(drives, own, every)
    found, _ = looks(replace(tracks, drives=drives), 1)
    assert found == [[]]


def test_two_boxes_around_a_vehicle_in_one_image_are_one_look():
    tracks = missed()
    for expected in ([], [], [], [0]):
        tracks, rows = grow_to_enclosing(tracks, np.vstack([WHOLE, WHOLE + 1]))
        assert rows.tolist() == expected
    assert tracks.edges == pytest.approx(WHOLE)


def looks(tracks, count):
    """Rows that have outgrown by each of so many looks, and the tracks then."""
    found = []
    for _ in range(count):
        tracks, rows = grow_to_enclosing(tracks, WHOLE)
        found.append(rows.tolist())
    return found, tracks


def test_boxes_of_the_whole_vehicle_replace_a_part_that_was_seen_first():
    found, tracks = looks(missed(), 4)
    assert found == [[], [], [], [0]]
    assert tracks.edges == pytest.approx(WHOLE)


def test_two_vehicles_in_one_box_stay_two():
    found, _ = looks(together(missed(), missed(125.0)), 20)
    assert not any(found)


def test_a_vehicle_that_was_often_seen_alone_does_not_soon_become_a_box_of_two():
    found, _ = looks(missed(matches=40), 15)
    assert not any(found)

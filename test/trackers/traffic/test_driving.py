# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drives that tell vehicles from the scene."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import step_of, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.driving import have_driven
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (320, 240)
STEP = step_of(SIZE)


def reported_from(*, are_shapes, rate=30.0, shake=0.0, beside=()):
    """Number of images in which a drive of a tenth of its width per image is not reported.

    Another box drives with it, of the offset and size `beside`.
    """
    tracker = MultiVehicleTracker()
    tracker.frame_period = 1 / rate
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for index in range(30):
        left = 20 + 4 * index + shake * (-1) ** index
        boxes = [(left, 100, 40, 30)]
        if beside:
            boxes.append((left + beside[0], 100, *beside[1:]))
        detections = replace(Detections.make(boxes), are_shapes=are_shapes)
        estimates = tracker.step(frame, detections)
        if any(one.identity and one.box.width > 30 for one in estimates):
            return index
    return 30


@pytest.mark.parametrize("rate", [30.0, 10.0])
def test_a_shape_is_a_vehicle_by_its_way_and_not_by_time(rate):
    assert reported_from(are_shapes=True, rate=rate) == 5


@pytest.mark.parametrize(
    ("are_shapes", "beside", "images"),
    [
        (True, (50, 40, 30), 15),  # half a second
        (True, (65, 40, 30), 5),  # out of reach
        (True, (50, 14, 14), 5),  # a speck
        (False, (50, 40, 30), 5),
    ],
)
def test_a_shape_with_another_one_beside_it_may_be_a_piece_for_half_a_second(
    are_shapes, beside, images
):
    assert reported_from(are_shapes=are_shapes, beside=beside) == images


@pytest.mark.parametrize("edge", range(4))
def test_a_shape_of_which_one_edge_moves_is_no_vehicle(edge):
    tracker = MultiVehicleTracker()
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    numbers = set()
    for index in range(140):
        # Vehicles as full as it teach that such shapes are vehicles.
        boxes = [(20 + 4 * (index % 35), 140, 40, 30)]
        edges = np.array([80.0, 60, 120, 100])
        if index >= 70:  # half of it is learnt by and by, as a clock's digit
            edges[edge] += (1 if edge < 2 else -1) * 2 * ((index - 70) // 7)
            boxes.append((*edges[:2], *(edges[2:] - edges[:2])))
        detections = replace(Detections.make(boxes, [0.9] * len(boxes)), are_shapes=True)
        estimates = tracker.step(frame, detections)
        numbers |= {one.identity for one in estimates if one.box.y < 110}
    assert numbers == {0}


def test_a_shape_that_shakes_as_it_drives_has_to_drive_farther():
    steady, shaking, boxed = (
        reported_from(are_shapes=True),
        reported_from(are_shapes=True, shake=4.0),
        reported_from(are_shapes=False, shake=4.0),
    )
    assert steady < boxed < shaking < 15


@pytest.mark.parametrize(("rate", "images"), [(30.0, 10), (24.0, 10), (3.0, 6)])
def test_a_shape_that_shakes_is_asked_for_a_straighter_way_where_images_are_dense(rate, images):
    # Leaves swing straight in dense images, and are elsewhere in each of rare ones.
    assert reported_from(are_shapes=True, rate=rate, shake=4.0) == images


@pytest.mark.parametrize(
    ("way", "against", "is_told"),
    [(0.8, 0.0, True), (0.8, 5.0, False), (1.2, 5.0, True)],
)
def test_scores_are_ignored_only_of_what_drove_its_own_width(way, against, is_told):
    one = track(1, 100.0, doubt=against)
    paths = one.beliefs.paths
    for share in np.linspace(0, way, 60):
        edges = np.array([[100 + 40 * share, 100, 140 + 40 * share, 130]])
        paths = paths.older(1.0).added(edges)
    assert paths.evidence()[0] > 50
    gaussians = one.drives.gaussians.resized(edges)
    one = replace(one, drives=replace(one.drives, gaussians=gaussians))
    one = replace(one, beliefs=replace(one.beliefs, paths=paths))
    assert have_driven(one, STEP)[0] == is_told

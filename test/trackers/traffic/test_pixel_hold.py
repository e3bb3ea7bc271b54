# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurement of vehicles by the flow of their pixels."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from traffic_samples import changed, step_of, together, track

from vehicle_pf_tracker.trackers.traffic.pixel_hold import measure
from vehicle_pf_tracker.trackers.traffic.rows import objects

SHIFT = np.array([3.0, 1.0, 3.0, 1.0])
NOISE = np.random.default_rng(3).integers(0, 256, (240, 320)).astype(np.uint8)
BEFORE = cv2.GaussianBlur(NOISE, (0, 0), 2.0)
STEP = replace(
    step_of(),
    grey=np.roll(BEFORE, (1, 3), (0, 1)),
    normals=np.random.default_rng(4).standard_normal((50, 3)),
)


def held(left, cover=None):
    """A vehicle predicted a pixel from where its pixels went; something may cover a part of it."""
    one = changed(track(1, left), usual_similarity=0.0)
    one = changed(one, before=one.edges - SHIFT + (1, 0, 1, 0))
    covers = [np.array([cover] if cover else []).reshape(-1, 4)]
    return replace(one, visibility=replace(one.visibility, covers=objects(covers)))


def test_a_vehicle_is_where_its_pixels_went():
    vehicle = held(100)
    kept, edges, spreads = measure(vehicle, BEFORE, STEP)
    assert kept.tolist() == [0]
    assert edges[0] == pytest.approx(vehicle.drives.before[0] + SHIFT, abs=0.7)
    assert (spreads > 0.3).all()


def test_vehicles_are_measured_together_as_each_alone():
    # With all points, with the left half covered, with all covered; and more than fit at once.
    cover = (150, 90, 172, 140)
    each = [held(60), held(152, cover), held(152, (100, 50, 250, 200)), held(220), *[held(60)] * 40]
    kept, edges, spreads = measure(together(*each), BEFORE, STEP)
    assert kept.tolist() == [0, 1, *range(3, 44)]
    for row, index in enumerate(kept.tolist()):
        _, alone, spread = measure(each[index], BEFORE, STEP)
        assert np.array_equal(edges[row], alone[0])
        assert np.array_equal(spreads[row], spread[0])


def test_after_a_change_of_size_nothing_is_measured():
    assert len(measure(held(100), BEFORE[:100], STEP)[0]) == 0

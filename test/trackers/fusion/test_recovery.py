# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A red van of 40 x 24 px before a camera that pans; it is lost as it shows another side."""

import numpy as np
import pytest
from fusion_samples import fusion, texture

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.estimate import Mode

LOST, BACK = 30, 55
"""Frames in which it drives under something, and comes out elsewhere with another side in view."""
FRAMES = 130
ROAD = (texture(7, 700, 300, gain=2.0) // 2 + 60).astype(np.uint8)
NOISE = np.random.default_rng(3)
SIDES = [
    np.where(NOISE.random((3, 5, 1)) < 0.25, [70, 10, 10], [190, 20, 20]).astype(np.uint8)
    for _ in range(2)
]


def place(number):
    """Upper left corner of the van on the road."""
    return 40 + 4 * number, 60 if number < BACK else 200


def picture(number, paint):
    shown = ROAD.copy()
    x, y = place(number)
    side = SIDES[0] if number < LOST else SIDES[1][..., list(paint)]
    if not LOST <= number < BACK:
        shown[y : y + 24, x : x + 40] = side.repeat(8, axis=0).repeat(8, axis=1)
    left = 20 + 2 * number
    return shown[:, left : left + 400], Box(x - left, y, 40, 24)


def tracked(paint):
    """Estimates and true boxes; `paint` orders the colours of the side that is in view later."""
    tracker = fusion()
    for number in range(FRAMES):
        frame, box = picture(number, paint)
        yield (tracker.step(frame) if number else tracker.start(frame, box)), box


@pytest.mark.parametrize(("paint", "is_found"), [((0, 1, 2), True), ((2, 1, 0), False)])
def test_the_one_thing_that_moves_in_its_paint_is_the_vehicle(paint, is_found):
    """A blue van is another one: the red one stays lost."""
    estimates = list(tracked(paint))
    for estimate, box in estimates[1:LOST]:
        assert estimate.mode is Mode.TRACKING
        assert abs(estimate.box.x - box.x) < 10
    lost = estimates[LOST + 10 : LOST + 60]
    assert all(estimate.mode is not Mode.TRACKING for estimate, _ in lost)
    for estimate, box in estimates[-20:]:
        is_on_it = abs(estimate.box.x - box.x) < 10 and abs(estimate.box.y - box.y) < 10
        assert is_on_it == is_found
        assert (estimate.mode is Mode.TRACKING) == is_found

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The artificial video: geometry by hand, and pixels against truth."""

import numpy as np
import pytest

from vehicle_pf_tracker.scenes.catalogue import make_scene


def test_positions_are_exact():
    boxes = [truth.box for truth in make_scene("bar", settings=["speed=3.7"]).truths()]
    centres = np.array([box.centre for box in boxes])
    np.testing.assert_allclose(centres[:, 0], 40 + 3.7 * np.arange(len(boxes)), atol=1e-9)
    np.testing.assert_allclose(centres[:, 1], 240, atol=1e-12)
    assert {(round(box.width, 9), round(box.height, 9)) for box in boxes} == {(40, 30)}
    assert boxes[-1].x + 40 <= 620 < boxes[-1].x + 40 + 3.7


def test_pixels_move_as_the_truth_says():
    """Centre of mass of what differs from the empty road, against the frame before's."""
    scene = make_scene("bar", settings=["width=0", "noise=0", "speed=4.3"])
    empty = scene.backdrop()
    rows, columns = np.indices(empty.shape[:2]) + 0.5
    offsets = []
    for shot in scene.frames(range(0, 40, 4)):
        light = np.abs(shot.frame - empty).sum(axis=2)
        light[light < 6] = 0
        mass = np.array([(light * columns).sum(), (light * rows).sum()]) / light.sum()
        offsets.append(mass - shot.truth.box.centre)
    np.testing.assert_allclose(offsets, np.broadcast_to(offsets[0], (10, 2)), atol=0.1)
    assert np.abs(offsets).max() < 2.5


def test_visible_fraction_matches_the_pixels():
    """The share of the vehicle's changed pixels that survives the bar, away from its own edges."""
    free = make_scene("bar", settings=["width=0", "noise=0"])
    barred = make_scene("bar", settings=["width=60", "noise=0"])
    empty = free.backdrop()
    passing = range(46, 68)
    for open_road, behind in zip(free.frames(passing), barred.frames(passing), strict=True):
        vehicle = np.abs(open_road.frame - empty).max(axis=2) > 6
        same = (open_road.frame == behind.frame).all(axis=2)
        share = (vehicle & same).sum() / vehicle.sum()
        assert behind.truth.visible_fraction == pytest.approx(share, abs=0.02)

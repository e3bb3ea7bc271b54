# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sides of a drawn vehicle of 40 x 20 px, whose mask reaches half a pixel too far."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.foreground import Around
from vehicle_pf_tracker.trackers.fusion.sides import Sides

POSITION, SIZE = np.array([50.0, 40.0]), np.array([40.0, 20.0])


def around(left=0):
    """What moves around the box: the vehicle, whose left side is so many px beyond it."""
    mask = np.zeros((80, 100), np.uint8)
    mask[30:50, 30 - left : 70] = 1
    return Around(mask, np.zeros(2), 1.0)


def looked(sides, left, seconds):
    """Look at it eight times a second."""
    for _ in range(int(8 * seconds)):
        sides = sides.looked(around(left), POSITION, SIZE).passed(0.125)
    return sides


def test_one_look_counts_by_its_variances():
    """A second of drift has .002, the bias .0025, the edge .04; the error is 8 - .5 px of 40."""
    sides = Sides().passed(0.6).looked(around(8), POSITION, SIZE).passed(0.4)
    assert sides.beyond[0, 0] == pytest.approx(0.1875 * 0.002 / 0.0445)
    assert sides.bias[0, 0] == pytest.approx(0.1875 * 0.0025 / 0.0445)
    assert sides.variances[1][0, 0] == pytest.approx(-0.002 * 0.0025 / 0.0445)


def test_what_was_beyond_from_the_first_is_a_bias():
    """A shadow, or a loose first box; a side that moves away later is one of the vehicle."""
    shadow = looked(Sides(), 8, 4.0)
    assert shadow.bias[0, 0] > 0.05
    side = looked(looked(Sides(), 0, 2.0), 8, 4.0)
    assert side.beyond[0, 0] > 2 * side.bias[0, 0]
    # Most of the .2 that it has moved by.
    assert 0.1 < side.beyond[0, 0] < 0.2
    # The other sides are where they were, but for half a pixel.
    assert np.abs(side.beyond.ravel()[1:]).max() < 0.02


def test_an_edge_that_is_not_seen_changes_nothing():
    mask = around().mask.copy()
    mask[:, :30] = 1  # a neighbour at the left side
    sides = Sides().looked(Around(mask, np.zeros(2), 1.0), POSITION, SIZE).passed(1.0)
    assert sides.beyond[0, 0] == sides.bias[0, 0] == 0
    assert sides.beyond[1, 0] < 0
    assert sides.looked(None, POSITION, SIZE) is sides


def test_a_doubt_discards_the_looks_just_before():
    cut = Sides().looked(around(-8), POSITION, SIZE).passed(0.2)
    assert cut.beyond[0, 0] == 0
    assert cut.doubted().passed(1.0).beyond[0, 0] == 0
    assert cut.passed(1.0).beyond[0, 0] < 0


def test_the_box_has_its_own_distance_at_each_side():
    beyond = np.array([[0.1, 0.0], [-0.05, 0.2]])
    centre, size = Sides(beyond).box(POSITION, SIZE)
    # From 30 - 4 to 70 - 2, and from 30 to 50 + 4.
    assert centre == pytest.approx([47, 42])
    assert size == pytest.approx([42, 24])

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of vehicles: counted in the inner part of a box, and learnt by a quarter."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.overlaps import NO_BOXES
from vehicle_pf_tracker.image.windows.box_colours import COLOUR_BINS
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins, similarities
from vehicle_pf_tracker.trackers.traffic.recognition import coloured
from vehicle_pf_tracker.trackers.traffic.tracks import Appearance

BOX = np.array([[10.0, 10.0, 50.0, 50.0]])


def frame(left=(200, 30, 30), right=(30, 30, 200)):
    """An image of 60 x 60 px whose halves meet at x = 30, in the middle of the box."""
    image = np.zeros((60, 60, 3), np.uint8)
    image[:, :30] = left
    image[:, 30:] = right
    return image


def histogram(image, covers=NO_BOXES):
    (colours,) = ColourBins(image).histograms(BOX, [covers])
    return colours


def test_shares_of_the_colours_are_those_of_the_inner_box():
    # A tenth is left out on each side: columns 14 to 46, of which 16 are left of the middle.
    shares = np.sort(histogram(frame()))[::-1]
    assert shares[:3] == pytest.approx([17 / 33, 16 / 33, 0])


def test_pixels_below_a_nearer_box_do_not_count():
    only_left = histogram(frame(), np.array([[30.0, 0.0, 60.0, 60.0]]))
    assert only_left.max() == 1
    assert not histogram(frame(), np.array([[0.0, 0.0, 60.0, 60.0]])).any()


def test_similarity_is_one_of_the_same_colours_and_none_of_others():
    both, red = histogram(frame()), histogram(frame(right=(200, 30, 30)))
    blue = histogram(frame(left=(30, 30, 200)))
    assert similarities(both, both) == pytest.approx(1)
    assert similarities(red, blue) == 0
    assert similarities(both, red) == pytest.approx(np.sqrt(16 / 33))


def test_first_colours_count_in_full_and_later_ones_by_a_quarter():
    red, blue = np.eye(COLOUR_BINS)[:2]
    before = Appearance.unknown(2)
    first = coloured(before, red[np.newaxis], np.array([1]))
    assert not first.colours[0].any()
    assert (first.colours[1] == red).all()
    later = coloured(first, blue[np.newaxis], np.array([1]))
    assert later.colours[1] == pytest.approx(0.75 * red + 0.25 * blue)
    assert not before.colours.any()

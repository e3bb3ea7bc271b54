# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colour and lines: both have to fit, and a target without lines loses nothing."""

import numpy as np
import pytest
from street import SIZE, Street, follow

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.papers.pf import PfParameters, PfTracker
from vehicle_pf_tracker.trackers.papers.pfcl import PfclParameters, PfclTracker


def make(**values):
    return PfclTracker(from_mapping(PfclParameters, values))


def striped(*, across):
    """A box of black and white stripes, whose colours are the same whichever way they run."""
    patch = np.zeros((24, 24), np.uint8)
    patch[np.arange(24) // 6 % 2 == 0] = 255
    return np.repeat((patch if across else patch.T)[..., np.newaxis], 3, axis=2)


def two_boxes(left, right):
    frame = np.full((80, 160, 3), 128, np.uint8)
    frame[30:54, 30:54], frame[30:54, 100:124] = left, right
    return frame


def test_lines_tell_apart_what_colours_do_not():
    first = two_boxes(striped(across=True), striped(across=False))
    tracker = make(num_particles=2)
    tracker.start(first, Box(30, 30, 24, 24))
    centres = np.array([[42.0, 42.0], [112.0, 42.0]])
    colour = tracker.similarity(first, centres)
    lines = tracker.line_similarity(first, centres)
    assert colour[0] == pytest.approx(colour[1], abs=0.02)
    assert lines[0] > 0.95
    assert lines[1] < 0.8  # the outline is the same


def test_a_target_without_lines_is_tracked_by_colour_as_pf_does():
    smooth = np.full((80, 160, 3), 100, np.uint8)
    smooth[30:54, 30:54] = 104  # another bin, and no edge for Canny
    pfcl, pf = make(seed=3), PfTracker(from_mapping(PfParameters, {"seed": 3}))
    for tracker in (pfcl, pf):
        tracker.start(smooth, Box(30, 30, 24, 24))
    for _ in range(4):
        assert np.array_equal(pfcl.step(smooth).particles, pf.step(smooth).particles)


def test_the_window_relearns_the_lines_of_the_first_frame():
    street = Street(speed=0.0, hidden=(5, 99))
    tracker = make()
    follow(tracker, street, range(8))
    learned = tracker.line_reference
    smaller = {"window.width": SIZE[0] - 8.0, "lines.bins": 4}
    tracker.reconfigure(from_mapping(PfclParameters, smaller))
    assert learned.any()
    assert tracker.line_reference.any()
    assert len(tracker.line_reference) == 4


def test_weights_are_the_product_of_both_likelihoods():
    tracker = make(num_particles=50)
    estimate = follow(tracker, Street(), range(2))[-1]
    frame = Street().frame(1)
    colour = tracker.similarity(frame, estimate.particles)
    lines = tracker.line_similarity(frame, estimate.particles)
    expected = np.exp(-(1 - colour) / (2 * 0.158**2) - (1 - lines) / (2 * 0.35**2))
    assert estimate.weights == pytest.approx(expected / expected.sum())


def test_a_window_without_lines_is_unlike_a_target_with_lines():
    first = two_boxes(striped(across=True), np.full((24, 24, 3), 128, np.uint8))
    tracker = make(num_particles=2)
    tracker.start(first, Box(30, 30, 24, 24))
    assert tracker.line_similarity(first, np.array([[112.0, 42.0]])) == pytest.approx([0.0])

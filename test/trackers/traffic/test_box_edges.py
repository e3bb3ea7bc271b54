# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of boxes as measurements: their noise, and which the border of the image cuts."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel, opposites

MODEL = MeasurementModel((320, 240), 0.05)


def test_the_noise_of_an_edge_grows_with_the_side_across_it_and_is_never_below_that_of_pixels():
    assert MODEL.deviations(np.array([100.0, 100, 140, 130])) == pytest.approx(
        np.hypot([2, 1.5, 2, 1.5], 0.7)
    )
    assert MODEL.deviations(np.array([5.0, 5, 5, 5])) == pytest.approx([0.7] * 4)


@pytest.mark.parametrize(
    ("box", "cut"),
    [
        ((100, 100, 140, 130), [False, False, False, False]),
        ((-5, 100, 35, 130), [True, False, False, False]),
        ((2.1, 100, 42.1, 130), [True, False, False, False]),  # within 2.12 px of the border
        ((2.2, 100, 42.2, 130), [False, False, False, False]),
        ((280, 210, 320, 240), [False, False, True, True]),
        ((100, 1.6, 140, 31.6), [False, True, False, False]),  # within 1.66 px
    ],
)
def test_an_edge_nearer_to_the_border_than_its_noise_may_be_cut(box, cut):
    assert MODEL.cut_edges(np.array(box, float)).tolist() == cut


def test_opposite_edges_are_those_of_the_same_axis():
    assert opposites(np.array([[1.0, 2, 3, 4]])).tolist() == [[3, 4, 1, 2]]

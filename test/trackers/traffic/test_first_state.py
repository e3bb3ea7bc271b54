# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""First states of vehicles, which borders of the image may cut."""

import numpy as np
import pytest
from measured_vehicle import BOX, SIZE, STILL

from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.edge_observation import Edge
from vehicle_pf_tracker.trackers.traffic.first_state import first_gaussians

MEASUREMENT = MeasurementModel(SIZE, 0.05)


def first(*edges):
    return first_gaussians(np.array([edges], float), MEASUREMENT, np.array([-40.0]), STILL)


@pytest.mark.parametrize(
    ("edges", "whole"),
    [
        ((100, 0, 140, 8), (100, 8 - 32, 140, 8)),
        ((100, 232, 140, 240), (100, 232, 140, 232 + 32)),
        ((0, 100, 10, 132), (10 - 40, 100, 10, 132)),
        ((310, 100, 320, 132), (310, 100, 310 + 40, 132)),
        ((100, 100, 140, 132), (100, 100, 140, 132)),
    ],
)
def test_a_vehicle_cut_at_a_border_gets_the_usual_shape(edges, whole):
    assert first(*edges).edges[0] == pytest.approx(whole)


def test_a_thin_first_box_may_grow():
    thin, whole = (
        gaussians.edge_variances[0] for gaussians in (first(100, 100, 140, 110), first(*BOX))
    )
    assert thin[Edge.TOP] > 10 * whole[Edge.TOP]


def test_vehicles_begin_together_as_each_alone_would():
    boxes = np.array([(100.0, 0, 140, 8), BOX, (310, 100, 320, 132)])
    every = first_gaussians(boxes, MEASUREMENT, np.full(3, -40.0), STILL)
    for row, box in enumerate(boxes):
        assert (every.mean[row] == first(*box).mean[0]).all()
        assert (every.covariance[row] == first(*box).covariance[0]).all()

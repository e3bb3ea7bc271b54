# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of a box as linear functions of a vehicle's state, against hand numbers."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.edge_observation import (
    OBSERVATION,
    Edge,
    edge_of,
    edge_rows,
)

EDGES = {Edge.LEFT: 80.0, Edge.TOP: 20.0, Edge.RIGHT: 120.0, Edge.BOTTOM: 50.0}
"""Of a box 40 px wide and 30 px high, centred at 100, whose lower edge is at 50."""
STATE = np.array([[100.0, 50.0, 40.0, 30.0, 7.0, 9.0]])


@pytest.mark.parametrize("edge", Edge)
def test_an_edge_is_that_of_the_box_whatever_the_speed(edge):
    assert edge_of(STATE, edge).tolist() == [EDGES[edge]]
    assert (OBSERVATION @ STATE[0])[edge] == EDGES[edge]


def test_the_rows_of_a_covariance_are_those_of_the_observation():
    roots = np.random.default_rng(0).normal(size=(3, 6, 6))
    covariances = roots @ np.swapaxes(roots, 1, 2)
    assert edge_rows(covariances) == pytest.approx(OBSERVATION @ covariances)

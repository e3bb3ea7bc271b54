# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""State of a vehicle on the plane of the road, against hand numbers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.trackers.traffic.edge_observation import (
    ACROSS,
    ALONG,
    OBSERVATION,
    Edge,
    V,
)
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Gaussians, Motion

STILL = Motion(acceleration=0.0, top_speed=0.5, focal=400.0)
MOVING = Motion(acceleration=0.01, top_speed=0.5, focal=400.0)


def box_state():
    """A box 40 px wide and 30 px high whose lower edge is 100 px below the horizon."""
    return around(80.0, 120.0, 120.0, 150.0)


def around(*edges, horizon=50.0, motion=STILL):
    """One vehicle in a box of edges that err by 1 px."""
    return Gaussians.around(np.array([edges]), np.ones((1, 4)), np.array([horizon]), motion)


def moved(state, components, values):
    """The same with other means of some components."""
    mean = state.mean.copy()
    mean[:, components] = values
    return Gaussians.of(mean, state.covariance, state.horizon)


@pytest.fixture
def state():
    return box_state()


def test_the_first_box_is_the_detection(state):
    assert state.edges[0] == pytest.approx([80, 120, 120, 150])
    assert state.velocity.tolist() == [[0.0, 0.0]]


def sides(state):
    """Width and height."""
    return (state.edges[0, 2:] - state.edges[0, :2]).tolist()


def test_a_nearer_vehicle_is_larger_by_the_rule_of_perspective(state):
    state = moved(state, ALONG, -0.1 / 100).driven(1.0, STILL)
    # 1 / v falls from 0.01 to 0.009.
    assert state.mean[0, V] == pytest.approx(1 / 0.009)
    assert sides(state) == pytest.approx([40 / 0.9, 30 / 0.9])


def test_another_horizon_changes_neither_box_nor_velocity_of_the_lower_edge(state):
    state = moved(state, [ACROSS, ALONG], (0.02, -0.0004))
    rate = (state.mean[0, 0] * 0.04 + 2.0, 4.0)  # of the lower edge's middle, px per period
    spread = np.sqrt(state.covariance[0, ALONG, ALONG]) * 100**2
    lower = state.under(100.0)
    assert lower.edges == pytest.approx(state.edges)
    x, v, _, _, across, along = lower.mean[0]
    assert v == 50
    assert (-along * v * x + across * v, -along * v**2) == pytest.approx(rate)
    assert np.sqrt(lower.covariance[0, ALONG, ALONG]) * 50**2 == pytest.approx(spread)
    sky = lower.under(1000.0)  # it cannot drive there
    assert sky.mean[0, V] > 0
    assert sky.edges == pytest.approx(state.edges)


def test_the_jacobian_is_that_of_the_prediction():
    start = moved(box_state(), [ACROSS, ALONG], (0.02, -0.0004))

    def predicted(mean):
        return moved(box_state(), slice(None), mean).driven(2.0, STILL).mean[0]

    first = start.mean[0]
    steps = 1e-6 * np.maximum(np.abs(first), 1e-3)
    columns = [
        (predicted(first + step) - predicted(first - step)) / (2 * step.sum())
        for step in np.diag(steps)
    ]
    jacobian = np.array(columns).T
    covariance = np.diag([1.0, 2.0, 0.5, 0.4, 1e-4, 1e-8])
    end = Gaussians.of(start.mean, covariance[np.newaxis], start.horizon).driven(2.0, STILL)
    noise = end.covariance[0] - jacobian @ covariance @ jacobian.T
    w, h = end.mean[0, 2:4]
    assert noise[2, 2] / first[2] ** 2 == pytest.approx(noise[3, 3] / first[3] ** 2, rel=1e-3)
    noise[2, 2] = noise[3, 3] = 0
    assert w > first[2]
    assert h > first[3]
    assert noise == pytest.approx(np.zeros((6, 6)), abs=1e-6)


def test_an_edge_moves_the_box_by_the_kalman_gain(state):
    exact = np.where(np.arange(4) == Edge.BOTTOM, 1.0, np.inf)
    state = state.measured(np.full((1, 4), 152.0), exact[np.newaxis])
    # Variance 1 of the edge and 1 of its measurement: half way.
    assert state.edges[0, Edge.BOTTOM] == pytest.approx(151)
    assert state.edge_covariance[0, Edge.BOTTOM, Edge.BOTTOM] == pytest.approx(0.5)
    assert state.edges[0, Edge.LEFT] == 80


def test_variances_of_edges_are_those_of_the_observation(state):
    state = state.driven(3.0, MOVING).measured(state.edges + 2, np.full((1, 4), 3.0))
    expected = OBSERVATION @ state.covariance[0] @ OBSERVATION.T
    assert state.edge_covariance[0] == pytest.approx(expected)
    assert state.edge_variances[0] == pytest.approx(np.diag(expected))
    relative = OBSERVATION @ state.mean[0] + [0, 50, 0, 50]
    assert state.edges[0] == pytest.approx(relative)


def test_measured_places_give_the_speed():
    state = around(0.0, 20.0, 40.0, 50.0, horizon=-1e4)
    for index in range(1, 30):
        box = np.array([[3.0 * index, 20.0, 40 + 3.0 * index, 50.0]])
        state = state.driven(1.0, STILL).measured(box, np.ones((1, 4)))
    assert state.velocity[0] == pytest.approx((3.0, 0.0), abs=0.1)


@pytest.mark.parametrize("along", [-10.0, -0.011, 10.0])
def test_no_speed_makes_a_box_infinite(state, along):
    state = moved(state, ALONG, along)
    for _ in range(5):
        state = state.driven(1.0, STILL)
    assert np.isfinite(state.edges).all()
    assert sides(state)[0] >= 1


@pytest.mark.parametrize("along", [-1.0, 1.0])
def test_where_the_growth_is_bounded_it_depends_on_nothing(state, along):
    state = moved(state, ALONG, along)  # far beyond a growth of 2
    driven = state.driven(1.0, STILL)
    growth = 2.0 ** -np.sign(along)
    assert driven.mean[0, V] == pytest.approx(100 * growth)
    assert driven.covariance[0, V, V] == pytest.approx(state.covariance[0, V, V] * growth**2)


def test_a_hidden_vehicle_that_drives_away_stays_as_uncertain_as_it_is():
    state = moved(around(80.0, 60.0, 120.0, 90.0, motion=MOVING), ALONG, 0.1)
    for _ in range(1000):
        state = state.driven(1.0, MOVING)
    assert state.is_sound.all()


def test_a_speed_is_told_by_how_far_it_is_from_zero(state):
    variances = state.covariance[0].diagonal()
    fast = moved(state, ACROSS, 3 * np.sqrt(variances[ACROSS]))
    assert fast.speed_ratio == pytest.approx([3.0])
    assert state.speed_ratio == pytest.approx([0.0])


STEPS = st.tuples(
    st.floats(-9, 4),  # power of ten of the elapsed periods
    st.lists(st.tuples(st.sampled_from(Edge), st.floats(0, 1000), st.floats(0.7, 100)), max_size=4),
    st.floats(-1000, 1000),  # the horizon's row
)


@settings(max_examples=300, deadline=None)
@given(
    st.lists(STEPS, max_size=60),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    st.tuples(st.floats(0, 500), st.floats(1, 500), st.floats(1, 300)),
)
def test_no_times_and_measurements_end_a_covariance(steps, velocity, box):
    left, width, height = box
    state = around(left, 400 - height, left + width, 400.0, motion=MOVING)
    state = moved(state, [ACROSS, ALONG], velocity)
    for power, measurements, horizon in steps:
        state = state.under(horizon).driven(10.0**power, MOVING)
        assert_sound(state)
        assert np.abs(state.mean).max() <= 1e5
        for edge, value, deviation in measurements:
            exact = np.where(np.arange(4) == edge, deviation, np.inf)
            state = state.measured(np.full((1, 4), value), exact[np.newaxis])
        assert_sound(state)


def assert_sound(state):
    """Symmetric; positive and bounded to the rounding that a measurement after a gap leaves."""
    assert state.is_sound.all()
    covariance = state.covariance[0]
    deviations = np.sqrt(np.diag(covariance))
    assert deviations.max() <= 1e5 * (1 + 1e-9)
    correlations = covariance / np.outer(deviations, deviations)
    assert (covariance == covariance.T).all()
    assert np.linalg.eigvalsh(correlations).min() > -1e-6


def test_vehicles_that_are_predicted_together_go_on_as_each_alone_would():
    boxes = np.array([[80.0, 120, 120, 150], [10, 60, 30, 75], [200, 150, 290, 230]])
    deviations = np.array([[1, np.inf, 2, 1], [1, 1, 1, 1], [np.inf] * 4])

    def gone_on(rows):
        errors, horizon = np.ones((len(rows), 4)), np.full(len(rows), 50.0)
        start = Gaussians.around(boxes[rows], errors, horizon, MOVING)
        return start.under(20.0).driven(1.5, MOVING).measured(boxes[rows] + 3, deviations[rows])

    every = gone_on([0, 1, 2])
    for row in range(3):
        alone = gone_on([row])
        assert every.mean[row] == pytest.approx(alone.mean[0])
        assert every.covariance[row] == pytest.approx(alone.covariance[0])
        assert every.edges[row] == pytest.approx(alone.edges[0])
        assert every.horizon[row] == 20.0
    assert gone_on([]).is_sound.all()


def test_the_point_on_the_road_errs_as_the_edges_do(state):
    # Edges of 1 px: their middle has half the variance of one, the lower edge has its own.
    assert state.foot_covariance[0] == pytest.approx((0.5, 0.0, 1.0))
    state = state.driven(5.0, STILL)
    between = state.edge_covariance[0]
    left, _, right, bottom = between.diagonal()
    by_x, both, by_y = state.foot_covariance[0]
    assert by_x == pytest.approx((left + right + 2 * between[0, 2]) / 4)
    assert both == pytest.approx((between[0, 3] + between[2, 3]) / 2)
    assert by_y == pytest.approx(bottom)

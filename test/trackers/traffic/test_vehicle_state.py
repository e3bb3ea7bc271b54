# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""State of a vehicle on the plane of the road, against hand numbers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.trackers.traffic.vehicle_state import (
    ACROSS,
    ALONG,
    Drive,
    Edge,
    V,
    VehicleState,
)

STILL = Drive(acceleration=0.0, top_speed=0.5, focal=400.0)
MOVING = Drive(acceleration=0.01, top_speed=0.5, focal=400.0)


def box_state():
    """A box 40 px wide and 30 px high whose lower edge is 100 px below the horizon."""
    return VehicleState(np.array([80.0, 120.0, 120.0, 150.0]), np.ones(4), 50.0, STILL)


@pytest.fixture
def state():
    return box_state()


def test_the_first_box_is_the_detection(state):
    assert state.edges == pytest.approx([80, 120, 120, 150])
    assert (state.box.width, state.box.height) == (40, 30)
    assert state.velocity == (0.0, 0.0)


def test_a_nearer_vehicle_is_larger_by_the_rule_of_perspective(state):
    state.mean[ALONG] = -0.1 / 100
    state.predict(1.0, STILL)
    # 1 / v falls from 0.01 to 0.009.
    assert state.mean[V] == pytest.approx(1 / 0.009)
    assert state.box.width == pytest.approx(40 / 0.9)
    assert state.box.height == pytest.approx(30 / 0.9)


def test_another_horizon_changes_neither_box_nor_velocity_of_the_lower_edge(state):
    state.mean[4:] = (0.02, -0.0004)
    rate = (state.mean[0] * 0.04 + 2.0, 4.0)  # of the lower edge's middle, px per period
    spread = np.sqrt(state.covariance[ALONG, ALONG]) * 100**2
    edges = state.edges
    state.move_horizon(100.0)
    assert state.edges == pytest.approx(edges)
    x, v, _, _, across, along = state.mean
    assert v == 50
    assert (-along * v * x + across * v, -along * v**2) == pytest.approx(rate)
    assert np.sqrt(state.covariance[ALONG, ALONG]) * 50**2 == pytest.approx(spread)
    state.move_horizon(1000.0)  # it cannot drive in the sky
    assert state.mean[V] > 0
    assert state.edges == pytest.approx(edges)


def test_the_jacobian_is_that_of_the_prediction():
    start = box_state()
    start.mean[4:] = (0.02, -0.0004)

    def predicted(mean):
        one = box_state()
        one.mean = mean.copy()
        one.predict(2.0, STILL)
        return one.mean

    steps = 1e-6 * np.maximum(np.abs(start.mean), 1e-3)
    columns = [
        (predicted(start.mean + step) - predicted(start.mean - step)) / (2 * step.sum())
        for step in np.diag(steps)
    ]
    jacobian = np.array(columns).T
    start.covariance = np.diag([1.0, 2.0, 0.5, 0.4, 1e-4, 1e-8])
    expected = jacobian @ start.covariance @ jacobian.T
    w, h = predicted(start.mean)[2:4]
    start_width, start_height = start.mean[2:4]
    start.predict(2.0, STILL)
    noise = start.covariance - expected
    assert noise[2, 2] / start_width**2 == pytest.approx(noise[3, 3] / start_height**2, rel=1e-3)
    noise[2, 2] = noise[3, 3] = 0
    assert w > start_width
    assert h > start_height
    assert noise == pytest.approx(np.zeros((6, 6)), abs=1e-6)


def test_an_edge_moves_the_box_by_the_kalman_gain(state):
    state.measure(np.full(4, 152.0), np.where(np.arange(4) == Edge.BOTTOM, 1.0, np.inf))
    # Variance 1 of the edge and 1 of its measurement: half way.
    assert state.edges[Edge.BOTTOM] == pytest.approx(151)
    assert state.edge_covariance[Edge.BOTTOM, Edge.BOTTOM] == pytest.approx(0.5)
    assert state.edges[Edge.LEFT] == 80


def test_measured_places_give_the_speed():
    state = VehicleState(np.array([0.0, 20.0, 40.0, 50.0]), np.ones(4), -1e4, STILL)
    for index in range(1, 30):
        state.predict(1.0, STILL)
        state.measure(np.array([3.0 * index, 20.0, 40 + 3.0 * index, 50.0]), np.ones(4))
    assert state.velocity == pytest.approx((3.0, 0.0), abs=0.1)


@pytest.mark.parametrize("along", [-10.0, -0.011, 10.0])
def test_no_speed_makes_a_box_infinite(state, along):
    state.mean[ALONG] = along
    for _ in range(5):
        state.predict(1.0, STILL)
    assert np.isfinite(state.edges).all()
    assert state.box.width >= 1


@pytest.mark.parametrize("along", [-1.0, 1.0])
def test_where_the_growth_is_bounded_it_depends_on_nothing(state, along):
    state.mean[ALONG] = along  # far beyond a growth of 2
    before = state.covariance.copy()
    state.predict(1.0, STILL)
    growth = 2.0 ** -np.sign(along)
    assert state.mean[V] == pytest.approx(100 * growth)
    assert state.covariance[V, V] == pytest.approx(before[V, V] * growth**2)


def test_a_hidden_vehicle_that_drives_away_stays_as_uncertain_as_it_is():
    state = VehicleState(np.array([80.0, 60.0, 120.0, 90.0]), np.ones(4), 50.0, MOVING)
    state.mean[ALONG] = 0.1
    for _ in range(1000):
        state.predict(1.0, MOVING)
    assert state.is_sound


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
    edges = np.array([left, 400 - height, left + width, 400.0])
    state = VehicleState(edges, np.ones(4), 50.0, MOVING)
    state.mean[ACROSS:] = velocity
    for power, measurements, horizon in steps:
        state.move_horizon(horizon)
        state.predict(10.0**power, MOVING)
        assert_sound(state)
        assert np.abs(state.mean).max() <= 1e5
        for edge, value, deviation in measurements:
            state.measure(np.full(4, value), np.where(np.arange(4) == edge, deviation, np.inf))
        assert_sound(state)


def assert_sound(state):
    """Symmetric; positive and bounded to the rounding that a measurement after a gap leaves."""
    assert state.is_sound
    deviations = np.sqrt(np.diag(state.covariance))
    assert deviations.max() <= 1e5 * (1 + 1e-9)
    correlations = state.covariance / np.outer(deviations, deviations)
    assert (state.covariance == state.covariance.T).all()
    assert np.linalg.eigvalsh(correlations).min() > -1e-6


def test_states_that_are_stacked_go_on_as_each_alone_would():
    boxes = np.array([[80.0, 120, 120, 150], [10, 60, 30, 75], [200, 150, 290, 230]])
    alone, together = ([VehicleState(b, np.ones(4), 50.0, MOVING) for b in boxes] for _ in "ab")
    stack = VehicleState.stacked(together)
    edges, deviations = boxes + 3, np.array([[1, np.inf, 2, 1], [1, 1, 1, 1], [np.inf] * 4])
    for one, measured, spread in zip(
        [stack, *alone], [edges, *edges], [deviations, *deviations], strict=True
    ):
        one.move_horizon(20.0)
        one.predict(1.5, MOVING)
        one.measure(measured, spread)
    stack.give_back(together)
    for one, other in zip(alone, together, strict=True):
        assert other.mean == pytest.approx(one.mean)
        assert other.covariance == pytest.approx(one.covariance)
        assert other.box == one.box
        assert (other.velocity, other.horizon) == (pytest.approx(one.velocity), 20.0)
    assert VehicleState.stacked([]).is_sound.all()


def test_the_point_on_the_road_errs_as_the_edges_do(state):
    # Edges of 1 px: their middle has half the variance of one, the lower edge has its own.
    assert state.foot_covariance == pytest.approx((0.5, 0.0, 1.0))
    state.predict(5.0, STILL)
    (left, _, right, bottom), between = state.edge_covariance.diagonal(), state.edge_covariance
    by_x, both, by_y = state.foot_covariance
    assert by_x == pytest.approx((left + right + 2 * between[0, 2]) / 4)
    assert both == pytest.approx((between[0, 3] + between[2, 3]) / 2)
    assert by_y == pytest.approx(bottom)

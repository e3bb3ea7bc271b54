# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.road.motion import RoadMotion


def test_two_positions_give_the_speed_between_them():
    # With nothing known of the speed and no acceleration, two positions of variance r, t apart,
    # give their difference over t, with the variance 2 r / t^2.
    variance, seconds = 0.01, 0.5
    motion = RoadMotion.at(np.array([0.0, 0.0]), np.eye(2) * variance)
    motion = motion.predicted(seconds, 1e-9).measured(np.array([3.0, 4.0]), np.eye(2) * variance)
    assert motion.speed == pytest.approx(10.0, rel=1e-3)
    assert motion.velocity == pytest.approx([6.0, 8.0], rel=1e-3)
    assert motion.speed_deviation == pytest.approx(np.sqrt(2 * variance) / seconds, rel=1e-3)


def test_covariance_of_the_speed_is_along_its_direction():
    covariance = np.diag([0.0, 0.0, 4.0, 9.0])
    along = RoadMotion(np.array([0.0, 0.0, 5.0, 0.0]), covariance)
    across = RoadMotion(np.array([0.0, 0.0, 0.0, 5.0]), covariance)
    assert (along.speed_deviation, across.speed_deviation) == pytest.approx((2.0, 3.0))
    assert RoadMotion(np.zeros(4), covariance).speed_deviation == pytest.approx(3.0)


def test_deviation_is_that_of_many_runs():
    rng = np.random.default_rng(5)
    covariance = np.array([[0.04, 0.01], [0.01, 0.09]])
    speeds, deviations = [], []
    for _ in range(300):
        noise = rng.multivariate_normal([0, 0], covariance, 40)
        motion = None
        for index, error in enumerate(noise):
            measured = np.array([12.0, 5.0]) * index / 30 + error
            if motion is None:
                motion = RoadMotion.at(measured, covariance)
            else:
                motion = motion.predicted(1 / 30, 0.01).measured(measured, covariance)
        speeds.append(motion.speed)
        deviations.append(motion.speed_deviation)
    assert np.mean(speeds) == pytest.approx(13.0, abs=0.05)
    assert np.std(speeds) == pytest.approx(np.mean(deviations), rel=0.1)


@settings(max_examples=200, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(-9, 4),  # power of ten of the seconds
            st.one_of(st.none(), st.tuples(st.floats(-1e4, 1e4), st.floats(-8, 6))),
        ),
        max_size=60,
    )
)
def test_no_times_and_measurements_end_a_covariance(steps):
    motion = RoadMotion.at(np.zeros(2), np.eye(2) * 0.01)
    for power, measured in steps:
        motion = motion.predicted(10.0**power, 2.0)
        if measured is not None:
            place, variance = measured
            covariance = np.array([[2.0, 1.0], [1.0, 3.0]]) * 10.0**variance
            motion = motion.measured(np.array([place, -place]), covariance)
        assert np.isfinite(motion.state).all()
        assert np.isfinite(motion.speed_deviation)
        deviations = np.sqrt(np.diag(motion.covariance))
        assert deviations.min() > 0
        correlations = motion.covariance / np.outer(deviations, deviations)
        assert np.abs(correlations - correlations.T).max() < 1e-6
        assert np.linalg.eigvalsh(correlations).min() > -1e-6


def test_a_start_knows_its_position_and_no_speed():
    motion = RoadMotion.at(np.array([3.0, -4.0]), np.array([[0.04, 0.01], [0.01, 0.09]]))
    assert motion.state == pytest.approx([3.0, -4.0, 0.0, 0.0])
    expected = np.diag([0.04, 0.09, 1600.0, 1600.0])  # 40 m/s
    expected[0, 1] = expected[1, 0] = 0.01
    assert motion.covariance == pytest.approx(expected)


def test_a_random_walk_of_the_velocity_by_hand():
    # Within t = 3 s, of 2 m/s a second: 4 t in the velocity, 4 t^2 / 2 between both, 4 t^3 / 3.
    motion = RoadMotion(np.array([1.0, 2.0, 10.0, -5.0]), np.zeros((4, 4))).predicted(3.0, 2.0)
    assert motion.state == pytest.approx([31.0, -13.0, 10.0, -5.0])
    one = np.array([[36.0, 18.0], [18.0, 12.0]])
    assert motion.covariance[::2, ::2] == pytest.approx(one)
    assert motion.covariance[1::2, 1::2] == pytest.approx(one)
    assert motion.covariance[::2, 1::2] == pytest.approx(np.zeros((2, 2)))


def test_a_known_speed_widens_the_position():
    # A deviation of 2 m/s is one of 6 m after 3 s, and goes with it.
    motion = RoadMotion(np.zeros(4), np.diag([0.0, 0.0, 4.0, 0.0])).predicted(3.0, 0.0)
    assert motion.covariance[::2, ::2] == pytest.approx(np.array([[36.0, 12.0], [12.0, 4.0]]))


def test_a_measurement_as_sure_as_the_prediction_goes_half_way():
    motion = RoadMotion(np.zeros(4), np.diag([1.0, 1.0, 4.0, 4.0]))
    after = motion.measured(np.array([2.0, -6.0]), np.eye(2))
    assert after.state == pytest.approx([1.0, -3.0, 0.0, 0.0])
    assert np.diag(after.covariance) == pytest.approx([0.5, 0.5, 4.0, 4.0])

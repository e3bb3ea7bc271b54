"""Constant velocity on the road, seen in perspective."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.projective_motion import ProjectiveMotion, fit_motion

TIMES = np.arange(-20.0, 1.0)


def seen(motion, times=TIMES):
    states = [motion.at(time) for time in times]
    return np.array([place for place, _ in states]), np.array([scale for _, scale in states])


@pytest.mark.parametrize("rate", [-0.02, -0.01, 0.0, 0.01, 0.02])
def test_known_motions_are_recovered(rate):
    motion = ProjectiveMotion((100.0, 50.0), (3.0, -1.0), 1.2, rate)
    places, scales = seen(motion)
    fitted = fit_motion(TIMES, places, scales, 30.0)
    assert fitted.rate == pytest.approx(rate, abs=0.002)
    assert fitted.place == pytest.approx((100.0, 50.0), abs=0.5)
    ahead, scale = fitted.at(15.0)
    expected, expected_scale = motion.at(15.0)
    assert ahead == pytest.approx(expected, abs=5.0)
    assert scale == pytest.approx(expected_scale, rel=0.06)


def test_noise_is_borne():
    motion = ProjectiveMotion((100.0, 50.0), (3.0, 0.0), 1.0, 0.01)
    rng = np.random.default_rng(0)
    places, scales = seen(motion)
    fitted = fit_motion(
        TIMES, places + rng.normal(0, 0.5, places.shape),
        scales * np.exp(rng.normal(0, 0.03, len(scales))), 30.0,
    )  # fmt: skip
    assert fitted.at(10.0)[0] == pytest.approx(motion.at(10.0)[0], abs=6.0)


def test_without_perspective_the_size_stays():
    motion = ProjectiveMotion((100.0, 50.0), (3.0, 0.0), 1.0, 0.02)
    fitted = fit_motion(TIMES, *seen(motion), 30.0, projective=False)
    assert fitted.rate == 0
    assert fitted.at(50.0)[1] == fitted.at(0.0)[1]


def test_one_sighting_stands_still():
    fitted = fit_motion(np.zeros(1), np.array([[7.0, 8.0]]), np.ones(1), 20.0)
    assert fitted.velocity == (0.0, 0.0)
    assert fitted.at(9.0)[0] == pytest.approx((7.0, 8.0))


def test_velocity_is_the_derivative_of_the_place():
    motion = ProjectiveMotion((0.0, 0.0), (2.0, 1.0), 1.0, 0.01)
    before, after = motion.at(9.999)[0], motion.at(10.001)[0]
    slope = (np.array(after) - before) / 0.002
    assert motion.velocity_at(10.0) == pytest.approx(tuple(slope), rel=1e-4)


def test_a_vehicle_that_comes_closer_does_not_grow_without_bound():
    motion = ProjectiveMotion((0.0, 0.0), (2.0, 1.0), 1.0, 0.04)
    place, scale = motion.at(1000.0)
    assert np.isfinite(place).all()
    assert scale == pytest.approx(4.0)


def test_a_camera_that_moves_takes_the_motion_along():
    motion = ProjectiveMotion((10.0, 20.0), (2.0, 1.0), 1.0, 0.01)
    carried = motion.moved((5.0, -5.0), 2.0)
    (x, y), scale = motion.at(7.0)
    assert carried.at(7.0)[0] == pytest.approx((2 * x + 5, 2 * y - 5))
    assert carried.at(7.0)[1] == pytest.approx(2 * scale)

"""Particles that move, grow and are drawn anew."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.particles import Particles, Spread

NONE = Spread(0.0, 0.0, 0.0)


def rng():
    return np.random.default_rng(5)


def around(spread=NONE, count=4000, velocity=(2.0, -1.0)):
    return Particles.around(rng(), count, (100.0, 50.0), velocity, 1.5, spread)


def test_they_are_drawn_around_a_state():
    cloud = around(Spread(3.0, 0.5, 0.1))
    assert cloud.positions.std(axis=0) == pytest.approx([3.0, 3.0], rel=0.05)
    assert cloud.velocities.std(axis=0) == pytest.approx([0.5, 0.5], rel=0.05)
    assert np.log(cloud.scales).std() == pytest.approx(0.1, rel=0.05)
    assert cloud.place == pytest.approx((100.0, 50.0), abs=0.2)
    assert cloud.scale == pytest.approx(1.5, rel=0.01)
    assert cloud.width == pytest.approx(3.0, rel=0.05)


def test_they_move_with_their_velocity_and_growth():
    moved = around().moved(rng(), 3.0, 0.02, NONE)
    assert moved.place == pytest.approx((106.0, 47.0))
    assert moved.scale == pytest.approx(1.5 * np.exp(0.06))


def test_noise_grows_with_the_root_of_the_time():
    moved = around().moved(rng(), 4.0, 0.0, Spread(3.0, 0.5, 0.1))
    assert moved.positions.std(axis=0) == pytest.approx([6.0, 6.0], rel=0.05)
    assert moved.velocities.std(axis=0) == pytest.approx([1.0, 1.0], rel=0.05)


def test_low_weights_are_replaced_by_copies_of_others():
    base = around(Spread(3.0, 0.5, 0.1), count=100)
    weights = np.full(100, 0.001)
    weights[7] = 1 - 0.099
    renewed, count = Particles(base.positions, base.velocities, base.scales, weights).renewed(
        rng(), NONE
    )
    assert count == 99
    assert (renewed.positions == base.positions[7]).all()
    assert (renewed.velocities == base.velocities[7]).all()


def test_equal_weights_are_all_kept():
    base = around(Spread(3.0, 0.5, 0.1), count=64)
    renewed, count = base.renewed(rng(), NONE)
    assert count == 0
    assert (renewed.positions == base.positions).all()


def test_they_go_half_way_to_a_better_estimate_and_all_the_way_to_its_scale():
    moved = around().drawn_towards((104.0, 50.0), (4.0, -1.0), 1.2)
    assert moved.place == pytest.approx((102.0, 50.0))
    assert moved.velocities.mean(axis=0) == pytest.approx([3.0, -1.0])
    assert moved.scale == pytest.approx(1.2)


@pytest.mark.parametrize("along", [True, False])
def test_hidden_ones_advance_with_the_velocity_and_spread_along_it(along):
    drifted = around().drifted(rng(), 1.0, (4.0, 0.0), 1.1, 0.5, along=along)
    assert drifted.place == pytest.approx((104.0, 50.0), abs=0.15)
    # A Rayleigh variable of mean m has a standard deviation of m sqrt(4 / pi - 1).
    expected = 4.0 * (4 / np.pi - 1) ** 0.5 if along else 0.5
    assert drifted.positions.std(axis=0) == pytest.approx([expected, 0.5], rel=0.05)
    assert (drifted.scales == 1.1).all()


def test_they_are_kept_in_the_image_and_between_sizes():
    frame = np.zeros((40, 90, 3), np.uint8)
    kept = around(Spread(30.0, 0.0, 0.5)).kept(frame, (1.0, 2.0))
    assert kept.positions.min() >= 0.5
    assert (kept.positions.max(axis=0) <= [89.5, 39.5]).all()
    assert kept.scales.min() == 1.0
    assert kept.scales.max() == 2.0


def test_they_are_resampled_by_weight():
    base = around(Spread(3.0, 0.0, 0.0), count=4)
    drawn = Particles(
        base.positions, base.velocities, base.scales, np.array([0.0, 0.5, 0.0, 0.5])
    ).resampled(rng(), 6)
    counts = [(drawn.positions == one).all(axis=1).sum() for one in base.positions]
    assert counts == [0, 3, 0, 3]
    assert drawn.weights == pytest.approx(np.full(6, 1 / 6))


def test_the_camera_takes_them_along():
    carried = around().carried(CameraMotion((5.0, 0.0), 2.0))
    assert carried.place == pytest.approx((205.0, 100.0))
    assert carried.velocities[0] == pytest.approx([4.0, -2.0])
    assert carried.scale == pytest.approx(3.0)

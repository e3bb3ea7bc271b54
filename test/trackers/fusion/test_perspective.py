# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion on the road: recovered from sightings, and continued."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sightings,
    fit_motion,
)


def moving(rate):
    return PerspectiveMotion(np.array([300.0, 200.0]), np.array([6.0, 3.0]), rate)


def course(motion, frames=20):
    """Times of the last frames, and the motion's positions and sizes then."""
    times = np.arange(-float(frames), 1.0)
    positions = np.array([motion.position_at(time) for time in times])
    return times, positions, np.array([80 * motion.scale_at(time) for time in times])


def fit(times, positions, sizes):
    """All sizes count alike."""
    return fit_motion(times, positions, sizes, np.ones(len(times)))


@pytest.mark.parametrize(
    ("rate", "frames"),
    [(0.0, 20), (0.01, 20), (0.025, 20), (-0.02, 20), (-0.0325, 20), (0.04, 60)],
)
def test_a_perspective_motion_is_recovered_exactly(rate, frames):
    """The last one was 3.4 times as small at first, which is no reason to doubt the rate."""
    true = moving(rate)
    found = fit(*course(true, frames))
    assert found.rate == pytest.approx(rate)
    assert found.position == pytest.approx(true.position)
    assert found.velocity == pytest.approx(true.velocity)
    assert found.position_at(15.0) == pytest.approx(true.position_at(15.0))


def test_a_vehicle_that_comes_closer_by_hand():
    """At r = 0.02 the divisor is 0.8 after 10 frames."""
    motion = PerspectiveMotion(np.array([100.0, 50.0]), np.array([4.0, 2.0]), 0.02)
    assert motion.position_at(10.0) == pytest.approx([150.0, 75.0])
    assert motion.velocity_at(10.0) == pytest.approx([6.25, 3.125])
    assert motion.scale_at(10.0) == pytest.approx(1.25)
    assert motion.growth_at(10.0) == pytest.approx(0.025)


def test_a_vehicle_that_passes_the_camera_does_not_grow_without_bound():
    motion = PerspectiveMotion(np.zeros(2), np.array([4.0, 2.0]), 0.04)
    for time in (25.0, 60.0, 1e4):
        assert motion.scale_at(time) <= 4
        assert np.isfinite(motion.position_at(time)).all()


def test_few_sightings_tell_no_rate():
    assert fit(*course(moving(0.02), 6)).rate == 0
    assert fit(*course(moving(0.02), 7)).rate > 0


def test_one_sighting_stands_still():
    found = fit(np.zeros(1), np.array([[30.0, 40.0]]), np.array([20.0]))
    assert found.position == pytest.approx([30, 40])
    assert found.velocity == pytest.approx([0, 0])
    assert found.rate == 0


def test_noise_is_averaged():
    true, errors = moving(0.0), []
    times, positions, sizes = course(true)
    for seed in range(20):
        rng = np.random.default_rng(seed)
        noisy = positions + rng.normal(0, 1.0, positions.shape)
        found = fit(times, noisy, sizes * np.exp(rng.normal(0, 0.01, len(times))))
        errors.append(np.linalg.norm(found.position_at(10.0) - true.position_at(10.0)))
    # The last two sightings alone would be off by 10 * sqrt(2) * sqrt(2) px.
    assert np.median(errors) < 6


def test_only_clear_sightings_are_fitted():
    sightings = Sightings()
    for time in range(12):
        sightings = sightings.moved_on(1.0, CameraMotion())
        clear = time < 9
        position = np.array([10.0 + 3 * time, 50.0]) if clear else np.array([37.0, 50.0])
        sightings = sightings.added(
            position, np.array([30.0, 20.0]), CLEAR_RESPONSE + (0.1 if clear else -0.1)
        )
    motion, last = sightings.fit()
    assert last.age == 3
    assert last.position == pytest.approx([34, 50])
    assert motion.velocity == pytest.approx([3, 0])
    assert motion.position_at(last.age) == pytest.approx([43, 50])


def growing(*, cut_from, response, camera=None):
    """Sightings of a vehicle that comes closer at a rate of 0.01, of which the last are cut."""
    sightings = Sightings()
    for time in range(40):
        sightings = sightings.moved_on(1.0, camera or CameraMotion())
        size = np.array([30.0, 20.0]) / (1 - 0.01 * (time - 39))
        is_cut = time >= cut_from
        if is_cut:
            size *= 0.97 ** (time - cut_from)
        sightings = sightings.added(np.array([50.0, 50.0]), size, response if is_cut else 1.0)
    return sightings


def test_sizes_that_an_occluder_begins_to_cut_do_not_count():
    def rate(cut_from, response):
        return growing(cut_from=cut_from, response=response).fit()[0].rate

    assert rate(40, 1.0) == pytest.approx(0.01)
    assert rate(32, 0.89) == pytest.approx(0.01)
    assert rate(32, 0.91) < 0.008
    assert rate(7, 0.89) < 0  # where few sizes can be believed, all clear ones count


def test_before_a_camera_that_moves_the_size_stays():
    """There a vehicle that came closer need not go on coming closer."""
    moves = CameraMotion(np.eye(2), np.array([0.0, 0.01]))
    standing = growing(cut_from=40, response=1.0)
    moving = growing(cut_from=40, response=1.0, camera=moves)
    assert standing.are_steady and not moving.are_steady
    assert standing.fit()[0].rate == pytest.approx(0.01)
    assert moving.fit()[0].scale_at(10.0) == 1.0


def test_sightings_are_steady_when_the_camera_has_stood_for_as_long_as_they_are_kept():
    sightings = Sightings()
    assert sightings.are_steady
    sightings = sightings.moved_on(1.0, CameraMotion(np.eye(2), np.array([3.0, 0.0])))
    assert not sightings.are_steady
    for _ in range(60):
        sightings = sightings.moved_on(1.0, CameraMotion())
    assert not sightings.are_steady
    sightings = sightings.moved_on(1.0, CameraMotion())
    assert sightings.are_steady


def test_a_camera_that_sways_stands_and_carries_sightings_along():
    sightings = Sightings().added(np.array([50.0, 40.0]), np.array([20.0, 12.0]), 1.0)
    sways = CameraMotion(np.eye(2), np.array([1.5, -1.0]))
    sightings = sightings.moved_on(1.0, sways, stands=True)
    assert sightings.are_steady
    assert sightings.rows[0, 1:3].tolist() == [51.5, 39.0]


def test_without_clear_sightings_there_is_nothing_to_fit():
    sightings = Sightings()
    assert sightings.fit() is None
    sightings = sightings.added(np.zeros(2), np.ones(2), CLEAR_RESPONSE - 0.01)
    assert sightings.fit() is None


def test_sightings_move_with_the_camera_and_age():
    sightings = Sightings()
    sightings = sightings.added(np.array([10.0, 20.0]), np.array([8.0, 6.0]), 1.0)
    sightings = sightings.moved_on(
        2.0, CameraMotion(np.array([[0.0, -1.0], [1.0, 0.0]]), np.array([5, 1]))
    )
    _, last = sightings.fit()
    assert last.age == 2
    assert last.position == pytest.approx([-15, 11])
    assert last.size == pytest.approx([8, 6])


def test_sightings_are_of_a_box_that_is_larger_at_one_end():
    """A third wider to the right: the centre by a sixth of the width that each had."""
    sightings = Sightings()
    for width in (30.0, 60.0):
        size = np.array([width, 20.0])
        sightings = sightings.moved_on(1.0, CameraMotion()).added(np.array([9.0, 5]), size, 1.0)
    wider = sightings.rescaled(np.array([1 / 6, 0]), np.array([4 / 3, 1]))
    expected = np.array([[1, 14, 5, 40, 20, 1, 14, 5], [0, 19, 5, 80, 20, 1, 19, 5]])
    assert wider.rows == pytest.approx(expected)
    assert sightings.rows[0, 1] == 9


def returned_for(frames, response=1.0):
    """Sightings of a vehicle at 3 px per frame, hidden from frame 20 to 79, then seen elsewhere."""
    sightings = Sightings()
    for time in range(80 + frames):
        sightings = sightings.moved_on(1.0, CameraMotion())
        if 20 <= time < 80:
            continue
        position = np.array([10.0 + 3 * time if time < 20 else 0.0, 50.0])
        level = 1.0 if time < 20 else response
        size = np.array([30.0, 20.0])
        sightings = sightings.added(position, size, level, returned=time == 80)
    return sightings.moved_on(1.0, CameraMotion())


@pytest.mark.parametrize("response", [1.0, CLEAR_RESPONSE - 0.01])
def test_a_return_of_less_than_eight_frames_may_have_been_to_another_vehicle(response):
    """However long it was hidden before, it is expected where it was expected then."""
    motion, last = returned_for(7, response).proven().fit()
    assert last.age == 68
    assert motion.position_at(last.age) == pytest.approx([10 + 3 * 87, 50])


def test_a_longer_return_counts():
    _, last = returned_for(8).proven().fit()
    assert last.age == 1
    assert last.position == pytest.approx([0, 50])


def test_a_vehicle_that_was_never_hidden_is_proven_from_its_first_frame_on():
    sightings = Sightings().added(np.zeros(2), np.ones(2), 1.0)
    assert len(sightings.proven().rows) == 1


def test_sightings_are_kept_for_two_seconds_before_the_last_clear_one():
    sightings = Sightings()
    for response in (1.0, 1.0, 0.5):
        sightings = sightings.added(np.zeros(2), np.ones(2), response)
        for _ in range(40):
            sightings = sightings.moved_on(1.0, CameraMotion())
    # The first is 40 frames older than the last clear one, at 80 frames, however long ago that is.
    assert sightings.rows[:, 0].tolist() == [120.0, 80.0, 40.0]
    assert sightings.fit()[1].age == 80
    for _ in range(41):
        sightings = sightings.moved_on(1.0, CameraMotion())
    sightings = sightings.added(np.zeros(2), np.ones(2), 1.0)
    assert sightings.moved_on(1.0, CameraMotion()).rows[:, 0].tolist() == [1.0]

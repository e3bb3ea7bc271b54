# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What every variant keeps to; a new one takes part by being registered."""

from importlib.util import find_spec

import numpy as np
import pytest
from street import HEIGHT, SIZE, WIDTH, Street, error, follow

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import from_mapping, specs, to_mapping
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.registry import VARIANTS


def has_particles(variant):
    return "num_particles" in specs(variant.parameters)


every_variant = pytest.mark.parametrize("variant", VARIANTS.values(), ids=list(VARIANTS))
every_particle_filter = pytest.mark.parametrize(
    "variant",
    [variant for variant in VARIANTS.values() if has_particles(variant)],
    ids=[name for name, variant in VARIANTS.items() if has_particles(variant)],
)


def few_particles(variant):
    return {"num_particles": 40} if has_particles(variant) else {}


def make(variant, **values):
    return variant.tracker(from_mapping(variant.parameters, values))


def numbers(estimate):
    scalars = {k: v for k, v in estimate.scalars().items() if k != "step_ms"}
    return scalars, estimate.particles.tobytes(), estimate.weights.tobytes()


def inside(estimate, width=WIDTH, height=HEIGHT):
    x, y = estimate.position
    cloud = estimate.particles
    return (
        0 <= x <= width
        and 0 <= y <= height
        and cloud.min() >= 0
        and np.all(cloud <= [width, height])
    )


@every_variant
def test_follows_a_vehicle_in_plain_sight(variant):
    street, times = Street(), range(45)
    estimates = follow(make(variant), street, times)
    assert np.median([error(e, street, t) for e, t in zip(estimates, times, strict=True)]) < 6
    assert {e.mode for e in estimates} == {Mode.TRACKING}
    assert error(estimates[-1], street, 44) < 10


@every_variant
def test_same_seed_gives_bit_identical_estimates(variant):
    street, times = Street(hidden=(20, 28)), range(40)
    first = follow(make(variant, seed=5), street, times)
    second = follow(make(variant, seed=5), street, times)
    assert [numbers(e) for e in first] == [numbers(e) for e in second]


@every_variant
def test_starting_again_forgets_what_was(variant):
    street, times = Street(), range(15)
    tracker = make(variant, seed=5)
    first = follow(tracker, street, times)
    assert [numbers(e) for e in follow(tracker, street, times)] == [numbers(e) for e in first]


@every_variant
def test_a_drawn_seed_can_be_used_again(variant):
    street, times = Street(), range(8)
    drawn = make(variant, seed=-1)
    first = follow(drawn, street, times)
    assert drawn.seed >= 0
    again = follow(make(variant, seed=drawn.seed), street, times)
    assert [numbers(e) for e in again] == [numbers(e) for e in first]


@every_variant
@pytest.mark.parametrize("layout", ["contiguous", "strided"])
def test_the_layout_of_the_frame_does_not_matter(variant, layout):
    street = Street()
    tracker, reference = make(variant), make(variant)
    expected = follow(reference, street, range(6))

    def view(frame):
        if layout == "contiguous":
            return np.ascontiguousarray(frame)
        wide = np.zeros((HEIGHT, WIDTH + 7, 3), np.uint8)
        wide[:, :WIDTH] = frame
        return wide[:, :WIDTH]

    estimates = [tracker.start(view(street.frame(0)), street.box(0))]
    estimates += [tracker.step(view(street.frame(t))) for t in range(1, 6)]
    assert [numbers(e) for e in estimates] == [numbers(e) for e in expected]


@every_variant
def test_dropped_frames_do_not_change_the_speed_in_px_per_second(variant):
    street = Street(speed=2.0)
    every, second = range(70), range(0, 70, 2)
    velocities, errors = [], []
    for times in (every, second):
        estimates = follow(make(variant), street, times)
        late = [e for e, t in zip(estimates, times, strict=True) if t >= 30]
        velocities.append(np.mean([e.velocity for e in late], axis=0))
        errors.append(error(estimates[-1], street, times[-1]))
    for velocity in velocities:
        assert velocity == pytest.approx([2.0, 0.0], abs=0.5)
    assert max(errors) < 10


@every_variant
@pytest.mark.parametrize(
    "box",
    [
        Box(-12, -8, 24, 16),
        Box(WIDTH - 12, HEIGHT - 8, 24, 16),
        Box(0, 0, WIDTH, HEIGHT),
        Box(-100, -100, 400, 320),
        Box(WIDTH - 1, 0, 1, 1),
    ],
    ids=["top left", "bottom right", "whole image", "larger than the image", "last pixel"],
)
def test_windows_at_and_over_the_border(variant, box):
    street = Street()
    tracker = make(variant, **few_particles(variant))
    assert inside(tracker.start(street.frame(0), box))
    for time in range(1, 6):
        estimate = tracker.step(street.frame(time))
        assert inside(estimate)
        if "size.step" not in specs(variant.parameters):  # the papers keep the size
            assert (estimate.box.width, estimate.box.height) == (box.width, box.height)


@every_variant
@pytest.mark.parametrize("box", [Box(500, 0, 10, 10), Box(0, 0, 0, 0), Box(np.nan, 0, 5, 5)])
def test_a_box_that_is_no_target_is_refused(variant, box):
    with pytest.raises(InputError, match="target"):
        make(variant).start(Street().frame(0), box)


@every_variant
def test_a_frame_that_is_none_is_refused_and_the_track_goes_on(variant):
    street = Street()
    tracker = make(variant)
    follow(tracker, street, range(5))
    with pytest.raises(InputError, match="frame"):
        tracker.step(np.zeros((0, 0, 3), np.uint8))
    assert error(tracker.step(street.frame(5)), street, 5) < 10


@every_variant
def test_stepping_before_the_start_is_a_bug_that_says_so(variant):
    with pytest.raises(RuntimeError, match="start"):
        make(variant).step(Street().frame(0))


@every_variant
@pytest.mark.parametrize("level", [0, 255])
def test_constant_frames_are_no_evidence(variant, level):
    street = Street()
    tracker = make(variant)
    follow(tracker, street, range(10))
    blank = np.full((HEIGHT, WIDTH, 3), level, np.uint8)
    estimates = [tracker.step(blank) for _ in range(5)]
    assert all(e.mode is not Mode.TRACKING for e in estimates)
    assert all(inside(e) for e in estimates)


@every_variant
def test_a_target_of_one_pixel_in_an_image_of_one_pixel(variant):
    dot = np.full((1, 1, 3), 9, np.uint8)
    tracker = make(variant)
    tracker.start(dot, Box(0, 0, 1, 1))
    assert inside(tracker.step(dot), 1, 1)


@every_variant
def test_a_hidden_target_is_not_claimed(variant):
    street, times = Street(speed=1.5, hidden=(20, 30)), range(30)
    estimates = follow(make(variant), street, times)
    assert [e.mode for e in estimates[:20]] == [Mode.TRACKING] * 20
    assert [e.mode for e in estimates[21:]] == [Mode.OCCLUDED] * 9
    assert max(e.confidence for e in estimates[21:]) < 0.7


@every_variant
def test_a_target_gone_for_good_is_lost_after_the_time_set(variant):
    street = Street(speed=0.0, hidden=(10, 10**9))
    tracker = make(variant, lost_after=2.0)
    tracker.frame_period = 0.1
    modes = [e.mode for e in follow(tracker, street, range(35))]
    lost = modes.index(Mode.LOST)
    # 2 s are 20 frames of 0.1 s; the first frame without the vehicle is frame 10.
    assert lost == 29
    assert set(modes[lost:]) == {Mode.LOST}


@every_variant
def test_a_vehicle_that_drives_out_of_the_image_is_lost(variant):
    street = Street(speed=6.0)
    tracker = make(variant, lost_after=1.0)
    estimates = follow(tracker, street, range(80))
    assert estimates[-1].mode is Mode.LOST
    assert all(inside(e) for e in estimates)


@every_variant
def test_estimates_are_views_that_nobody_can_write_and_the_next_step_leaves_alone(variant):
    street = Street()
    tracker = make(variant)
    tracker.start(street.frame(0), street.box(0))
    estimate = tracker.step(street.frame(1))
    for array in (estimate.particles, estimate.weights):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    before = numbers(estimate)
    tracker.step(street.frame(2))
    tracker.reconfigure(from_mapping(variant.parameters, few_particles(variant)))
    assert numbers(estimate) == before


@every_variant
def test_weights_and_counts_are_consistent(variant):
    for estimate in follow(make(variant), Street(), range(5)):
        count = len(estimate.weights)
        assert estimate.particles.shape == (count, 2)
        assert estimate.weights.sum() == pytest.approx(1.0)
        assert 1 - 1e-9 <= estimate.effective_sample_size <= count + 1e-6
        assert 0 <= estimate.confidence <= 1
        for name, value in estimate.similarities.items():
            # P2's level of confidence is a ratio of two similarities.
            assert 0 <= value <= (np.inf if name.startswith("lc_") else 1)


def alternatives(spec):
    """Other values of a parameter: the bounds (within reason), the middle, the other words."""
    if spec.kind is bool:
        return [not spec.default]
    if spec.choices:
        words = [word for word in spec.choices if word != spec.default]
        return [word for word in words if word != "numba" or find_spec("numba")]
    low, high = max(spec.bounds[0], -1e3), min(spec.bounds[1], 400)
    return [spec.kind(value) for value in (low, (low + high) / 2, high) if value != spec.default]


def changes(variant):
    """Every parameter's other values, with what has to be set beside them."""
    for name, spec in specs(variant.parameters).items():
        for value in alternatives(spec):
            values = {name: value}
            if name.startswith("evidence."):  # the two thresholds have to stay in order
                values |= {"evidence.occluded_below": 0.0} if name.endswith("clear_above") else {}
                values |= {"evidence.clear_above": 1.0} if name.endswith("occluded_below") else {}
            yield name, value, from_mapping(variant.parameters, values)


@every_variant
@pytest.mark.parametrize("hidden", [False, True], ids=["tracking", "occluded"])
def test_any_parameter_may_change_between_two_frames(variant, hidden):
    street, tracker = Street(speed=1.0, hidden=(5, 60) if hidden else (99, 99)), make(variant)
    follow(tracker, street, range(8))
    for name, value, changed in changes(variant):
        tracker.reconfigure(changed)
        estimate = tracker.step(street.frame(8))
        assert inside(estimate), name
        assert to_mapping(tracker.parameters)[name] == value
        assert len(estimate.weights) == getattr(changed, "num_particles", 1)
        tracker.reconfigure(variant.parameters())
        assert inside(tracker.step(street.frame(8))), name


@every_particle_filter
@pytest.mark.parametrize("count", [30, 700])
def test_the_track_survives_another_number_of_particles(variant, count):
    street = Street()
    tracker = make(variant)
    follow(tracker, street, range(10))
    tracker.reconfigure(from_mapping(variant.parameters, {"num_particles": count}))
    estimates = [tracker.step(street.frame(t)) for t in range(10, 25)]
    assert all(len(e.weights) == count for e in estimates)
    assert error(estimates[-1], street, 24) < 10


@every_variant
def test_a_new_window_while_occluded_does_not_learn_the_occluder(variant):
    street = Street(speed=0.0, hidden=(10, 20))
    tracker = make(variant)
    follow(tracker, street, range(15))
    values = {"window.width": SIZE[0] - 6.0, "window.height": SIZE[1] - 4.0}
    tracker.reconfigure(from_mapping(variant.parameters, values))
    assert tracker.step(street.frame(15)).mode is not Mode.TRACKING
    estimates = [tracker.step(street.frame(t)) for t in range(16, 40)]
    assert estimates[-1].mode is Mode.TRACKING
    assert error(estimates[-1], street, 39) < 10


@every_particle_filter
def test_reconfiguring_before_the_start_is_allowed(variant):
    tracker = make(variant)
    tracker.reconfigure(from_mapping(variant.parameters, {"num_particles": 33}))
    assert len(tracker.start(Street().frame(0), Street().box(0)).weights) == 33


@every_variant
@pytest.mark.parametrize("hidden", [(10**9, 10**9), (12, 20)])
def test_no_elapsed_times_make_an_estimate_infinite(variant, hidden):
    street, powers = Street(hidden=hidden), np.random.default_rng(0).uniform(-9, 4, 10)
    tracker = make(variant, **few_particles(variant))
    follow(tracker, street, range(8))
    for index, power in enumerate([-9, -9, 4, 4, *powers, -9, 4, -9, 4]):
        estimate = tracker.step(street.frame(8 + index), 10.0**power)
        box = estimate.box
        assert np.isfinite([*estimate.velocity, box.width, box.height, estimate.confidence]).all()
        assert np.isfinite(estimate.weights).all()
        assert inside(estimate)

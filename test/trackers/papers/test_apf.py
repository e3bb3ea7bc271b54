# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""P1, Algorithms 1 and 2, and each of its interpretations."""

import itertools

import numpy as np
import pytest
from street import Street, error, follow

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.papers import apf
from vehicle_pf_tracker.trackers.papers.apf import ApfParameters, ApfTracker
from vehicle_pf_tracker.trackers.papers.shared import (
    LikelihoodParameters,
    MeanVelocity,
    log_likelihood,
)


def make(**values):
    return ApfTracker(from_mapping(ApfParameters, values))


PRINTED_RULE = {"occlusion.rule": "fixed"}
REAL_VIDEO = {"occlusion.rule": "relative"}


def test_likelihood_by_hand_squared_and_as_printed():
    # rho 0.75 is a distance of 0.5: 0.25 / (2 * 0.01) = 12.5, and 0.5 / (2 * 2.25) = 1/9.
    squared = log_likelihood(np.array([0.75, 1.0]), LikelihoodParameters(0.1, True))
    assert squared == pytest.approx([-12.5, 0.0])
    printed = log_likelihood(np.array([0.75, 1.0]), LikelihoodParameters(1.5, False))
    assert printed == pytest.approx([-1 / 9, 0.0])


def test_mean_velocity_by_hand():
    velocity = MeanVelocity(2)
    assert velocity.value == (0.0, 0.0)
    velocity.add((0, 0), (9, 9), 1.0)
    velocity.add((9, 9), (11, 9), 1.0)
    velocity.add((11, 9), (19, 9), 3.0)
    # The last two: 10 px in 4 periods.
    assert velocity.value == pytest.approx((2.5, 0.0))


def test_a_shorter_window_looks_at_the_same_moves():
    velocity = MeanVelocity(4)
    for step in range(1, 5):
        velocity.add((0, 0), (step, 0), 1.0)
    assert velocity.resized(2).value == pytest.approx((3.5, 0.0))
    assert velocity.resized(0).value == pytest.approx((2.5, 0.0))


def test_the_regime_follows_the_similarities_of_the_frame_before():
    # Step 4: regular at t if both similarities at t - 1 are at least tau.
    street = Street(hidden=(15, 22))
    estimates = follow(make(**PRINTED_RULE), street, range(35))
    tau = ApfParameters().occlusion.tau
    for before, now in itertools.pairwise(estimates[1:]):
        clear = min(before.similarities["pi"], before.similarities["pi_up"]) >= tau
        assert now.regime == ("regular" if clear else "occlusion")
        assert now.resampled_particles == (200 if clear else 0)
    assert {"regular", "occlusion"} == {e.regime for e in estimates[1:]}


def test_drifts_at_the_mean_velocity_while_hidden():
    street = Street(speed=3.0, hidden=(20, 35))
    estimates = follow(make(), street, range(45))
    hidden = [error(e, street, t) for t, e in enumerate(estimates) if 22 <= t < 35]
    assert np.median(hidden) < 20
    assert error(estimates[-1], street, 44) < 10


def moved_while_hidden(**values):
    street = Street(speed=3.0, hidden=(20, 999))
    estimates = follow(make(**values), street, range(30))
    return estimates[29].particles[:, 0].mean() - estimates[22].particles[:, 0].mean()


def test_interpretation_11_drift_is_the_velocity_or_the_printed_sigma():
    # Seven steps: at 3 px a frame, or at sqrt(pi / 2) * 6 px a frame.
    assert moved_while_hidden() == pytest.approx(7 * 3.0, rel=0.35)
    fixed = {"motion.drift_from_velocity": False, "motion.sigma_r": 6.0}
    assert moved_while_hidden(**fixed) == pytest.approx(7 * 7.52, rel=0.15)


def test_interpretation_6_the_reference_is_frozen_while_occluded():
    street = Street(speed=0.0, hidden=(10, 30))
    kept = make(**PRINTED_RULE)
    learned = make(**PRINTED_RULE, **{"reference.frozen_while_occluded": False})
    before = []
    for tracker in (kept, learned):
        follow(tracker, street, range(11))
        before.append(tracker.reference.histogram)
        for time in range(11, 25):
            tracker.step(street.frame(time))
    assert np.array_equal(kept.reference.histogram, before[0])
    assert not np.allclose(learned.reference.histogram, before[1], atol=0.05)


def test_interpretation_7_the_blended_histogram_notices_an_occlusion_late():
    street = Street(speed=0.0, hidden=(10, 30))
    raw = follow(make(**PRINTED_RULE), street, range(14))
    values = {"occlusion.raw_histogram": False}
    blended = follow(make(**PRINTED_RULE, **values), street, range(14))
    assert raw[10].similarities["pi"] < 0.5
    assert blended[10].similarities["pi"] > 0.7
    assert min(e.similarities["pi_up"] for e in blended[1:]) > 0.7


def test_interpretation_5_the_origin_counts_as_the_first_position():
    street = Street(speed=0.0)
    printed = make(**{"velocity.from_origin": True, "velocity.window": 0})
    x, y = follow(printed, street, range(2))[-1].velocity
    centre = street.box(0).centre
    assert (x, y) == pytest.approx(centre, abs=6)
    assert follow(make(), street, range(2))[-1].velocity == pytest.approx((0, 0), abs=6)


class Repainted(Street):
    """A vehicle whose lower half is another colour than in the first frame, but for that clear."""

    def frame(self, time):
        frame = super().frame(time).copy()
        if time > 0:
            box = self.box(time)
            x, y = int(box.x), int(box.y)
            frame[y + 11 : y + 16, x : x + 24] = (20, 140, 60)
        return frame


def test_a_lasting_change_of_look_is_an_occlusion_by_the_fixed_rule_alone():
    street = Repainted(speed=2.0)
    fixed = follow(make(**PRINTED_RULE), street, range(30))
    relative = follow(make(**REAL_VIDEO), street, range(30))
    assert {e.regime for e in fixed[2:]} == {"occlusion"}
    assert {e.regime for e in relative[1:]} == {"regular"}
    assert max(e.similarities["pi"] for e in relative[1:]) < ApfParameters().occlusion.tau


def test_the_relative_rule_sees_an_occlusion_and_its_end():
    estimates = follow(make(**REAL_VIDEO), Street(hidden=(25, 33)), range(45))
    regimes = [e.regime for e in estimates]
    # The regime is that of the similarities of the frame before.
    assert set(regimes[26:33]) == {"occlusion"}
    assert set(regimes[1:25]) == set(regimes[-5:]) == {"regular"}


def test_with_the_relative_rule_the_reference_follows_good_frames_only():
    street = Street(speed=0.0, hidden=(15, 30))
    tracker = make(**REAL_VIDEO, **{"reference.steady_alpha": 0.5})
    tracker.start(street.frame(0), street.box(0))
    first = tracker.reference.histogram
    for time in range(1, 15):
        tracker.step(street.frame(time))
    followed = tracker.reference.histogram
    assert not np.array_equal(followed, first)
    for time in range(15, 30):
        tracker.step(street.frame(time))
        assert np.array_equal(tracker.reference.histogram, followed)


@pytest.mark.parametrize("rule", ["relative", "fixed"])
def test_hidden_from_the_first_frame_on_it_is_in_the_occlusion_regime_and_learns_nothing(rule):
    street = Street(speed=0.0, hidden=(1, 16))
    tracker = make(**{"occlusion.rule": rule})
    tracker.start(street.frame(0), street.box(0))
    first = tracker.reference.histogram
    estimates = [tracker.step(street.frame(time)) for time in range(1, 16)]
    assert np.array_equal(tracker.reference.histogram, first)
    estimates += [tracker.step(street.frame(time)) for time in range(16, 24)]
    # The first step is taken with Pi_0 = 1 (step 2), the others with what it measured.
    assert [e.regime for e in estimates[:16]] == ["regular"] + ["occlusion"] * 15
    assert estimates[-1].regime == "regular"
    assert error(estimates[-1], street, 23) < 8


def test_a_similarity_of_tau_itself_is_clear():
    street, tracker = Street(), make(**PRINTED_RULE, **{"occlusion.tau": 1.0})
    # Pi_0 = Pi_0_up = 1 (step 2), and 1 >= 1.
    estimates = follow(tracker, street, range(3))
    assert [e.regime for e in estimates[1:]] == ["regular", "occlusion"]


def test_a_similarity_of_the_limit_itself_lets_the_reference_follow(monkeypatch):
    monkeypatch.setattr(apf, "hellinger_similarity", lambda *_: 0.8)
    values = {"reference.steady_above": 1.0, "reference.steady_alpha": 0.5}
    street, tracker = Street(speed=0.0), make(**REAL_VIDEO, **values)
    follow(tracker, street, range(2))
    before = tracker.reference.histogram
    tracker.step(street.frame(2))  # the clear level is 0.8 by now
    assert not np.array_equal(tracker.reference.histogram, before)


def test_the_first_particles_have_the_spread_of_the_regular_regime():
    street = Street(speed=0.0)
    tracker = make(num_particles=20_000, **{"motion.sigma_w": 4.0})
    particles = tracker.start(street.frame(0), street.box(0)).particles
    assert particles[:, 1].std() == pytest.approx(4.0, rel=0.03)
    assert particles.mean(axis=0) == pytest.approx(street.box(0).centre, abs=0.2)


class Reversing(Street):
    """Drives to the right at 3 px a frame, and in the two frames before it is hidden back."""

    def box(self, time):
        return super().box(time if time < 14 else 13 - 2 * (time - 13))


def test_the_drift_leaves_out_the_newest_displacements():
    def drift(delay):
        values = {"velocity.window": 8, "velocity.delay": delay}
        tracker, street = make(num_particles=4000, **values), Reversing(speed=3.0, hidden=(16, 99))
        follow(tracker, street, range(17))
        estimates = [tracker.step(street.frame(time)) for time in range(17, 19)]
        assert estimates[0].regime == "occlusion"
        before, after = (one.particles[:, 0].mean() for one in estimates)
        return after - before

    assert drift(2) > drift(0) + 1


@pytest.mark.parametrize(("rule", "delay"), [("relative", 12), ("fixed", 0)])
def test_only_the_relative_rule_notices_late_and_delays_the_drift(rule, delay):
    assert from_mapping(ApfParameters, {"occlusion.rule": rule}).drift_delay == delay


def spread_after(elapsed, hidden):
    street = Street(speed=3.0, hidden=(10, 99) if hidden else (99, 99))
    tracker = make(num_particles=4000)
    parents = follow(tracker, street, range(12))[-1].particles
    particles = tracker.step(street.frame(12), elapsed).particles
    return particles, parents


def test_the_drift_scales_with_the_elapsed_time():
    def drift(elapsed):
        particles, parents = spread_after(elapsed, hidden=True)
        return (particles - parents)[:, 0].mean()

    assert drift(4.0) == pytest.approx(4 * drift(1.0), rel=0.1)
    assert drift(1.0) == pytest.approx(3.0, rel=0.3)


def test_one_low_similarity_is_enough_for_the_occlusion_regime():
    """The reference learns a repainted vehicle fast, and then its first colours return."""
    values = {"reference.alpha": 0.5, "reference.frozen_while_occluded": False}
    tracker, there, back = make(**PRINTED_RULE, **values), Repainted(speed=0.0), Street(speed=0.0)
    estimates = follow(tracker, there, range(5))
    estimates += [tracker.step(back.frame(time)) for time in range(5, 11)]
    tau, single = ApfParameters().occlusion.tau, set()
    for before, now in itertools.pairwise(estimates[1:]):
        low = {name for name in ("pi", "pi_up") if before.similarities[name] < tau}
        assert now.regime == ("occlusion" if low else "regular")
        single |= low if len(low) == 1 else set()
    assert single == {"pi", "pi_up"}


def test_new_parameters_keep_the_moves_that_were_seen():
    street, trackers = Street(hidden=(30, 50)), [make(**REAL_VIDEO) for _ in range(2)]
    for tracker in trackers:
        follow(tracker, street, range(30))
    trackers[0].reconfigure(trackers[0].parameters)
    regimes = set()
    for time in range(30, 36):
        after, without = (tracker.step(street.frame(time)) for tracker in trackers)
        assert after.velocity == without.velocity != (0.0, 0.0)
        # Hidden particles drift along the mean without its last 12 moves.
        assert np.array_equal(after.particles, without.particles)
        regimes.add(after.regime)
    assert "occlusion" in regimes


def test_as_printed_the_first_move_begins_in_the_corner():
    street, tracker = Street(), make(as_printed=True)
    first = follow(tracker, street, range(2))[1]
    assert first.velocity == pytest.approx(first.position, abs=1e-9)


@pytest.mark.parametrize(("sigma_r", "drawn"), [(0.0, 6.0), (3.0, 3.0)])
def test_a_sigma_of_zero_is_that_of_the_regular_regime(sigma_r, drawn, monkeypatch):
    sigmas = []

    def still(rng, count, velocity, sigma_r, sigma_n):
        sigmas.append((sigma_r, sigma_n))
        return np.zeros((count, 2))

    monkeypatch.setattr(apf, "sample_normal_rayleigh", still)
    motion = {"sigma_w": 6.0, "sigma_n": 4.0, "sigma_r": sigma_r, "drift_from_velocity": False}
    # Every frame after the first step is one of the occlusion regime.
    values = {**PRINTED_RULE, "occlusion.tau": 1.0}
    tracker = make(**values, **{f"motion.{name}": value for name, value in motion.items()})
    follow(tracker, Street(), range(2))
    assert tracker.step(Street().frame(2), 2.0).regime == "occlusion"
    assert sigmas == [(2 * drawn, 8.0)]

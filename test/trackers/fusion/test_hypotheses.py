# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hypotheses: visibility and weights by hand, and what always holds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses, corrected_velocities
from vehicle_pf_tracker.trackers.fusion.perspective import FASTEST_GROWTH


def hypotheses(visible, weights, positions=None):
    count = len(weights)
    positions = np.zeros((count, 2)) if positions is None else np.array(positions, float)
    return Hypotheses(
        positions, np.zeros((count, 2)), np.zeros(count), np.array(visible), np.array(weights)
    )


def test_visibility_passes_one_frame_by_hand():
    """0.9 * 0.98 + 0.1 * 0.05 = 0.887, and 0.2 * 0.98 + 0.8 * 0.05 = 0.236."""
    passed = hypotheses([0.9, 0.2], [0.5, 0.5]).passed(1.0)
    assert passed.visible == pytest.approx([0.887, 0.236])
    assert passed.weights == pytest.approx([0.5, 0.5])


def test_two_hypotheses_are_weighed_by_hand():
    """Ratio 8 for the first: 0.5 * 8 + 0.5 = 4.5 against 0.8 * 0.25 + 0.2 = 0.4 of the second."""
    observed = hypotheses([0.5, 0.8], [0.25, 0.75]).weighed(np.log([8.0, 0.25]))
    assert observed.visible == pytest.approx([4 / 4.5, 0.2 / 0.4])
    first, second = 0.25 * 4.5, 0.75 * 0.4
    assert observed.weights == pytest.approx([first / (first + second), second / (first + second)])
    assert observed.probability_visible == pytest.approx((0.25 * 4 + 0.75 * 0.2) / (first + second))


def test_the_evidence_of_a_set_is_what_its_weights_are_normalised_by():
    """0.25 * 4.5 + 0.75 * 0.4, and nothing for a vehicle that is surely hidden."""
    log_ratios = np.log([8.0, 0.25])
    assert hypotheses([0.5, 0.8], [0.25, 0.75]).evidence(log_ratios) == pytest.approx(1.425)
    assert hypotheses([0.0, 0.0], [0.25, 0.75]).evidence(log_ratios) == 1.0


def test_evidence_counts_only_for_hypotheses_that_say_visible():
    """A hidden vehicle predicts nothing: its hypothesis keeps its weight relative to others."""
    observed = hypotheses([0.0, 0.0], [0.3, 0.7]).weighed(np.array([5.0, -5.0]))
    assert observed.weights == pytest.approx([0.3, 0.7])
    assert observed.probability_visible == 0


def test_common_evidence_changes_visibility_by_hand_and_no_weight():
    """Even odds times 3 are 0.75; odds of 1 to 4 times 3 are 3 to 4."""
    weighed = hypotheses([0.5, 0.2], [0.4, 0.6]).weighed_alike(np.log(3.0))
    assert weighed.visible == pytest.approx([0.75, 3 / 7])
    assert weighed.weights == pytest.approx([0.4, 0.6])


def test_mean_and_spread_by_hand():
    apart = hypotheses([0.5, 1.0], [0.25, 0.75], [(0, 10), (8, 10)])
    assert apart.mean == pytest.approx([6, 10])
    assert apart.spread == pytest.approx(np.sqrt(0.25 * 36 + 0.75 * 4))
    assert apart.probability_visible == pytest.approx(0.875)


def test_driving_without_noise_by_hand():
    """At a growth of 0.02 the velocity grows by exp(0.04 * 2) in two frames, the growth by 4 %."""
    rng = np.random.default_rng(0)
    start = Hypotheses.around(
        np.array([[10.0, 20.0]]), np.array([[3.0, -1.0]]), np.array([0.02]), 0.9
    )
    predicted = start.predicted(rng, 2.0, (0.0, 0.0), 1.0)
    velocity = np.exp(0.08) * np.array([3.0, -1.0])
    assert predicted.velocities[0] == pytest.approx(velocity)
    assert predicted.positions[0] == pytest.approx(np.array([10, 20]) + 2 * velocity)
    assert predicted.growths == pytest.approx([0.02 * 1.04])
    assert predicted.visible == pytest.approx([0.9])


def test_noise_of_driving_has_the_deviations_asked_for():
    count = 20_000
    still = Hypotheses.around(np.zeros((count, 2)), np.zeros((count, 2)), np.zeros(count), 0.5)
    predicted = still.predicted(np.random.default_rng(0), 4.0, (3.0, 0.5), 1.0)
    assert predicted.velocities.std(axis=0) == pytest.approx([1.0, 1.0], rel=0.03)
    # Positions vary by their own noise, 3 * 2, and by the velocity's, 4 * 1.
    assert predicted.positions.std(axis=0) == pytest.approx(np.hypot([6.0, 6.0], 4.0), rel=0.03)


def test_noise_that_keeps_the_mean_moves_single_hypotheses_only():
    still = hypotheses([0.0] * 50, [0.02] * 50)
    moved = still.predicted(np.random.default_rng(0), 1.0, (0.0, 2.0), 0.3, keeps_mean=True)
    assert moved.mean_velocity == pytest.approx(still.mean_velocity)
    assert moved.velocities.std(axis=0).min() > 1


@pytest.mark.parametrize(("visible", "share"), [(0.0, 0.0), (1.0, 1.0)])
def test_hidden_hypotheses_climb_around_their_mean(visible, share):
    before = hypotheses([visible] * 2, [0.5, 0.5], [[0.0, 0.0], [10.0, 0.0]])
    better = np.array([[4.0, 0.0], [10.0, 2.0]])
    after = before.climbed(better, np.zeros(2), keeps_mean=True)
    assert after.mean == pytest.approx(before.mean + share * np.array([2.0, 1.0]))
    assert before.climbed(better, np.zeros(2), keeps_mean=False).positions == pytest.approx(better)


@pytest.mark.parametrize(
    ("moved", "elapsed", "after"),
    # From (4, 0) by a gain of a half: 8 px a period; 16 px in two; 3 px in half a period, in which
    # 2 were predicted; and 4 px in no time, in which none were.
    [(8.0, 1.0, 6.0), (16.0, 2.0, 6.0), (3.0, 0.5, 4.5), (4.0, 0.0, 6.0)],
)
def test_a_velocity_takes_on_a_displacement_by_hand(moved, elapsed, after):
    velocities = np.array([[4.0, 0.0]])
    corrected = corrected_velocities(velocities, np.array([moved, 0.0]), elapsed, 0.5)
    assert corrected == pytest.approx(np.array([[after, 0.0]]))


def test_two_images_of_one_stamp_keep_about_the_velocity():
    """Of 6 px a period, 3 an image: v + 0.9 = w, and 0.7 w + 0.9 = v, so that v is 5.1 and w 6."""
    velocity = np.array([4.0, 0.0])
    for elapsed in 40 * [0.0, 1.0]:
        velocity = corrected_velocities(velocity, np.array([3.0, 0.0]), elapsed, 0.3)
    assert velocity == pytest.approx([5.1, 0.0], abs=1e-4)


def test_resampling_waits_until_few_carry_the_weight():
    rng = np.random.default_rng(0)
    even = hypotheses([0.5] * 4, [0.25] * 4)
    assert even.resampled(rng, 4) is even
    uneven = hypotheses([0.1, 0.2, 0.3, 0.4], [0.0, 1.0, 0.0, 0.0], np.arange(8).reshape(4, 2))
    again = uneven.resampled(rng, 4)
    assert again.visible == pytest.approx([0.2] * 4)
    assert again.positions == pytest.approx(np.array([[2, 3]] * 4))
    assert again.weights == pytest.approx([0.25] * 4)


@pytest.mark.parametrize("count", [1, 3, 50])
def test_another_number_of_hypotheses_keeps_the_mean(count):
    many = hypotheses([0.5] * 40, [1 / 40] * 40, np.tile([7.0, 9.0], (40, 1)))
    other = many.resampled(np.random.default_rng(1), count)
    assert other.weights == pytest.approx([1 / count] * count)
    assert other.mean == pytest.approx([7, 9])


unit = st.floats(0, 1)
sets = st.integers(1, 12).flatmap(
    lambda count: st.tuples(
        st.lists(unit, min_size=count, max_size=count),
        st.lists(st.floats(0.01, 1), min_size=count, max_size=count),
        st.lists(st.floats(-6, 6), min_size=count, max_size=count),
        st.lists(st.floats(-0.04, 0.04), min_size=count, max_size=count),
    )
)


@given(
    sets=sets, elapsed=st.floats(0, 30), witness=st.floats(-50, 50), seed=st.integers(0, 99),
    count=st.integers(1, 30),
)  # fmt: skip
def test_weights_stay_normalised_and_probabilities_within_bounds(
    sets, elapsed, witness, seed, count
):
    visible, weights, ratios, growths = (np.array(values) for values in sets)
    rng, size = np.random.default_rng(seed), len(weights)
    one = Hypotheses(
        rng.normal(0, 50, (size, 2)), rng.normal(0, 5, (size, 2)), growths, visible,
        weights / weights.sum(),
    )  # fmt: skip
    one = one.predicted(rng, elapsed, (2.0, 1.0), 1.0).passed(elapsed)
    one = one.weighed(ratios).weighed_alike(witness).resampled(rng, count)
    assert one.weights.sum() == pytest.approx(1)
    assert (one.weights >= 0).all()
    assert ((one.visible >= 0) & (one.visible <= 1)).all()
    assert -1e-12 <= one.probability_visible <= 1 + 1e-12
    assert np.abs(one.growths).max() <= FASTEST_GROWTH
    assert np.isfinite(one.positions).all()
    assert len(one.weights) == len(one.positions) == len(one.visible)
    assert len(one.weights) == count

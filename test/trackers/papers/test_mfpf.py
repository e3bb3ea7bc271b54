# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""P2: the fused and the single-feature filters, and each of their interpretations."""

import itertools

import numpy as np
import pytest
from street import WIDTH, Street, error, follow

from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.image.windows.gradients import GradientDirections
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.evidence import EvidenceJudge
from vehicle_pf_tracker.trackers.papers import mfpf
from vehicle_pf_tracker.trackers.papers.feature_weighting import weigh_features
from vehicle_pf_tracker.trackers.papers.mfpf import MfpfTracker
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    MfpfParameters,
)
from vehicle_pf_tracker.trackers.papers.sfpf import (
    SfpfColorParameters,
)
from vehicle_pf_tracker.trackers.registry import VARIANTS

NAMES = ("color", "edge", "texture")
SINGLE = VARIANTS["sfpf_color"]


def make(**values):
    return MfpfTracker(from_mapping(MfpfParameters, values))


def spread(estimate):
    """Largest distance of a particle from the estimate, in px."""
    return np.hypot(*(estimate.particles - estimate.position).T).max()


def test_confidences_are_one_in_the_first_frame_after_the_start():
    first = follow(make(), Street(), range(2))[1].similarities
    assert [first[f"lc_{name}"] for name in NAMES] == pytest.approx([1.0] * 3)
    assert [first[f"wf_{name}"] for name in NAMES] == pytest.approx([1 / 3] * 3)


def test_the_first_search_and_predictions_reach_twice_as_far():
    street = Street(speed=0.0, hidden=(10, 30))
    tracker = make(**{"dispersion.growth": 0.0})
    estimates = follow(tracker, street, range(20))
    assert np.hypot(*(estimates[0].particles - street.box(0).centre).T).max() <= 28
    assert spread(estimates[1]) > 20
    predicted = [e for e in estimates if e.regime == "prediction"]
    assert len(predicted) == 10
    for estimate in predicted[1:]:
        assert 24 < spread(estimate) <= 28 + 1e-9


def test_the_search_grows_in_prediction_mode_up_to_its_limit():
    street = Street(speed=0.0, hidden=(10, 60))
    tracker = make(**{"dispersion.growth": 2.0, "dispersion.largest": 40.0})
    estimates = follow(tracker, street, range(30))
    assert [e.regime for e in estimates[10:]] == ["prediction"] * 20
    # Twice 14 px, and 2 px more for each frame of prediction before; the street is 120 px high.
    assert 28 < spread(estimates[13]) <= 28 + 6
    assert 36 < spread(estimates[29]) <= 40 + 1e-9


def test_predicts_with_the_last_increments_and_leaves_the_references_alone():
    street = Street(speed=3.0, hidden=(20, 35))
    tracker = make()
    estimates = follow(tracker, street, range(21))
    assert estimates[20].regime == "prediction"
    kept, velocity = [one.histogram for one in tracker.references], estimates[20].velocity
    for time in range(21, 30):
        estimate = tracker.step(street.frame(time))
        assert estimate.regime == "prediction"
        assert estimate.velocity == velocity
        assert error(estimate, street, time) < 12
    assert all(
        np.array_equal(a, b.histogram) for a, b in zip(kept, tracker.references, strict=True)
    )
    estimates = [tracker.step(street.frame(time)) for time in range(30, 45)]
    assert estimates[-1].regime == "estimation"
    assert error(estimates[-1], street, 44) < 6


def test_interpretation_15_the_reference_is_the_first_histogram_and_the_last_one():
    street = Street()
    for weight in (1.0, 0.25):
        tracker = make(reference_weight=weight)
        tracker.start(street.frame(0), street.box(0))
        first = [reference.histogram for reference in tracker.references]
        for time in range(1, 5):
            estimate = tracker.step(street.frame(time))
        at = np.array([estimate.position])
        for kind, began, reference in zip(
            tracker.features.values(), first, tracker.references, strict=True
        ):
            last = kind.histograms(street.frame(4), at, tracker.window)[0]
            assert reference.histogram == pytest.approx(weight * began + (1 - weight) * last)


def test_interpretation_16_resamples_below_a_share_of_the_particles():
    street = Street()
    for share in (0.0, 0.5, 1.0):
        estimates = follow(make(resample_below=share), street, range(12))
        for before, now in itertools.pairwise(estimates[1:]):
            below = before.effective_sample_size < share * 200
            assert now.resampling_passes == int(below)
            assert now.resampled_particles == (200 if below else 0)


def test_interpretation_17_the_best_particle_or_the_mean():
    best = follow(make(estimate="best"), Street(), range(8))[-1]
    distance = np.hypot(*(best.particles - best.position).T)
    # With one feature the estimate is a particle itself; with three it lies among their best.
    assert distance.min() < 3
    single = VARIANTS["sfpf_color"]
    tracker = single.tracker(SfpfColorParameters(estimate="best"))
    estimate = follow(tracker, Street(), range(8))[-1]
    assert np.hypot(*(estimate.particles - estimate.position).T).min() < 1e-9


def test_a_feature_changed_while_hidden_is_rebuilt_from_the_first_frame():
    street, tracker = Street(speed=0.0, hidden=(10, 20)), make()
    follow(tracker, street, range(15))
    changed = from_mapping(MfpfParameters, {"texture": "lbp", "edges.threshold": 0.5})
    tracker.reconfigure(changed)
    assert tracker.features["edge"] == GradientDirections(0.5, floor=40.0)
    estimates = [tracker.step(street.frame(time)) for time in range(15, 35)]
    assert estimates[0].regime == "prediction"
    assert error(estimates[-1], street, 34) < 8


def test_weights_are_the_earlier_ones_times_the_likelihoods_of_the_features_in_use():
    tracker = make(num_particles=50, resample_below=0.0)
    street = Street()
    estimates = follow(tracker, street, range(3))
    references = list(tracker.references)
    estimate = tracker.step(street.frame(3))
    particles, before = estimate.particles, estimates[-1].weights
    expected = np.log(before)
    for feature, reference in zip(tracker.features.values(), references, strict=True):
        rho = feature.similarity(street.frame(3), particles, tracker.window, reference)
        expected = expected - (1 - rho) / (2 * 0.1**2)
    weights = np.exp(expected - expected.max())
    assert estimate.weights == pytest.approx(weights / weights.sum(), rel=1e-3, abs=1e-9)


def test_interpretation_34_as_printed_the_reference_is_one_frame_older():
    street = Street()
    tracker = make(delayed_reference=True, reference_weight=0.25)
    tracker.start(street.frame(0), street.box(0))
    first = [reference.histogram for reference in tracker.references]
    estimates = [tracker.step(street.frame(time)) for time in range(1, 5)]
    at = np.array([estimates[-2].position])
    for kind, began, reference in zip(
        tracker.features.values(), first, tracker.references, strict=True
    ):
        before = kind.histograms(street.frame(3), at, tracker.window)[0]
        assert reference.histogram == pytest.approx(0.25 * began + 0.75 * before)


@pytest.mark.parametrize("recursion", [True, False])
def test_interpretation_35_without_recursion_the_present_frame_alone_counts(recursion):
    settings = {"num_particles": 50, "resample_below": 0.0, "weight_recursion": recursion}
    tracker = SINGLE.tracker(from_mapping(SfpfColorParameters, settings))
    street = Street()
    before = follow(tracker, street, range(3))[-1].weights
    reference = tracker.references[0]
    estimate = tracker.step(street.frame(3))
    feature = tracker.features["color"]
    rho = feature.similarity(street.frame(3), estimate.particles, tracker.window, reference)
    logs = (np.log(before) if recursion else 0.0) - (1 - rho) / (2 * 0.1**2)
    weights = np.exp(logs - logs.max())
    assert estimate.weights == pytest.approx(weights / weights.sum(), rel=1e-3, abs=1e-9)


def test_interpretation_32_the_basic_filter_searches_no_wider_and_never_predicts():
    street = Street(speed=0.0, hidden=(10, 30))
    runs = {}
    for extended in (True, False):
        tracker = SINGLE.tracker(from_mapping(SfpfColorParameters, {"extended": extended}))
        runs[extended] = follow(tracker, street, range(20))
    start = street.box(0).centre
    reach = {e: np.hypot(*(run[0].particles - start).T).max() for e, run in runs.items()}
    assert reach[True] > 20
    assert reach[False] <= 14
    assert {e.regime for e in runs[True][10:]} == {"prediction"}
    assert {e.regime for e in runs[False][1:]} == {"estimation"}
    # What it sees where the vehicle was becomes a part of its reference.
    assert runs[False][-1].similarities["used_color"] == 1.0


def test_each_features_own_weights_have_the_earlier_ones_as_a_factor():
    tracker, street = make(num_particles=2), Street()
    tracker.start(street.frame(0), street.box(0))
    particles, prior = np.zeros((2, 2)), np.array([0.75, 0.25])
    # Of sigma_v 0.1: coefficients 0.02 ln 3 apart have weights 1 : 3, and the same ones 1 : 1.
    far = 0.9 + 0.02 * np.log(3)
    rho = np.array([[0.9, 0.9], [0.9, far], [far, 0.9]])
    weighting = weigh_features(np.ones(3), np.ones(3), 0.5)
    weights, cloud = tracker.weigh(particles, prior, rho, weighting)
    assert weights == pytest.approx(np.array([[0.75, 0.25], [0.5, 0.5], [0.9, 0.1]]))
    assert cloud.weights == pytest.approx([0.75, 0.25])  # 1 : 3 and 3 : 1 cancel


def test_the_evidence_is_the_median_of_the_features(monkeypatch):
    judged, judge = [], EvidenceJudge.judge
    monkeypatch.setattr(
        EvidenceJudge,
        "judge",
        lambda self, evidence, *a, **k: judged.append(evidence) or judge(self, evidence, *a, **k),
    )
    similarities = iter([0.9, 0.2, 0.5])
    tracker, street = make(), Street()
    follow(tracker, street, range(3))
    monkeypatch.setattr(mfpf, "hellinger_similarity", lambda *_: next(similarities))
    tracker.step(street.frame(3))
    assert judged[-1] == 0.5


def test_the_search_grows_by_time_not_by_frames():
    values = {"num_particles": 2000, "confidence.threshold": 1.0, "dispersion.growth": 5.0}
    street = Street(speed=0.0, hidden=(5, 99))

    def reach(steps):
        tracker = make(**values)
        follow(tracker, street, range(6))
        before = spread(tracker.step(street.frame(6)))
        for elapsed in steps:
            tracker.step(street.frame(7), elapsed)
        return spread(tracker.step(street.frame(8))) - before

    assert reach([3.0]) == pytest.approx(reach([1.0] * 3), abs=0.7)
    assert reach([3.0]) == pytest.approx(20.0, abs=1.0)


def started(**values):
    street, tracker = Street(speed=0.0), make(**values)
    tracker.start(street.frame(0), street.box(0))
    return street, tracker


def test_gaussian_noise_has_the_variance_of_the_disc(monkeypatch):
    sigmas, draw = [], mfpf.sample_normal
    monkeypatch.setattr(
        mfpf,
        "sample_normal",
        lambda rng, n, sigma: sigmas.append((n, sigma)) or draw(rng, n, sigma),
    )
    started(**{"dispersion.noise": "gaussian", "dispersion.radius": 3.0})
    # The first search reaches twice as far, and a disc's deviation is half of its radius.
    assert sigmas[0] == (200, 3.0)


def test_a_search_reaches_further_in_a_longer_time(monkeypatch):
    radii, draw = [], mfpf.sample_disc
    monkeypatch.setattr(
        mfpf, "sample_disc", lambda rng, n, radius: radii.append(radius) or draw(rng, n, radius)
    )
    street, tracker = started(**{"dispersion.radius": 14.0, "dispersion.growth": 2.0})
    tracker.step(street.frame(1), 2.0)
    assert radii[-1] == pytest.approx(56.0)
    empty = Street(hidden=(0, 99))
    assert tracker.step(empty.frame(2), 3.0).regime == "prediction"
    tracker.step(empty.frame(3), 1.0)
    assert radii[-1] == pytest.approx(34.0)


def test_noise_is_added_to_the_move(monkeypatch):
    monkeypatch.setattr(mfpf, "sample_disc", lambda *_: np.full((200, 2), (3.0, -2.0)))
    street, tracker = started()
    particles = tracker.step(street.frame(1)).particles
    assert particles == pytest.approx(np.tile(np.add(street.box(0).centre, (3.0, -2.0)), (200, 1)))


@pytest.mark.parametrize("left", [True, False])
def test_the_image_is_left_where_the_particles_leave_it(left, monkeypatch):
    # Towards the near border by half the image, or not at all.
    moved = -0.5 * WIDTH if left else 0.0
    _, tracker = started()
    monkeypatch.setattr(mfpf, "sample_disc", lambda *_: np.full((200, 2), (moved, 0.0)))
    estimate = tracker.step(Street(hidden=(0, 99)).frame(1))
    assert estimate.mode is (Mode.LOST if left else Mode.OCCLUDED)


def test_as_printed_each_feature_draws_its_own_survivors(monkeypatch):
    asked = []
    monkeypatch.setattr(
        mfpf,
        "common_survivors",
        lambda sets, count, otherwise: asked.append((len(sets), count)) or otherwise,
    )
    street, tracker = started(joint_resampling=False, resample_below=1.0, resampling="systematic")
    draws, draw = [], RESAMPLING_SCHEMES["systematic"]
    monkeypatch.setitem(
        RESAMPLING_SCHEMES, "systematic", lambda *words: draws.append(words[0]) or draw(*words)
    )
    weigh, weighed = tracker.weigh, []
    tracker.weigh = lambda *words: weighed.append(weigh(*words)) or weighed[-1]
    tracker.step(street.frame(1))
    assert asked == [(3, 200)]
    own, cloud = weighed[0]
    for weights, expected in zip(draws, (cloud.weights, *own), strict=True):
        assert np.array_equal(weights, expected)

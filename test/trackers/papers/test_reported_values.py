# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values that an estimate reports, taken again from the frame by the papers' equations."""

import numpy as np
import pytest
from street import Street, follow

from vehicle_pf_tracker.image.windows.colour import JointColour
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import find_variant

LAST = 6


def run(name, **values):
    """Follow the street for some frames; returns the tracker and its estimates."""
    variant = find_variant(name)
    tracker = variant.tracker(from_mapping(variant.parameters, values))
    return tracker, follow(tracker, Street(), range(LAST + 1))


def similarity(first, second):
    """One less the Hellinger distance, P1 eq. 23 and 24."""
    return 1 - np.sqrt(max(1 - np.sqrt(first * second).sum(), 0.0))


def test_apf_compares_the_window_with_the_first_and_the_last_reference():
    tracker, _ = run("apf", **{"occlusion.rule": "fixed", "reference.alpha": 0.25})
    first = tracker.target.joint_histogram(tracker.window, 3)
    last = tracker.reference.histogram
    frame = Street().frame(LAST + 1)
    estimate = tracker.step(frame)
    seen = tracker.kernels.histogram(JointColour(3), frame, estimate.position, tracker.window)
    assert estimate.regime == "regular"
    assert (estimate.resampling_passes, estimate.resampled_particles) == (1, 200)
    assert estimate.similarities == pytest.approx(
        {"pi": similarity(seen, first), "pi_up": similarity(seen, last)}
    )
    # Step 15.
    assert tracker.reference.histogram == pytest.approx(0.25 * seen + 0.75 * last)


def test_apf_as_printed_compares_the_blend():
    values = {"occlusion.rule": "fixed", "reference.alpha": 0.25, "occlusion.raw_histogram": False}
    tracker, _ = run("apf", **values)
    first = tracker.target.joint_histogram(tracker.window, 3)
    last = tracker.reference.histogram
    frame = Street().frame(LAST + 1)
    estimate = tracker.step(frame)
    seen = tracker.kernels.histogram(JointColour(3), frame, estimate.position, tracker.window)
    blend = 0.25 * seen + 0.75 * last
    assert estimate.similarities == pytest.approx(
        {"pi": similarity(blend, first), "pi_up": similarity(blend, last)}
    )


def test_mfpf_averages_the_best_tenth_of_the_particles():
    tracker, estimates = run("mfpf", num_particles=50)
    initial = np.array([estimates[1].similarities[f"as_{name}"] for name in tracker.features])
    references = list(tracker.references)
    frame = Street().frame(LAST + 1)
    estimate = tracker.step(frame)
    # Eq. 16: five of 50.
    averages = np.array(
        [
            np.sort(1 - np.sqrt(1 - rho))[-5:].mean()
            for feature, reference in zip(tracker.features.values(), references, strict=True)
            for rho in [feature.similarity(frame, estimate.particles, tracker.window, reference)]
        ]
    )
    confidences = averages / initial
    expected = {"as": averages, "lc": confidences, "wf": confidences / confidences.sum()}
    for column, values in expected.items():
        found = [estimate.similarities[f"{column}_{name}"] for name in tracker.features]
        assert found == pytest.approx(values, rel=1e-3), column
    assert [estimate.similarities[f"used_{name}"] for name in tracker.features] == [1.0] * 3
    assert estimate.regime == "estimation"


@pytest.mark.parametrize("name", ["pf", "pfcl", "sapf", "hpfms", "ms"])
def test_the_rivals_report_the_similarity_at_their_estimate(name):
    tracker, estimates = run(name)
    estimate = estimates[-1]
    frame = Street().frame(LAST)
    if name in ("hpfms", "ms"):
        position = np.array([estimate.position])
        window, reference = tracker.window, tracker.target.kernel_reference(tracker.window, 3)
        rho = tracker.kernels.kernel_similarity(frame, position, window, reference, 3)
        expected = 1 - np.sqrt(1 - rho[0])
    else:
        seen = tracker.kernels.histogram(JointColour(3), frame, estimate.position, tracker.window)
        expected = similarity(seen, tracker.target.joint_histogram(tracker.window, 3))
    assert estimate.similarities == pytest.approx({"pi": expected}, abs=1e-6)
    assert estimate.regime == "regular"
    # Fewer than eight moves: all count.
    moved = np.subtract(estimate.position, estimates[0].position) / LAST
    assert estimate.velocity == pytest.approx(tuple(moved))


@pytest.mark.parametrize("name", ["conventional", "adaptive"])
def test_p3_reports_its_best_particle_too(name):
    tracker, estimates = run(name)
    rho = tracker.similarity(Street().frame(LAST), estimates[-1].particles)
    assert estimates[-1].similarities["best"] == pytest.approx(1 - np.sqrt(1 - rho.max()), abs=1e-6)

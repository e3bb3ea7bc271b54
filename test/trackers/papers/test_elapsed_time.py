# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Spreads and speeds are per nominal period, so that a dropped frame changes neither."""

import copy

import pytest
from street import Street, follow

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import find_variant

# Flat weights: resampling and weighting leave the cloud as wide as the diffusion makes it.
FLAT = {"likelihood.sigma_v": 100.0, "num_particles": 4000}
FEATURES = {**FLAT, "dispersion.radius": 6.0, "confidence.threshold": 0.0}
DIFFUSIONS = {
    "apf": {**FLAT, "motion.sigma_w": 3.0, "occlusion.rule": "fixed", "occlusion.tau": 0.0},
    "pf": {**FLAT, "sigma": 3.0},
    "sapf": {**FLAT, "sigma": 3.0, "annealing.layers": 1},
    "hpfms": {**FLAT, "sigma": 3.0, "iterations": 0, "transition.widest": 1.0},
    "pfcl": {**FLAT, "sigma": 3.0, "lines.sigma_v": 100.0},
    "conventional": {**FLAT, "sigma": 3.0},
    "adaptive": {**FLAT, "sigma": 3.0},
    "mfpf": FEATURES,
    "sfpf_color": FEATURES,
    "sfpf_edge": FEATURES,
    "sfpf_texture": FEATURES,
}


def make(name, **values):
    variant = find_variant(name)
    return variant.tracker(from_mapping(variant.parameters, values))


def variance(estimate):
    return float(estimate.particles.var(axis=0).mean())


@pytest.mark.parametrize("name", DIFFUSIONS)
def test_particles_spread_by_the_elapsed_time(name):
    # A Normal density of sigma 3 and a disc of radius 6 both add 9 px² in one period.
    street = Street(speed=0.0)
    tracker = make(name, **DIFFUSIONS[name])
    before = variance(follow(tracker, street, range(2))[-1])
    for elapsed in (1.0, 2.0):
        after = copy.deepcopy(tracker).step(street.frame(2), elapsed)
        added = variance(after) - before
        assert added == pytest.approx(9.0 * elapsed**2, rel=0.25)

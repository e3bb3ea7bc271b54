# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Equations 7 to 22 of P1, read with interpretations 2 to 4."""

import math

import numpy as np
import pytest

from vehicle_pf_tracker.filtering.motion import (
    DISC_SIGMA,
    sample_disc,
    sample_normal,
    sample_normal_rayleigh,
)

DRAWS = 200_000


def normal_rayleigh_pdf(along, across, sigma_r, sigma_n):
    """Equations 11 and 12: Rayleigh (eq. 9) along the motion, Normal across it."""
    k1 = np.maximum(along, 0.0)
    along_pdf = k1 / sigma_r**2 * np.exp(-0.5 * np.square(k1 / sigma_r))
    across_pdf = np.exp(-0.5 * np.square(across / sigma_n)) / (math.sqrt(2 * math.pi) * sigma_n)
    return along_pdf * across_pdf


def test_normal_sampler_has_the_moments_of_equation_7():
    moves = sample_normal(np.random.default_rng(0), DRAWS, 3.0)
    assert moves.shape == (DRAWS, 2)
    assert np.abs(moves.mean(axis=0)).max() < 5 * 3.0 / math.sqrt(DRAWS)
    assert np.cov(moves.T) == pytest.approx(np.diag([9.0, 9.0]), abs=0.15)


@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.0, 2.0), (-3.0, 4.0)])
def test_normal_rayleigh_sampler_has_the_moments_of_equations_9_to_12(direction):
    sigma_r, sigma_n = 2.0, 5.0
    rng = np.random.default_rng(1)
    moves = sample_normal_rayleigh(rng, DRAWS, direction, sigma_r, sigma_n)
    unit = np.array(direction) / np.hypot(*direction)
    along, across = moves @ unit, moves @ np.array([-unit[1], unit[0]])
    assert along.min() >= -1e-9, "nothing drifts against the motion"
    assert along.mean() == pytest.approx(math.sqrt(math.pi / 2) * sigma_r, abs=0.02)
    assert along.var() == pytest.approx((2 - math.pi / 2) * sigma_r**2, rel=0.03)
    assert across.mean() == pytest.approx(0.0, abs=5 * sigma_n / math.sqrt(DRAWS))
    assert across.var() == pytest.approx(sigma_n**2, rel=0.03)


def test_sampler_draws_from_the_density():
    rng = np.random.default_rng(2)
    moves = sample_normal_rayleigh(rng, DRAWS, (1.0, 0.0), 2.0, 3.0)
    counts, edges_x, edges_y = np.histogram2d(
        moves[:, 0], moves[:, 1], bins=(20, 20), range=((0, 8), (-9, 9))
    )
    middle_x, middle_y = (edges_x[1:] + edges_x[:-1]) / 2, (edges_y[1:] + edges_y[:-1]) / 2
    along, across = np.meshgrid(middle_x, middle_y, indexing="ij")
    area = (edges_x[1] - edges_x[0]) * (edges_y[1] - edges_y[0])
    expected = normal_rayleigh_pdf(along, across, 2.0, 3.0) * area * DRAWS
    well_filled = expected > 100
    assert counts[well_filled] == pytest.approx(expected[well_filled], rel=0.35)
    assert counts.sum() == pytest.approx(expected.sum(), rel=0.01)


def test_without_a_direction_the_drift_goes_everywhere():
    moves = sample_normal_rayleigh(np.random.default_rng(4), 50_000, (0.0, 0.0), 2.0, 1.0)
    assert np.abs(moves.mean(axis=0)).max() < 0.06
    assert np.hypot(*moves.T).mean() > 2.0


def test_disc_is_filled_evenly():
    distance = np.hypot(*sample_disc(np.random.default_rng(7), DRAWS, 10.0).T)
    assert distance.max() <= 10.0
    # Half of the area lies within 10 / sqrt(2); the mean distance is two thirds of the radius.
    assert np.mean(distance < 10.0 / math.sqrt(2)) == pytest.approx(0.5, abs=0.005)
    assert distance.mean() == pytest.approx(20 / 3, rel=0.005)


def test_a_gaussian_of_the_discs_variance_has_half_of_its_radius_as_deviation():
    # The mean of r² over a disc of radius 10 is 50, and each axis has half of it: 25.
    moves = sample_disc(np.random.default_rng(9), DRAWS, 10.0)
    assert moves.std(axis=0) == pytest.approx([5.0, 5.0], rel=0.01)
    assert 10.0 * DISC_SIGMA == 5.0


def test_disc_of_no_radius_is_its_middle():
    assert not sample_disc(np.random.default_rng(8), 3, 0.0).any()

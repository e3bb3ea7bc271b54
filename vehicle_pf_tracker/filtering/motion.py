# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Samplers of motion densities: those of P1, section III, and the disc in place of P2's noise.

Equations are numbered as in P1. The printed norms of its equations 10 and 12 make no densities, and
equation 20 loses a term; interpretations 2 to 4 correct them.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array

RAYLEIGH_MEAN = float(np.sqrt(np.pi / 2))
"""Mean of a Rayleigh variable in units of its parameter."""
DISC_SIGMA = 0.5
"""Standard deviation along one axis of a point drawn evenly from a disc of radius 1: the mean of r²
is 1/2, and each axis has half of it."""


def sample_normal(rng: np.random.Generator, count: int, sigma: float) -> Array:
    """Draw `count` displacements from equation 7, shape (count, 2), in px."""
    return np.asarray(sigma * rng.standard_normal((count, 2)))


def sample_normal_rayleigh(
    rng: np.random.Generator,
    count: int,
    direction: tuple[float, float],
    sigma_r: float,
    sigma_n: float,
) -> Array:
    """Draw displacements that drift along `direction` (eq. 11, 13 and 14).

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of randomness.
    count : int
        Number of displacements.
    direction : (float, float)
        Principal motion direction k1 of any length; where it is zero there is no direction to
        drift in, and each particle takes a random one.
    sigma_r, sigma_n : float
        Rayleigh parameter along, and Normal standard deviation across the motion, in px.

    Returns
    -------
    (count, 2) array
        Displacements x', y' in px.
    """
    # Unit draws times sigma: the numbers drawn do not depend on the parameters.
    along = rng.rayleigh(1.0, count) * sigma_r
    across = rng.standard_normal(count) * sigma_n
    length = float(np.hypot(*direction))
    if length > 0:
        # One direction for all: equation 11 rotates by the angle of k1, whose length says nothing.
        cosine = np.full(count, direction[0] / length)
        sine = np.full(count, direction[1] / length)
    else:
        # At a standstill a common direction would push the whole cloud off to one side.
        angle = rng.uniform(0.0, 2 * np.pi, count)
        cosine = np.cos(angle)
        sine = np.sin(angle)
    return np.column_stack([along * cosine - across * sine, along * sine + across * cosine])


def sample_disc(rng: np.random.Generator, count: int, radius: float) -> Array:
    """Draw `count` displacements evenly from a disc of `radius` px, shape (count, 2), in px.

    It stands for the Gaussian of P2's equation 5, and bounds the search (interpretation 25).
    """
    angle = rng.uniform(0.0, 2 * np.pi, count)
    # The root makes every area as likely as any other.
    distance = radius * np.sqrt(rng.random(count))
    return np.column_stack([distance * np.cos(angle), distance * np.sin(angle)])

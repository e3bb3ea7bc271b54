"""Motion densities of P1, section III, and samplers that draw from them.

Equations are numbered as in the paper and read with READINGS 2 to 4 (the printed norms of
equations 10 and 12 are no densities, and equation 20 loses a term).
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array

RAYLEIGH_MEAN = float(np.sqrt(np.pi / 2))
"""Mean of a Rayleigh variable in units of its parameter."""


def normal_pdf(displacement: Array, sigma: float) -> Array:
    """Bivariate Normal density without correlation (eq. 7).

    Parameters
    ----------
    displacement : (..., 2) array
        x' and y' of equation 8, in px.
    sigma : float
        Standard deviation in px.

    Returns
    -------
    (...) array
        Density per px².
    """
    squared = np.sum(np.square(displacement), axis=-1)
    return np.asarray(np.exp(-0.5 * squared / sigma**2) / (2 * np.pi * sigma**2))


def rayleigh_pdf(along: Array, sigma_r: float) -> Array:
    """Rayleigh density along the motion (eq. 9); zero for `along` below zero."""
    k1 = np.maximum(along, 0.0)
    return np.asarray(k1 / sigma_r**2 * np.exp(-0.5 * np.square(k1 / sigma_r)))


def normal_rayleigh_pdf(along: Array, across: Array, sigma_r: float, sigma_n: float) -> Array:
    """Joint Normal-Rayleigh density (eq. 11 and 12, READINGS 2 and 3).

    Parameters
    ----------
    along, across : arrays of one shape
        Displacement k1 along and k2 across the principal motion direction, in px.
    sigma_r, sigma_n : float
        Rayleigh parameter along, and Normal standard deviation across the motion, in px.

    Returns
    -------
    array
        Density per px².
    """
    across_pdf = np.exp(-0.5 * np.square(across / sigma_n)) / (np.sqrt(2 * np.pi) * sigma_n)
    return np.asarray(rayleigh_pdf(along, sigma_r) * across_pdf)


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
        As in `normal_rayleigh_pdf`.

    Returns
    -------
    (count, 2) array
        Displacements x', y' in px.
    """
    along = rng.rayleigh(1.0, count) * sigma_r
    across = rng.standard_normal(count) * sigma_n
    length = float(np.hypot(*direction))
    if length > 0:
        cosine = np.full(count, direction[0] / length)
        sine = np.full(count, direction[1] / length)
    else:
        angle = rng.uniform(0.0, 2 * np.pi, count)
        cosine, sine = np.cos(angle), np.sin(angle)
    return np.column_stack([along * cosine - across * sine, along * sine + across * cosine])


def sample_disc(rng: np.random.Generator, count: int, radius: float) -> Array:
    """Draw `count` displacements evenly from a disc of `radius` px, shape (count, 2), in px."""
    angle = rng.uniform(0.0, 2 * np.pi, count)
    # The root makes every area as likely as any other.
    distance = radius * np.sqrt(rng.random(count))
    return np.column_stack([distance * np.cos(angle), distance * np.sin(angle)])


def expected_drift(steps: int, sigma_r: float) -> float:
    """Mean displacement along the motion after `steps` draws, in px (eq. 20, READINGS 4)."""
    return steps * RAYLEIGH_MEAN * sigma_r

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Resampling schemes: functions ``(weights, count, rng) -> ancestor indices``.

Every scheme draws `count` indices so that the expected number of times that `i` appears is
``count * weights[i]``, and never draws a particle of weight zero. Weights without information (all
zero, negative or not finite) count as uniform. The schemes differ in variance: systematic and
stratified spread their draws evenly, residual keeps the integer part of each expected count for
certain, and multinomial is the importance sampling of P1's Algorithm 2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.filtering.weights import Weights, normalise

Ancestors: TypeAlias = npt.NDArray[np.intp]
Scheme: TypeAlias = Callable[[Weights, int, np.random.Generator], Ancestors]


def multinomial(weights: Weights, count: int, rng: np.random.Generator) -> Ancestors:
    """Draw `count` independent ancestors (P1, Algorithm 2)."""
    return _search(weights, rng.random(count))


def stratified(weights: Weights, count: int, rng: np.random.Generator) -> Ancestors:
    """Draw one ancestor from each of `count` equal strata of the cumulative weight."""
    return _search(weights, (np.arange(count) + rng.random(count)) / count)


def systematic(weights: Weights, count: int, rng: np.random.Generator) -> Ancestors:
    """Draw ancestors at `count` equidistant points with one random offset."""
    return _search(weights, (np.arange(count) + rng.random()) / count)


def residual(weights: Weights, count: int, rng: np.random.Generator) -> Ancestors:
    """Keep ``floor(count * w)`` copies of each particle, and draw the rest multinomially."""
    # Expected counts need weights that sum to one; the other schemes scale their points instead.
    weights, _ = normalise(weights)
    expected = count * weights
    # 0.3 * 10 is 2.9999999999999996: an integer expectation must not lose a copy to rounding.
    kept = np.floor(expected + 1e-9 * np.maximum(expected, 1.0)).astype(np.intp)
    certain = np.repeat(np.arange(len(weights), dtype=np.intp), kept)[:count]
    missing = count - len(certain)
    if missing == 0:
        return certain
    # Where a copy was kept in spite of rounding, what is left of it may be below zero.
    rest = np.maximum(expected - kept, 0.0)
    drawn = _search(rest if rest.any() else weights, rng.random(missing))
    return np.concatenate([certain, drawn])


def _search(weights: Weights, points: npt.NDArray[np.float64]) -> Ancestors:
    """Index of the first cumulative weight above each point of [0, 1), a share of all weight."""
    # Points are scaled to the sum, not the weights to one: a pass over N less.
    cumulative = weights.cumsum()
    total = cumulative[-1]
    if not (0 < total < math.inf and weights.min() >= 0):
        cumulative = normalise(weights)[0].cumsum()
        total = cumulative[-1]
    # ``side="right"`` steps over particles of weight zero; a point may round up to the whole sum,
    # and past all particles: clamp to the last one that adds to it (interpretation 9).
    last = cumulative.argmax()
    return np.asarray(np.minimum(cumulative.searchsorted(points * total, side="right"), last))


RESAMPLING_SCHEMES: Mapping[str, Scheme] = {
    "multinomial": multinomial,
    "residual": residual,
    "systematic": systematic,
    "stratified": stratified,
}
"""Resampling schemes by the name that parameters use."""

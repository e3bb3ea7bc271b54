# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarity transform that most points of an image share: the motion of its background."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

_Complex: TypeAlias = npt.NDArray[np.complex128]

AGREEING_PX = 0.7
"""Residual of a corner that agrees with the motion, in px of the reduced frame: a choice, which
noise of flow stays below, and a camera that moves does not."""
LEAST_CORNERS = 6
"""Fewest corners that four numbers are fitted to: 12 coordinates, so that one may err. A choice."""
STILL_SHARE = 0.5
"""Share of corners at rest from which the camera stands: a lorry moves many, not half."""
FITS = 5
"""Reweighted fits; the weights change little after the third."""


def shared_similarity(before: Array, after: Array) -> Array:
    """Fit a similarity to the motion that most points share.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Points in both frames, px.

    Returns
    -------
    (2, 3) array
        Rotation times scale, and shift in px. That of no motion where half of the points rest, or
        too few agree.
    """
    # As complex numbers, of which a similarity is a factor and a summand.
    start, end = (np.ascontiguousarray(points).view(complex).ravel() for points in (before, after))
    flow = end - start
    rest = np.eye(2, 3)
    if len(flow) < LEAST_CORNERS:
        return rest
    # A camera that stands is the usual case, and exactly none is better than a fit to noise.
    if np.count_nonzero(np.abs(flow) < AGREEING_PX) >= STILL_SHARE * len(flow):
        return rest
    # A zoom or a roll spreads the flow over the image, hence the wide neighbourhood.
    apart = np.abs(flow[:, np.newaxis] - flow)
    # The mode of the flow, not its mean: a lorry may carry many of the corners.
    densest = int((apart < 3 * AGREEING_PX).sum(axis=1).argmax())
    # Wider than what counted for the mode, so that the rim of a zoom takes part in the fit.
    agreeing = apart[densest] < 5 * AGREEING_PX
    if agreeing.sum() < LEAST_CORNERS:
        return rest
    factor, shift = _robust_similarity(start[agreeing], end[agreeing])
    (along, across), (x, y) = ((each.real, each.imag) for each in (factor, shift))
    return np.array([[along, -across, x], [across, along, y]])


def _robust_similarity(start: _Complex, end: _Complex) -> tuple[complex, complex]:
    """Fit by least squares, reweighted so that points far off count little."""
    factor, shift = _weighted_similarity(start, end, np.ones(len(start)))
    for _ in range(FITS - 1):
        residual = np.abs(end - factor * start - shift)
        # Half of the limit at least: a perfect fit would leave the median of noise as the scale.
        scale = max(1.5 * median(residual), AGREEING_PX / 2)
        weights = 1 / (1 + (residual / scale) ** 2) ** 2
        factor, shift = _weighted_similarity(start, end, weights)
    return factor, shift


def _weighted_similarity(start: _Complex, end: _Complex, weights: Array) -> tuple[complex, complex]:
    """Fit by weighted least squares, in closed form: a factor and a summand."""
    shares = weights / weights.sum()
    middle = shares @ start
    target = shares @ end
    off = start - middle
    weighted = weights * off.conj()
    # The summand bears corners that coincide.
    factor = weighted @ (end - target) / ((weighted @ off).real + 1e-9)
    return factor, target - factor * middle


def median(values: Array) -> float:
    """Median of up to some hundred finite values, in a fraction of the time of `np.median`."""
    ordered = np.sort(values)
    half = len(values) // 2
    return float((ordered[(len(values) - 1) // 2] + ordered[half]) / 2)

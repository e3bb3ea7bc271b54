# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Changes of a camera's exposure: gain and offset of each channel, fitted to what stands."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Curves: TypeAlias = npt.NDArray[np.uint8]
"""Level (channels, 256) that each level becomes."""

_WITHIN = (40.0, 20.0, 10.0, 10.0)
"""Distances, levels, within which pixels are fitted, round by round: the first line has no offset
yet. The last one is a third of what makes a change in the sum of three channels."""
_TOLD = 0.1
"""Least share of the pixels that a channel is fitted to; less tells of one object. A choice."""
_CONTRAST = 5.0
"""Standard deviation of the levels, several times that of noise, below which gain and offset are
not told from each other, and all is gain."""
_MOST_EXPLAINED = 0.6
"""Share of the pixels that a change of exposure has to explain: more than half, as vehicles cover
some, and what explains less is another view. A choice."""
_UNCUT = (5, 250)
"""Levels that are neither black nor white, beyond which a channel does not follow the gain."""
_LARGEST = 2.5
"""Largest gain, either way; beyond it most of an image is black or white. A choice."""


def exposure_change(before: Array, after: Array) -> Curves | None:
    """Fit the change of exposure between two images.

    Parameters
    ----------
    before, after : (C, N) arrays
        Levels of the same pixels in the channels of both; vehicles may cover some of them.

    Returns
    -------
    Curves or None
        None where no gain and offset explain most pixels.
    """
    explained = np.ones(before.shape[1], np.bool_)
    curves = []
    for old, new in zip(before, after, strict=True):
        line = _line(old, new)
        if line is None:
            return None
        gain, offset = line
        curve = np.clip(gain * np.arange(256) + offset, 0, 255)
        curves.append(np.rint(curve).astype(np.uint8))
        explained &= np.abs(curve[old.astype(np.intp)] - new) < _WITHIN[-1]
    return np.array(curves) if explained.mean() > _MOST_EXPLAINED else None


def _line(old: Array, new: Array) -> tuple[float, float] | None:
    """Fit gain and offset of a channel (N,), whatever vehicles cover; None if it is cut off."""
    low, high = _UNCUT
    told = (old > low) & (old < high) & (new > low) & (new < high)
    least = _TOLD * len(old)
    if np.count_nonzero(told) <= least:
        return None
    x = old[told]
    y = new[told]
    gain = float(np.median(y / x))
    offset = 0.0
    for within in _WITHIN:
        near = np.abs(gain * x + offset - y) < within
        if np.count_nonzero(near) <= least:
            return None
        gain, offset = _regression(x[near], y[near])
    return (gain, offset) if 1 / _LARGEST < gain < _LARGEST else None


def _regression(x: Array, y: Array) -> tuple[float, float]:
    deviation = float(x.std())
    if deviation < _CONTRAST:
        return float(y.mean() / x.mean()), 0.0
    gain = float(((x - x.mean()) * y).mean()) / deviation**2
    return gain, float(y.mean() - gain * x.mean())

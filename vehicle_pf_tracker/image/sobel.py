"""Sobel gradients: strength and direction bin of pixels (P2 eq. 6 and 7)."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Strengths: TypeAlias = npt.NDArray[np.float32]
"""Squared magnitude of the gradient; whole numbers below 2**24, so exact."""

DIRECTION_BINS = 64


def squared_strength(gx: npt.NDArray[Any], gy: npt.NDArray[Any]) -> Strengths:
    """Squared magnitude of equation 7, in grey levels squared."""
    gx, gy = gx.astype(np.float32), gy.astype(np.float32)
    return np.asarray(gx * gx + gy * gy)


def squared_limits(peaks: Strengths, threshold: float, floor: float = 0.0) -> Strengths:
    """Least squared strength of edge points where the strongest has `peaks`.

    Parameters
    ----------
    peaks : array
        Squared strengths.
    threshold : float
        Share of the strongest gradient that makes an edge point.
    floor : float
        Gradient that an edge point has at least, whatever the strongest is.

    Returns
    -------
    array
        Infinite where there is no gradient at all: nothing is an edge point there.
    """
    limits = np.maximum(np.float32(threshold) ** 2 * peaks, np.float32(floor) ** 2)
    return np.asarray(np.where(peaks > 0, limits, np.inf), np.float32)


def direction_bins(
    gx: npt.NDArray[Any], gy: npt.NDArray[Any], *, signed: bool
) -> npt.NDArray[np.intp]:
    """Bin 0 to 63 of the direction in the image (x to the right, y down).

    Parameters
    ----------
    gx, gy : arrays of one shape
        Whole numbers, not both zero.
    signed : bool
        False takes ``atan(gy / gx)``, which knows no opposite directions.

    Returns
    -------
    array
        -180 degrees is bin 0, 0 degrees the lower end of bin 32; 180 degrees is -180.
    """
    if not signed:
        fold = (gx < 0) | ((gx == 0) & (gy < 0))
        gx, gy = np.where(fold, -gx, gx), np.where(fold, -gy, gy)
    turns = np.arctan2(gy.astype(np.float64), gx.astype(np.float64)) / (2 * np.pi) + 0.5
    return np.floor(turns * DIRECTION_BINS).astype(np.intp) % DIRECTION_BINS

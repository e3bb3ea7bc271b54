"""Histogram similarity of many windows at once, in numpy and OpenCV.

Only bins that occur in the reference can add to a Bhattacharyya coefficient, and only the region
that the windows cover needs looking at. So the region's pixels are mapped to the few active bins,
each bin's plane is integrated once, and every window then costs four look-ups a bin.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.colour import Histogram, bin_count, bin_indices
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.window import Bounds, Positions, Window, bounds

Coefficients = npt.NDArray[np.float64]

_MOST_PLANES = 32
"""Planes integrated at once: OpenCV 5 takes 128 channels at most, and small blocks stay cached."""


def joint_similarity(
    frame: Frame, positions: Positions, window: Window, reference: Histogram, bits: int
) -> Coefficients:
    """Bhattacharyya coefficient of each window's joint histogram with `reference` (P1 eq. 24).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    positions : (N, 2) array
        Window centres in px.
    window : Window
        Size of all windows; over the border the pixels that exist count.
    reference : (bin_count(bits),) array
        Normalised histogram; all zero is similar to nothing.
    bits : int
        Bits a channel.

    Returns
    -------
    (N,) array
        From 0 to 1.
    """
    active = np.flatnonzero(reference)
    if len(active) == 0:
        return np.zeros(len(positions))
    windows = bounds(frame, positions, window)
    region, local = _region(frame, windows)
    counts = _counts(bin_indices(region, bits), active, bin_count(bits), local)
    area = (local.right - local.left) * (local.bottom - local.top)
    overlap = np.sqrt(counts * reference[active]).sum(axis=1)
    return np.asarray(np.minimum(overlap / np.sqrt(area), 1.0))


def _region(frame: Frame, windows: Bounds) -> tuple[Frame, Bounds]:
    """View of the pixels that the windows cover, and the windows relative to it."""
    left, top = int(windows.left.min()), int(windows.top.min())
    region = frame[top : int(windows.bottom.max()), left : int(windows.right.max())]
    return region, Bounds(
        windows.left - left, windows.top - top, windows.right - left, windows.bottom - top
    )


def _counts(
    indices: npt.NDArray[np.uint16], active: npt.NDArray[np.intp], bins: int, windows: Bounds
) -> npt.NDArray[np.int32]:
    """Pixels of each active bin in each window: shape (N, active)."""
    counts = np.empty((len(windows.left), len(active)), dtype=np.int32)
    for start in range(0, len(active), _MOST_PLANES):
        part = active[start : start + _MOST_PLANES]
        counts[:, start : start + len(part)] = _window_sums(_planes(indices, part, bins), windows)
    return counts


def _planes(
    indices: npt.NDArray[np.uint16], active: npt.NDArray[np.intp], bins: int
) -> npt.NDArray[np.uint8]:
    """One plane for each active bin, 1 where a pixel falls into it: shape (H, W, active)."""
    lookup = np.zeros((bins, len(active)), dtype=np.uint8)
    lookup[active, np.arange(len(active))] = 1
    return lookup[indices]


def _window_sums(planes: npt.NDArray[np.uint8], windows: Bounds) -> npt.NDArray[np.int32]:
    """Sum of every plane over every window: shape (N, planes)."""
    height, width, count = planes.shape
    summed = np.asarray(cv2.integral(planes)).reshape(height + 1, width + 1, count)
    left, top, right, bottom = windows
    return np.asarray(
        summed[bottom, right] - summed[top, right] - summed[bottom, left] + summed[top, left]
    )

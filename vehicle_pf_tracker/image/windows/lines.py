# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Straight edge segments, and the distribution of their lengths over directions in each window.

Segments are found once in the region that all windows cover. The part of a segment inside each
window is then computed by clipping, exactly and for all windows at once.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.products import product
from vehicle_pf_tracker.image.windows.window import Bounds

Segments = npt.NDArray[np.float64]
"""x, y of both ends in continuous px, shape (S, 4)."""

_MARGIN = 3
"""Pixels around the region that are needed to detect an edge on its border: one for the gradient,
one for Canny's suppression of non-maxima, one for its hysteresis."""
_ANGLE_STEP = np.pi / 36
"""Resolution of directions in the Hough transform: 5 degrees, a quarter of the width of the
default eight direction bins."""


def find_lines(frame: Frame, windows: Bounds, edge_threshold: float, shortest: int) -> Segments:
    """Find the segments in the region that `windows` cover: Canny's edges, probabilistic Hough.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    windows : Bounds
        Pixel rectangles, arrays of shape (N,).
    edge_threshold : float
        Gradient (levels of 255, 3x3 Sobel) at which an edge starts; it continues down to a third.
    shortest : int
        Least length of a segment, in px.

    Returns
    -------
    (S, 4) array
        Segments in the frame's coordinates; S may be 0.
    """
    left = max(int(windows.left.min()) - _MARGIN, 0)
    top = max(int(windows.top.min()) - _MARGIN, 0)
    right = int(windows.right.max()) + _MARGIN
    bottom = int(windows.bottom.max()) + _MARGIN
    grey = cv2.cvtColor(frame[top:bottom, left:right], cv2.COLOR_RGB2GRAY)
    # Hysteresis from a third: the usual ratio, which keeps a line whole where it fades.
    edges = cv2.Canny(grey, edge_threshold / 3, edge_threshold)
    segments = cv2.HoughLinesP(
        edges, 1, _ANGLE_STEP, shortest, minLineLength=shortest, maxLineGap=1
    )
    if segments is None:
        return np.zeros((0, 4))
    # Hough names pixels; their centres lie half a pixel further. OpenCV 4 nests the rows.
    return np.asarray(np.reshape(segments, (-1, 4)) + np.array([left, top, left, top]) + 0.5)


def lengths_inside(segments: Segments, windows: Bounds) -> Array:
    """Length of each segment inside each window, in px (Liang and Barsky's clipping).

    Parameters
    ----------
    segments : (S, 4) array
        Segments, as `find_lines` returns them.
    windows : Bounds
        Pixel rectangles, arrays of shape (N,).

    Returns
    -------
    (N, S) array
    """
    start = segments[:, :2]
    step = segments[:, 2:] - segments[:, :2]
    # A step of nothing crosses nowhere: a tiny one enters long before and leaves long after, or
    # the other way round where the segment lies outside.
    safe = np.where(np.abs(step) < 1e-9, 1e-9, step)
    # A segment is start + t step with t from 0 to 1; each side of a window bounds t.
    enter = np.zeros((len(windows.left), len(segments)))
    leave = np.ones((1, 1))
    for axis, (low, high) in enumerate(
        ((windows.left, windows.right), (windows.top, windows.bottom))
    ):
        at_low = (low[:, np.newaxis] - start[:, axis]) / safe[:, axis]
        at_high = (high[:, np.newaxis] - start[:, axis]) / safe[:, axis]
        enter = np.maximum(enter, np.minimum(at_low, at_high))
        leave = np.minimum(leave, np.maximum(at_low, at_high))
    # Outside it leaves before it enters: no length.
    return np.asarray(np.maximum(leave - enter, 0.0) * np.hypot(*step.T))


def direction_shares(segments: Segments, bins: int) -> Array:
    """Share of each segment in each bin over 180 degrees, shape (S, bins), rows summing to one.

    A direction between the middles of two bins counts in both, so that a small turn changes little.
    Bin 0 has its middle at the horizontal, and follows on the last one.
    """
    x, y = (segments[:, 2:] - segments[:, :2]).T
    bin_position = np.mod(np.arctan2(y, x), np.pi) / np.pi * bins
    # Shared linearly between two bins, as the direction of a short segment is off by degrees.
    lower = np.floor(bin_position).astype(np.intp)
    upper_share = bin_position - lower
    shares = np.zeros((len(segments), bins))
    rows = np.arange(len(segments))
    np.add.at(shares, (rows, lower % bins), 1.0 - upper_share)
    np.add.at(shares, (rows, (lower + 1) % bins), upper_share)
    return shares


def line_histograms(segments: Segments, windows: Bounds, bins: int) -> Array:
    """Share of each direction in the length of line inside each window.

    Parameters
    ----------
    segments, windows, bins
        As for `lengths_inside` and `direction_shares`.

    Returns
    -------
    (N, bins) array
        Rows sum to one; zero where a window has no line.
    """
    lengths = product(lengths_inside(segments, windows), direction_shares(segments, bins))
    total = lengths.sum(axis=1, keepdims=True)
    return np.asarray(np.divide(lengths, total, out=np.zeros_like(lengths), where=total > 0))

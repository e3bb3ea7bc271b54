# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Share of pixels, and of a vehicle's box, that a rectangle at any angle covers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.box import Box

Floats = npt.NDArray[np.float64]

_UPRIGHT = 1e-5
"""Slope of an edge that moves it by less than a hundredth of a pixel over a thousand."""


def visible_share(corners: Floats, box: Box, size: tuple[int, int]) -> float:
    """Compute the share of a box, as far as it is in the image, outside a painted rectangle.

    A pixel counts by how much of it the box covers, and is hidden by how much of it is painted.

    Parameters
    ----------
    corners : (4, 2) array
        Corners of the rectangle, clockwise, px.
    box : Box
        Box of the vehicle, px.
    size : (int, int)
        Width and height of the image in px.
    """
    left, right = _span(box.x, box.x + box.width, size[0])
    top, bottom = _span(box.y, box.y + box.height, size[1])
    # Most frames end here: the occluder is somewhere else.
    if right <= left or bottom <= top or _is_beside(corners, (left, top, right, bottom)):
        return 1.0
    # An upright box covers of a pixel the product of its shares along the axes.
    across = _share_of_pixels(left, right, box.x, box.x + box.width)
    down = _share_of_pixels(top, bottom, box.y, box.y + box.height)
    weight = down[:, np.newaxis] * across
    painted = coverage(corners, (left, top, right - left, bottom - top))
    total = float(weight.sum())
    return float((weight * (1.0 - painted)).sum()) / total if total > 0 else 1.0


def coverage(corners: Floats, region: tuple[int, int, int, int]) -> Floats:
    """Compute the share of each pixel of a region that a rectangle covers.

    Exact but for the pixels at the corners of slanted rectangles, where the product of the shares
    along the two axes stands for the true one.

    Parameters
    ----------
    corners : (4, 2) array
        Corners, clockwise in the image, px.
    region : tuple of int
        Left, top, width and height of the region in px.

    Returns
    -------
    (height, width) array
        Shares, 0 to 1.
    """
    left, top, width, height = region
    x = left + 0.5 + np.arange(width, dtype=float)
    y = (top + 0.5 + np.arange(height, dtype=float))[:, np.newaxis]
    # A convex shape is what is inside of all its edges.
    ends = np.roll(corners, -1, axis=0)
    inside = [_share_inside(one, end, x, y) for one, end in zip(corners, ends, strict=True)]
    # The parts of a pixel that two opposite edges cut off never overlap.
    along = [np.clip(inside[i] + inside[i + 2] - 1.0, 0, 1) for i in (0, 1)]
    return np.asarray(along[0] * along[1])


def _is_beside(corners: Floats, region: tuple[int, int, int, int]) -> bool:
    """Tell quickly that a rectangle touches no pixel of a region, as in most frames."""
    left, top = corners.min(axis=0)
    right, bottom = corners.max(axis=0)
    beside = right < region[0] or region[2] < left
    return bool(beside or bottom < region[1] or region[3] < top)


def _share_inside(one: Floats, end: Floats, x: Floats, y: Floats) -> Floats:
    """Compute the share of pixels on the inner side of the edge from `one` to `end`.

    That is the distribution function of the distance to the edge of a point drawn from the pixel:
    a sum of two uniform variables, as wide as the edge's normal is long along x and y.
    """
    dx, dy = (float(each) for each in end - one)
    length = float(np.hypot(dx, dy)) or 1.0
    # Signed distance of pixel centres to the edge, positive inside for corners that go clockwise.
    distance = (dx * (y - one[1]) - dy * (x - one[0])) / length
    low, high = sorted((abs(dx) / length, abs(dy) / length))
    # An upright edge: the second variable has no width, and would be divided by.
    if low < _UPRIGHT:
        return np.asarray(np.clip(distance + 0.5, 0, 1))
    # The distribution of that sum, a trapezium's integral: squares of ramps at its four corners.
    outer = (high + low) / 2
    inner = (high - low) / 2
    squares = [np.maximum(distance + each, 0.0) ** 2 for each in (outer, inner, -inner, -outer)]
    share = (squares[0] - squares[1] - squares[2] + squares[3]) / (2 * low * high)
    return np.asarray(np.clip(share, 0, 1))


def _span(low: float, high: float, side: int) -> tuple[int, int]:
    return max(0, int(np.floor(low))), min(side, int(np.ceil(high)))


def _share_of_pixels(first: int, end: int, low: float, high: float) -> Floats:
    pixels = np.arange(first, end, dtype=float)
    return np.asarray(np.clip(np.minimum(pixels + 1, high) - np.maximum(pixels, low), 0, 1))

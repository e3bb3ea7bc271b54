"""Share of pixels, and of a vehicle's box, that a rectangle at any angle covers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.box import Box

Floats = npt.NDArray[np.float64]


def visible_share(corners: Floats, box: Box, size: tuple[int, int]) -> float:
    """Compute the share of a box, as far as it is in the image, outside a painted rectangle.

    A pixel counts by how much of it the box covers, and is hidden by how much of it is painted.

    Parameters
    ----------
    corners : (4, 2) array
        Of the rectangle, clockwise.
    box : Box
        The vehicle.
    size : (int, int)
        Width and height of the image in px.
    """
    left, right = _span(box.x, box.x + box.width, size[0])
    top, bottom = _span(box.y, box.y + box.height, size[1])
    if right <= left or bottom <= top or _is_beside(corners, (left, top, right, bottom)):
        return 1.0
    across = _share_of_pixels(left, right, box.x, box.x + box.width)
    down = _share_of_pixels(top, bottom, box.y, box.y + box.height)
    weight = down[:, np.newaxis] * across
    painted = coverage(corners, (left, top, right - left, bottom - top))
    total = float(weight.sum())
    return float((weight * (1.0 - painted)).sum()) / total if total > 0 else 1.0


def coverage(corners: Floats, region: tuple[int, int, int, int]) -> Floats:
    """Compute the share of each pixel of a region that a rectangle covers.

    Exact for upright rectangles at least a pixel wide; at slanted edges the share follows from the
    distance between the pixel's centre and the edge.

    Parameters
    ----------
    corners : (4, 2) array
        Clockwise in the image.
    region : tuple of int
        Left, top, width and height of the region in px.

    Returns
    -------
    (height, width) array
        0 to 1.
    """
    left, top, width, height = region
    x = left + 0.5 + np.arange(width, dtype=float)
    y = (top + 0.5 + np.arange(height, dtype=float))[:, np.newaxis]
    inside = [_distance(one, other, x, y) for one, other in _edges(corners)]
    # Opposite edges first: a rectangle's share is the product of those along its two axes.
    along = [np.clip(inside[i] + 0.5, 0, 1) + np.clip(inside[i + 2] + 0.5, 0, 1) for i in (0, 1)]
    shares = [np.clip(each - 1.0, 0, 1) for each in along]
    return np.asarray(shares[0] * shares[1])


def _is_beside(corners: Floats, region: tuple[int, int, int, int]) -> bool:
    """Tell quickly that a rectangle touches no pixel of a region, as in most frames."""
    (left, top), (right, bottom) = corners.min(axis=0), corners.max(axis=0)
    # Half a pixel more, since slanted edges are smoothed.
    beside = right + 0.5 < region[0] or region[2] < left - 0.5
    return bool(beside or bottom + 0.5 < region[1] or region[3] < top - 0.5)


def _edges(corners: Floats) -> list[tuple[Floats, Floats]]:
    return list(zip(corners, np.roll(corners, -1, axis=0), strict=True))


def _distance(one: Floats, other: Floats, x: Floats, y: Floats) -> Floats:
    """Distance of pixels to the edge from `one` to `other`, positive inside, px."""
    (dx, dy) = other - one
    length = float(np.hypot(dx, dy)) or 1.0
    return np.asarray((dx * (y - one[1]) - dy * (x - one[0])) / length)


def _span(low: float, high: float, side: int) -> tuple[int, int]:
    return max(0, int(np.floor(low))), min(side, int(np.ceil(high)))


def _share_of_pixels(first: int, end: int, low: float, high: float) -> Floats:
    pixels = np.arange(first, end, dtype=float)
    return np.asarray(np.clip(np.minimum(pixels + 1, high) - np.maximum(pixels, low), 0, 1))

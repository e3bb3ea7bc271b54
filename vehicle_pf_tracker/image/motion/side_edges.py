# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Where a mask of what moves ends at each of the four sides of a box."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

_BAND = 0.3
"""Half of the part of a side that is looked at, fraction of it: at its ends corners are round, and
neighbours touch. With .2 and .4 the mean gain of IoU is .021 and .022, not .023
(laboratory/notes/fusion_tried.md)."""
_REACH = 0.35
"""Largest distance of an edge from the side, fraction of the box, a choice: farther away it is a
neighbour's. With .25 and .5 the gain is .022 and .024."""
_INSIDE, _EDGE, _OUTSIDE = 0.75, 0.5, 0.25
"""Shares of that part that move just inside an edge, on it, and just outside: choices."""
_SHARP = 0.1
"""Largest distance between the first and the last of these, fraction of the box, beside one px: the
rim of a shadow, of a neighbour, or of a vehicle that stands aslant in its box, is slanted. Chosen
on a drawn one that grows by a twentieth in a frame: IoU .917, .908 and .900 with .05, .1 and .15,
and that of 98 real vehicles the same within .0013 (laboratory/notes/fusion_tried.md)."""
_FILLED = 0.8
"""Least share of the middle of the box that moves: less, and the background shows the vehicle
itself, so that what moves ends inside it. From 0 to .9 the gain is .023; chosen on a van in slow
traffic, whose box loses .06 of IoU without it."""
_LEAST_EXTENT = 8.0
"""Least side of a box, px of the mask, as an edge is good to about one. With 0 and 12 the gain is
.023 and .022; chosen on a car of 16 x 7 px before a drone, whose box loses .04 of IoU with 0."""
_OVERREACH = 0.5
"""Distance that a mask reaches beyond the true edge, px of it: it is blurred before the threshold.
With 0 and 1 the gain is .021."""


Masks = tuple[npt.NDArray[np.uint8], npt.NDArray[np.uint8]]
"""Masks for x and for y."""


def edges_beyond(mask: npt.NDArray[np.uint8], low: Array, high: Array) -> Array | None:
    """Distance of the edges of what moves beyond the sides of a box, fractions of its size.

    Parameters
    ----------
    mask : (h, w) array of uint8
        1 where something moves.
    low, high : (2,) arrays
        Left and upper, right and lower side of the box, px of the mask.

    Returns
    -------
    (2, 2) array or None
        By [low or high, axis]; NaN at a side without a sharp edge. None where the box is too small,
        or itself hardly moves.
    """
    height, width = mask.shape
    (left, top), (right, bottom) = low.tolist(), high.tolist()
    columns = _band(left, right, width)
    rows = _band(top, bottom, height)
    middle = mask[rows, columns]
    if min(right - left, bottom - top) < _LEAST_EXTENT:
        return None
    # Counted by OpenCV, in a fifth of the time of means of small arrays.
    if not middle.size or cv2.countNonZero(middle) < _FILLED * middle.size:
        return None
    across = _shares(mask[rows], 0)
    down = _shares(mask[:, columns], 1)
    # A low side is the high one of the mirrored profile.
    lows = (
        _beyond(across[::-1], width - left, right - left),
        _beyond(down[::-1], height - top, bottom - top),
    )
    highs = _beyond(across, right, right - left), _beyond(down, bottom, bottom - top)
    return np.array([lows, highs])


def outermost_beyond(lows: Masks, highs: Masks, low: Array, high: Array) -> Array:
    """Distance of the outermost edges, as `edges_beyond`, where what moves has holes.

    Of a plain vehicle only its rims differ from one image to the next: what is inside of something
    that moves counts as moving.

    Parameters
    ----------
    lows, highs : pairs of (h, w) arrays of uint8
        Mask by which the low, and the high, side is found along x and along y.
    low, high : (2,) arrays
        Left and upper, right and lower side of the box, px of the masks.
    """
    beyond = np.empty((2, 2))
    sides = low.tolist(), high.tolist()
    for axis in (0, 1):
        first, last = sides[0][axis], sides[1][axis]
        for end, masks in enumerate((lows, highs)):
            mask = masks[axis]
            length = mask.shape[1 - axis]
            band = _band(sides[0][1 - axis], sides[1][1 - axis], mask.shape[axis])
            profile = _shares(mask[band] if axis == 0 else mask[:, band], axis)
            # A low side is the high one of the mirrored profile.
            mirrored = profile if end else profile[::-1]
            side = last if end else length - first
            beyond[end, axis] = _beyond(_filled(mirrored), side, last - first)
    return beyond


def _filled(profile: Sequence[float]) -> list[float]:
    """At each px, the largest share from it outwards, to the high side."""
    return list(itertools.accumulate(profile[::-1], max))[::-1]


def _band(first: float, last: float, length: int) -> slice:
    """Pixels of the middle part of a range of an axis of `length` px."""
    middle = (first + last) / 2
    half = _BAND * (last - first)
    start = max(math.floor(middle - half), 0)
    return slice(start, max(min(math.ceil(middle + half), length), start))


def _shares(mask: npt.NDArray[np.uint8], axis: int) -> list[float]:
    """Share of each column (axis 0) or row (axis 1) of a mask that moves."""
    counts = np.add.reduce(mask, axis=axis, dtype=np.int32)
    shares: list[float] = (counts / mask.shape[axis]).tolist()
    return shares


def _beyond(profile: Sequence[float], side: float, extent: float) -> float:
    """Distance of an edge beyond the high side of a box of this extent, fraction of it.

    `profile` has the share that moves, by px of the axis; NaN where there is no sharp edge.
    """
    reach = (_REACH + _SHARP) * extent
    place = math.floor(side - reach)
    last = min(side + reach, len(profile) - 1)
    if place < 0 or place > last or profile[place] < _INSIDE:
        return math.nan
    crossed: list[float] = []
    for level in (_INSIDE, _EDGE, _OUTSIDE):
        while profile[place] >= level:
            place += 1
            if place > last:
                return math.nan
        inner = profile[place - 1]
        # Linear between the middles of both px.
        crossed.append(place - 0.5 + (inner - level) / (inner - profile[place]))
    inside, edge, outside = crossed
    beyond = (edge - side) / extent
    if outside - inside >= _SHARP * extent + 1 or abs(beyond) > _REACH:
        return math.nan
    return beyond - _OVERREACH / extent

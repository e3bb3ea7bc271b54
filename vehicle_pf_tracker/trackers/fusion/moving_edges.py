# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of what moves with the box and not with the road, by three images.

They need no model of the background, and so are found from the first frames on. A pixel of the
vehicle differs less from the two other images when these are aligned with the box than when they
are aligned with the background. The side in front is judged by the earlier image, in which the road
ahead was still free, and the one behind by the later image, in which the road there is free again.
"""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.side_edges import outermost_beyond
from vehicle_pf_tracker.trackers.fusion.moments import Cells, Moment, Moments

_CELLS = 20
"""Cells per side of the box: half of the patch's px, a choice."""
_MARGIN = 8
"""Cells beyond each side, beyond what an edge may be off. A choice."""
_ALL = _CELLS + 2 * _MARGIN
_LOW = np.full(2, float(_MARGIN))
_HIGH = _LOW + _CELLS
_LEAST_EVIDENCE = 6
"""Excess of the difference aligned with the background over that aligned with the box, grey levels,
above which a cell is part of the vehicle: the noise of an image. With 4, 8 and 10 the mean gain of
IoU is .0082, .0073 and .0063, not .0081 (laboratory/notes/fusion_tried.md)."""


def moving_edges(moments: Moments, extent: tuple[int, int]) -> Array:
    """Distances of the edges beyond the sides of the box in the middle one of three moments.

    Parameters
    ----------
    extent : pair of int
        Width and height of the frame, px.

    Returns
    -------
    (2, 2) array
        By [low or high, axis], fractions of its size; NaN at a side without a sharp edge.
    """
    earlier, middle, later = moments
    present = _cells(middle, middle.position, middle.size)
    # From both: what has driven by fits in one of them only.
    left = [
        cv2.absdiff(present, _cells(other, other.position, other.size))
        for other in (earlier, later)
    ]
    moving = np.asarray(cv2.max(*left), np.uint8)
    in_front = _moving_part(present, moving, middle, earlier, extent)
    behind = _moving_part(present, moving, middle, later, extent)
    start = earlier.background_in(later, earlier.position)
    right, down = (later.position > start).tolist()
    lows = behind if right else in_front, behind if down else in_front
    highs = in_front if right else behind, in_front if down else behind
    return outermost_beyond(lows, highs, _LOW, _HIGH)


def _moving_part(
    present: Cells, moving: Cells, middle: Moment, other: Moment, extent: tuple[int, int]
) -> Cells:
    """Mask of what does not stand, by the difference that moving with the box leaves."""
    centre = middle.background_in(other, middle.position)
    standing = cv2.absdiff(present, _cells(other, centre, middle.size))
    evidence = cv2.GaussianBlur(cv2.subtract(standing, moving), (3, 3), 0)
    _, part = cv2.threshold(evidence, _LEAST_EVIDENCE, 1, cv2.THRESH_BINARY)
    rows, columns = _in_view(other, centre, middle.size, extent)
    # What is not in view may go on anywhere.
    mask = np.ones_like(present)
    mask[rows, columns] = part[rows, columns]
    return mask


def _cells(moment: Moment, position: Array, size: Array) -> Cells:
    """Grey levels of the cells of a box of this centre and size, px, and around it."""
    step = size / _CELLS
    return moment.cells(position - step * ((_ALL - 1) / 2), step, (_ALL, _ALL))


def _in_view(
    moment: Moment, position: Array, size: Array, extent: tuple[int, int]
) -> tuple[slice, slice]:
    """Rows and columns of these cells that are in the moment's image, and in the frame."""
    ends = []
    shape = moment.image.shape[::-1]
    both = zip(
        *(each.tolist() for each in (moment.corner, moment.zoom, position, size)),
        extent,
        shape,
        strict=True,
    )
    # In scalars, which are quicker than arrays of two.
    for corner, zoom, middle, side, whole, length in both:
        step = side / _CELLS
        start = middle - step * (_ALL / 2)
        first = math.ceil((max(corner, 0.0) - start) / step)
        last = math.floor((min(corner + length / zoom, whole) - start) / step)
        ends.append(slice(max(first, 0), max(last, 0)))
    columns, rows = ends
    return rows, columns

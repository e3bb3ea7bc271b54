# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sides of an outline up to which an image changes: a ghost beyond them stands."""

from __future__ import annotations

import math
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

Corners: TypeAlias = tuple[Array, Array]
"""Left and upper, and right and lower corner (2,) of a part of a frame, px."""

LEAST_CONTRAST = 12.0
"""Difference in grey levels from which a pixel has changed, at least: that of a shadow's rim."""
_LEAST_CHANGED = 0.3
"""Least share of a row or column of an outline that changes where a vehicle moves, relative to that
of its box: even a plain side changes at its end, and the shadow of leaves less. A tenth of all its
pixels lets a van that drives straight on grow (van_j); .3 was chosen before, on scene `turn`, for
the far half of what is beyond a box."""


def changing_sides(
    now: SmallGrey, before: SmallGrey, box: Corners, outline: Corners
) -> Corners | None:
    """Sides within an outline up to which an image differs from an earlier one.

    None where nothing changes.

    Parameters
    ----------
    box : Corners
        What the least change of a row or column is relative to.
    """
    inside, _ = _changes(now, before, box)
    changed, corner = _changes(now, before, outline)
    if not inside.size or not changed.size:
        return None
    least = _LEAST_CHANGED * cv2.mean(inside)[0]
    # The means of columns, then of rows.
    columns, rows = (
        np.flatnonzero(cv2.reduce(changed, axis, cv2.REDUCE_AVG, dtype=cv2.CV_32F) > least)
        for axis in (0, 1)
    )
    if not len(columns) or not len(rows):
        return None
    first = np.array([columns[0], rows[0]])
    last = np.array([columns[-1], rows[-1]])
    # The reduced frame's px may reach beyond the outline by a part of one.
    low = np.maximum((corner + first) / now.zoom, outline[0])
    high = np.minimum((corner + last + 1) / now.zoom, outline[1])
    return low, high


def _changes(
    now: SmallGrey, before: SmallGrey, part: Corners
) -> tuple[npt.NDArray[np.uint8], Array]:
    """Mask of what has changed in a part of the frame, 0 or 1, and its first pixel as x and y."""
    (left, top), (right, bottom) = ((corner * now.zoom).tolist() for corner in part)
    rows = slice(max(math.floor(top), 0), max(math.ceil(bottom), 0))
    columns = slice(max(math.floor(left), 0), max(math.ceil(right), 0))
    first = np.array([columns.start, rows.start])
    piece = now.image[rows, columns]
    if not piece.size:
        return np.empty((0, 0), np.uint8), first
    change = cv2.absdiff(piece, before.image[rows, columns])
    return np.asarray(cv2.threshold(change, LEAST_CONTRAST, 1, cv2.THRESH_BINARY)[1]), first

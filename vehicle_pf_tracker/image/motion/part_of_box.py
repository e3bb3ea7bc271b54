# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What moves in a box, by a mask and the bounding boxes of its connected pieces."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

_MOSTLY = 0.5
"""Least share of a piece's bounds in a box that it belongs to: what drives by reaches beyond."""
_NOISY = 0.1
"""Share of a row or column up to which what moves in it is noise: one pixel of ten, a choice."""


class Part(NamedTuple):
    """What moves in a box, and lies mostly within it.

    Attributes
    ----------
    share : float
        Share of the box that it takes.
    bare : float
        Part of the box's width or height, at one end of it, in which nothing moves at all.
    sides : (2, 2) array
        Its bounds within the box: left and upper, right and lower side, px.
    """

    share: float
    bare: float
    sides: Array


def box_in(shape: tuple[int, ...], low: Array, high: Array) -> tuple[slice, slice]:
    """Rows and columns of an image of this shape that a box touches; empty where it is outside."""
    rows, columns = (
        slice(min(max(math.floor(first), 0), length), min(max(math.ceil(last), 0), length))
        for first, last, length in zip(low[::-1], high[::-1], shape, strict=True)
    )
    return rows, columns


def mostly_inside(pieces: Array, centre: Array, half: Array) -> Array:
    """Choose the pieces (N, 2, 2) at least half of which, by their bounds, is in a box.

    Parameters
    ----------
    centre, half : (2,) arrays
        Middle of the box, and halves of its sides, px.
    """
    low = np.maximum(pieces[:, 0], centre - half)
    high = np.minimum(pieces[:, 1], centre + half)
    shared = np.maximum(high - low, 0.0).prod(axis=1)
    return np.asarray(pieces[shared >= _MOSTLY * (pieces[:, 1] - pieces[:, 0]).prod(axis=1)])


def part_of(moving: npt.NDArray[np.uint8], box: tuple[slice, slice], pieces: Array) -> Part | None:
    """Measure what some pieces (N, 2, 2) of a mask take of a box; None where that is nothing."""
    rows, columns = box
    inside = moving[box]
    corner = np.array([columns.start, rows.start], float)
    bounds = np.clip(pieces - corner, 0, inside.shape[::-1]).astype(int)
    bounds = bounds[(bounds[:, 0] < bounds[:, 1]).all(axis=1)]
    if not len(bounds):
        return None
    kept = np.zeros_like(inside)
    for (left, top), (right, bottom) in bounds.tolist():
        kept[top:bottom, left:right] = inside[top:bottom, left:right]
    sides = np.stack([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)]) + corner
    return Part(float(kept.mean()), _bare_end(inside), sides)


def _bare_end(moving: npt.NDArray[np.uint8]) -> float:
    """Largest part of a mask's width or height, from one of its ends, in which nothing moves."""
    bare = 0.0
    for axis, length in enumerate(moving.shape):
        taken = np.flatnonzero(moving.mean(axis=1 - axis) > _NOISY)
        if not len(taken):
            return 1.0
        bare = max(bare, taken[0] / length, (length - 1 - taken[-1]) / length)
    return float(bare)

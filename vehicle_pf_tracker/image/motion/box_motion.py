# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Turn and stretch that most points of a box share, and the share that moves with its vehicle."""

from __future__ import annotations

import functools
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.shared_motion import median

Alive: TypeAlias = npt.NDArray[np.bool_]
Flow: TypeAlias = npt.NDArray[np.float32]
"""Displacement by [y, x], as x and y, to where the pixel was in an earlier image, px."""
CellBlock: TypeAlias = npt.NDArray[np.intp]
"""First column and row, and number of columns and rows, (2, 2); a cell has `FLOW_CELL_PX` px."""

TURN_FITS = 2
"""Fits of the turn: one for all, and one in which those that strayed from it count less."""
TURN_INERTIA = 0.3
"""Resistance of the turn's fit, as the sum of the squared places of five points: the few that an
occluder leaves must not turn all."""
FEWEST_POINTS = 12
"""Fewest tracked points that give a change of size, a choice: of six pairs along an axis two may
err without moving the median far."""
POINTS_APART = 0.25
"""Least distance of two points that give a change of size, as a share of the box's side: 5 px of
20, of which half a px is a tenth."""
LARGEST_STRETCH = 0.15
"""Bound of the change of log size per frame: vehicles that pass a camera at 10 images a second
change by 0.12."""
LEAST_RATIO = 0.2
"""Bound of the ratio of two distances, whose logarithm is taken: a choice, far beyond what
`LARGEST_STRETCH` lets pass."""

FLOW_CELL_PX = 4
"""Px between points of a surface: dense flow is no finer."""
STRAYED_PX = 3.0
"""A point farther than this from where its vehicle would have taken it, px, has moved on its own:
with a second occluder, or by flow that has failed. A choice: a cell of the surface has 4 px."""
FEWEST_CARRIED = 8
"""Fewest points that a turn is fitted to, a choice: they give 16 numbers for its four."""
FIT_REACH = 1.3
"""Factor to the limits within which points take part in the fit of the turn, a choice: some are
beyond a limit only until the turn is taken off."""

_NO_TURN = np.eye(2)
"""Turn of a vehicle that drives straight on; read only."""
_KEPT = TURN_INERTIA * np.eye(2)
"""Ridge towards no turn, in the normal equations: as if five points had not turned."""


def shared_turn(before: Array, after: Array, strayed: float) -> Array:
    """Linear map (2, 2) that most places (N, 2) in a box have moved by: a vehicle that turns.

    It has no shift, so that points which stay behind with an occluder do not fit into it. Those
    that are `strayed` off count half.
    """
    turn = _NO_TURN
    off = after - before
    for fit in range(TURN_FITS):
        if fit:
            off = after - before @ turn
        far = (off[:, 0] ** 2 + off[:, 1] ** 2) / strayed**2
        weighted = before.T / (1 + far)
        # Reweighted with a Cauchy weight: a stray point pulls less the farther it is off.
        turn = solved(weighted @ before + _KEPT, weighted @ after + _KEPT)
    return turn


def solved(matrix: Array, right: Array) -> Array:
    """Solve a (2, 2) system, in a fraction of the time of `np.linalg.solve`."""
    (a, b), (c, d) = matrix.tolist()
    # Cramer's rule; the callers' ridge keeps the determinant above zero.
    return np.asarray(np.array([[d, -b], [-c, a]]) @ right / (a * d - b * c))


def staying(before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
    """Tell which of the places (N, 2) that are alive turn with most of these.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Places in the box when they were chosen, and now, in sizes of the box.
    alive : (N,) array
        False for places that count as lost already.
    strayed : float
        A place farther than this from where it should be does not stay.
    """
    turn = shared_turn(before.compress(alive, axis=0), after.compress(alive, axis=0), strayed)
    off = after - before @ turn
    return np.asarray(alive & (np.hypot(off[:, 0], off[:, 1]) < strayed))


def shared_stretch(before: Array, after: Array, size: Array) -> Array:
    """Median change of the log distance of points (N, 2) along x and y, of a box of a size."""
    change = np.zeros(2)
    half = len(before) // 2
    for axis in (0, 1):
        # Each of the lower half with one of the upper half: far apart for most, and no N² pairs.
        # Stable, so that points in one place pair alike on every machine.
        places = before[:, axis]
        order = places.argsort(kind="stable")
        sorted_before = places.take(order)
        sorted_after = after[:, axis].take(order)
        old = sorted_before[-half:] - sorted_before[:half]
        new = sorted_after[-half:] - sorted_after[:half]
        # Of points that are close an error of half a px is a change of size of a tenth.
        far = old > POINTS_APART * size[axis]
        if np.count_nonzero(far) >= FEWEST_POINTS // 2:
            ratio = np.maximum(new.compress(far) / old.compress(far), LEAST_RATIO)
            change[axis] = median(np.log(ratio))
    # Per frame no vehicle changes by more: what is beyond is an error, of which the sign is kept.
    return np.minimum(np.maximum(change, -LARGEST_STRETCH), LARGEST_STRETCH)


def carried_share(
    flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
) -> float:
    """Share of the points of a box that have moved with its vehicle.

    A point counts that came from close to where the vehicle, turned and grown as most of them are,
    would have taken it from, and from closer to there than to where the background was.

    Parameters
    ----------
    flow : (h, w, 2) array of float32
        Flow of the image that has the box; see `Flow`.
    cells : (2, 2) array of intp
        The box; see `CellBlock`. Points are the middles of its cells, px.
    places, vehicle : (2, 2) arrays
        Factors and then summands, along x and y, that take a point to its place in the box, in
        sizes from the centre; and to where its place was in the earlier image, px.
    background : (3, 2) or (0, 2) array
        Matrix and then summand that take a point to where the background there was; empty where the
        two have hardly moved apart.
    """
    (left, top), (columns, rows) = cells.tolist()
    block = slice(top, top + rows), slice(left, left + columns)
    # Only whole cells of the box are looked at: flow between them is no finer.
    points = _middles(*flow.shape[:2])[block].reshape(-1, 2)
    middles = slice(FLOW_CELL_PX // 2, None, FLOW_CELL_PX)
    source = points + flow[middles, middles][block].reshape(-1, 2)
    place = points * places[0] + places[1]
    off = source - (points * vehicle[0] + vehicle[1])
    limits: Array | float = STRAYED_PX
    if len(background):
        stays = source - (points @ background[:2] + background[2])
        # A point nearer to the road behind than to its vehicle is the road, seen beside the
        # vehicle.
        limits = np.minimum(STRAYED_PX, np.hypot(stays[:, 0], stays[:, 1]))
    near = np.hypot(off[:, 0], off[:, 1]) < FIT_REACH * limits
    if np.count_nonzero(near) >= FEWEST_CARRIED:
        # The turn is fitted to the residual, so that only what all share is taken off.
        held = place.compress(near, axis=0)
        off = off - place @ solved(held.T @ held + _KEPT, held.T @ off.compress(near, axis=0))
    return float(np.count_nonzero(np.hypot(off[:, 0], off[:, 1]) < limits) / len(points))


@functools.cache
def _middles(height: int, width: int) -> Array:
    """Middles of all cells, by [row, column]."""
    x, y = (np.arange(FLOW_CELL_PX // 2, side, FLOW_CELL_PX) + 0.5 for side in (width, height))
    return np.stack(np.meshgrid(x, y), axis=-1)

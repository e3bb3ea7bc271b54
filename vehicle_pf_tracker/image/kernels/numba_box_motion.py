# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Points of a box that move with its vehicle, compiled; `image.motion.box_motion` says which.

Numpy needs some thirty calls for a few dozen points, each of which takes longer than its numbers.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.kernels.numba_types import RECTANGLES
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.motion.box_motion import (
    FEWEST_CARRIED,
    FIT_REACH,
    FLOW_CELL_PX,
    STRAYED_PX,
    TURN_FITS,
    TURN_INERTIA,
    Alive,
    CellBlock,
    Flow,
)

_Pair: TypeAlias = tuple[float, float]

_FLOW = "float32[:, :, ::1]"
"""Displacements, (h, w, 2)."""
_PLACES = "Array(float64, 2, 'C', readonly=True)"
"""Places of points, (N, 2), and the few rows of a map."""
_ALIVE = "boolean[::1]"
"""A mark of each point, (N,)."""


@inlined
def _no_sums(sums: Array) -> None:
    """Begin the sums (4, 2) of a fit: no turn, with the weight of its inertia."""
    for k in range(2):
        for i in range(2):
            sums[k, i] = TURN_INERTIA if i == k else 0.0
            sums[k + 2, i] = 0.0


@inlined
def _add(sums: Array, place: Array, to: Array, weight: float) -> None:
    """Add a point at a place (2,) to the sums of a fit that takes it `to` another (2,)."""
    for k in range(2):
        for i in range(2):
            sums[k, i] += weight * place[k] * place[i]
            sums[k + 2, i] += weight * place[k] * to[i]


@inlined
def _solve(sums: Array, turn: Array) -> None:
    """Write the linear map (2, 2) that the sums of a fit tell."""
    determinant = sums[0, 0] * sums[1, 1] - sums[0, 1] * sums[1, 0]
    for i in range(2):
        turn[0, i] = (sums[1, 1] * sums[2, i] - sums[0, 1] * sums[3, i]) / determinant
        turn[1, i] = (sums[0, 0] * sums[3, i] - sums[1, 0] * sums[2, i]) / determinant


@inlined
def _off(place: Array, to: Array, turn: Array) -> float:
    """Distance, squared, of a point at `to` (2,) from where a turn takes its place (2,)."""
    x: float = to[0] - (place[0] * turn[0, 0] + place[1] * turn[1, 0])
    y: float = to[1] - (place[0] * turn[0, 1] + place[1] * turn[1, 1])
    return x * x + y * y


@compiled(_ALIVE, _PLACES, _PLACES, _ALIVE, "float64")
def staying(before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
    """Tell which places turn with most; see `image.motion.box_motion.staying`."""
    # Numba does not check indices.
    if before.shape != after.shape or before.shape[1] != 2 or len(alive) != len(before):
        raise IndexError("the places before and after differ in number")
    turn = np.zeros((2, 2))
    turn[0, 0] = 1.0
    turn[1, 1] = 1.0
    sums = np.empty((4, 2))
    for _ in range(TURN_FITS):
        _no_sums(sums)
        # The inertia is one towards no turn.
        sums[2, 0] = TURN_INERTIA
        sums[3, 1] = TURN_INERTIA
        for j in range(len(before)):
            if alive[j]:
                weight = 1 / (1 + _off(before[j], after[j], turn) / strayed**2)
                _add(sums, before[j], after[j], weight)
        _solve(sums, turn)
    stays = np.empty(len(before), np.bool_)
    for j in range(len(before)):
        stays[j] = alive[j] and _off(before[j], after[j], turn) < strayed**2
    return stays


@inlined
def _limit(point: _Pair, source: _Pair, background: Array) -> float:
    """Distance, squared, below which what came from a source moves with the vehicle."""
    limit = STRAYED_PX**2
    if len(background):
        apart = 0.0
        for i in range(2):
            stays = point[0] * background[0, i] + point[1] * background[1, i] + background[2, i]
            apart += (source[i] - stays) ** 2
        limit = min(limit, apart)
    return limit


@compiled("float64", _FLOW, RECTANGLES, _PLACES, _PLACES, _PLACES)
def carried_share(
    flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
) -> float:
    """Share of a box that moves with its vehicle; see `image.motion.box_motion.carried_share`."""
    maps = places.shape == (2, 2) == vehicle.shape and background.shape[1] == 2
    if not maps or cells.shape != (2, 2) or len(background) not in (0, 3) or flow.shape[2] != 2:
        raise IndexError("a box or a map has another number of rows or columns")
    (left, top), (columns, rows) = cells
    width = flow.shape[1] // FLOW_CELL_PX
    height = flow.shape[0] // FLOW_CELL_PX
    if not (0 <= left < left + columns <= width and 0 <= top < top + rows <= height):
        raise IndexError("the box is beside the flow, or empty")
    # 1. Of each point its place in the box, how far it is from where the vehicle would have taken
    # it, and how far it may be, squared.
    place = np.empty((rows * columns, 2))
    off = np.empty((rows * columns, 2))
    limits = np.empty(rows * columns)
    sums = np.empty((4, 2))
    _no_sums(sums)
    near = 0
    for j in range(len(place)):
        column = FLOW_CELL_PX * (left + j % columns) + FLOW_CELL_PX // 2
        row = FLOW_CELL_PX * (top + j // columns) + FLOW_CELL_PX // 2
        point = column + 0.5, row + 0.5
        source = point[0] + flow[row, column, 0], point[1] + flow[row, column, 1]
        for i in range(2):
            place[j, i] = point[i] * places[0, i] + places[1, i]
            off[j, i] = source[i] - (point[i] * vehicle[0, i] + vehicle[1, i])
        limits[j] = _limit(point, source, background)
        if off[j, 0] ** 2 + off[j, 1] ** 2 < FIT_REACH**2 * limits[j]:
            near += 1
            _add(sums, place[j], off[j], 1.0)
    # 2. The turn is fitted to what is left, so that only what all share is taken off.
    turn = np.zeros((2, 2))
    if near >= FEWEST_CARRIED:
        _solve(sums, turn)
    carried = 0
    for j in range(len(place)):
        carried += _off(place[j], off[j], turn) < limits[j]
    return carried / len(place)

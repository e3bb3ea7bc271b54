# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Shared motion of points, compiled; see `image.shared_motion` for what it is."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import float32, float64, intp, types

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.kernels.numba_jit import compiled, inlined
from vehicle_pf_tracker.image.shared_motion import (
    AGREEING_PX,
    APART,
    CELL,
    FEWEST_CARRIED,
    FEWEST_POINTS,
    FITS,
    LARGEST_STRETCH,
    LEAST_CORNERS,
    LEAST_RATIO,
    NEARLY,
    STILL_SHARE,
    STRAYED_PX,
    TURN_FITS,
    TURN_INERTIA,
    Alive,
    CellBlock,
    Flow,
)

_MATRIX = types.Array(float64, 2, "C")
_POINTS = types.Array(float64, 2, "A", readonly=True)
_ALIVE = types.Array(types.boolean, 1, "C")
_FLOW = types.Array(float32, 3, "A", readonly=True)
_CELLS = types.Array(intp, 2, "C")
_SIZE = types.Array(float64, 1, "A", readonly=True)


@inlined
def _densest(before: Array, after: Array) -> npt.NDArray[np.bool_]:
    """Points whose motion is like that which most others have."""
    count = len(before)
    flow = after - before
    most, best = 0, 0
    for i in range(count):
        close = 0
        for j in range(count):
            apart = np.sqrt((flow[i, 0] - flow[j, 0]) ** 2 + (flow[i, 1] - flow[j, 1]) ** 2)
            close += apart < 3 * AGREEING_PX
        if close > most:
            most, best = close, i
    agreeing = np.empty(count, np.bool_)
    for j in range(count):
        apart = np.sqrt((flow[best, 0] - flow[j, 0]) ** 2 + (flow[best, 1] - flow[j, 1]) ** 2)
        agreeing[j] = apart < 5 * AGREEING_PX
    return agreeing


@inlined
def _weighted_similarity(before: Array, after: Array, weights: Array, found: Array) -> None:
    total = x = y = to_x = to_y = 0.0
    for i in range(len(weights)):
        total += weights[i]
        x += weights[i] * before[i, 0]
        y += weights[i] * before[i, 1]
        to_x += weights[i] * after[i, 0]
        to_y += weights[i] * after[i, 1]
    x, y, to_x, to_y = x / total, y / total, to_x / total, to_y / total
    spread, along, across = 1e-9, 0.0, 0.0
    for i in range(len(weights)):
        dx, dy = before[i, 0] - x, before[i, 1] - y
        ex, ey = after[i, 0] - to_x, after[i, 1] - to_y
        spread += weights[i] * (dx * dx + dy * dy)
        along += weights[i] * (dx * ex + dy * ey)
        across += weights[i] * (dx * ey - dy * ex)
    along, across = along / spread, across / spread
    found[0, 0], found[0, 1], found[0, 2] = along, -across, to_x - along * x + across * y
    found[1, 0], found[1, 1], found[1, 2] = across, along, to_y - across * x - along * y


@compiled(_MATRIX(_POINTS, _POINTS))
def shared_similarity(before: Array, after: Array) -> Array:
    """See `shared_motion.shared_similarity`."""
    found = np.zeros((2, 3))
    found[0, 0] = found[1, 1] = 1.0
    count, resting = len(before), 0
    for i in range(count):
        apart = np.hypot(after[i, 0] - before[i, 0], after[i, 1] - before[i, 1])
        resting += apart < AGREEING_PX
    if count < LEAST_CORNERS or resting >= STILL_SHARE * count:
        return found
    agreeing = _densest(before, after)
    if agreeing.sum() < LEAST_CORNERS:
        return found
    start, end = before[agreeing], after[agreeing]
    weights, residual = np.ones(len(start)), np.empty(len(start))
    for _ in range(FITS):
        _weighted_similarity(start, end, weights, found)
        for i in range(len(start)):
            x, y = start[i, 0], start[i, 1]
            off_x = end[i, 0] - (found[0, 0] * x + found[0, 1] * y + found[0, 2])
            off_y = end[i, 1] - (found[1, 0] * x + found[1, 1] * y + found[1, 2])
            residual[i] = np.sqrt(off_x * off_x + off_y * off_y)
        scale = max(1.5 * np.median(residual), AGREEING_PX / 2)
        weights[:] = 1 / (1 + (residual / scale) ** 2) ** 2
    return found


@inlined
def _turned(before: Array, after: Array, alive: Alive, strayed: float) -> Array:
    """See `shared_motion.shared_turn`."""
    turn = np.eye(2)
    for _ in range(TURN_FITS):
        a = d = TURN_INERTIA
        b = 0.0
        right = TURN_INERTIA * np.eye(2)
        for i in range(len(before)):
            if not alive[i]:
                continue
            x, y = before[i, 0], before[i, 1]
            off_x = after[i, 0] - (x * turn[0, 0] + y * turn[1, 0])
            off_y = after[i, 1] - (x * turn[0, 1] + y * turn[1, 1])
            weight = 1 / (1 + (off_x * off_x + off_y * off_y) / strayed**2)
            a += weight * x * x
            b += weight * x * y
            d += weight * y * y
            for axis in range(2):
                right[0, axis] += weight * x * after[i, axis]
                right[1, axis] += weight * y * after[i, axis]
        determinant = a * d - b * b
        for axis in range(2):
            turn[0, axis] = (d * right[0, axis] - b * right[1, axis]) / determinant
            turn[1, axis] = (a * right[1, axis] - b * right[0, axis]) / determinant
    return turn


@compiled(_ALIVE(_POINTS, _POINTS, _ALIVE, float64))
def staying(before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
    """See `shared_motion.staying`."""
    turn = _turned(before, after, alive, strayed)
    stay = np.empty_like(alive)
    for i in range(len(before)):
        x, y = before[i, 0], before[i, 1]
        off_x = after[i, 0] - (x * turn[0, 0] + y * turn[1, 0])
        off_y = after[i, 1] - (x * turn[0, 1] + y * turn[1, 1])
        stay[i] = alive[i] and np.hypot(off_x, off_y) < strayed
    return stay


@compiled(types.Array(float64, 1, "C")(_POINTS, _POINTS, _SIZE))
def shared_stretch(before: Array, after: Array, size: Array) -> Array:
    """See `shared_motion.shared_stretch`."""
    change = np.zeros(2)
    half = len(before) // 2
    if len(before) < FEWEST_POINTS:
        return change
    ratios = np.empty(half)
    for axis in range(2):
        order = np.argsort(before[:, axis].copy(), kind="mergesort")
        count = 0
        for i in range(half):
            low, high = order[i], order[len(before) - half + i]
            old = before[high, axis] - before[low, axis]
            if old > APART * size[axis]:
                ratios[count] = max((after[high, axis] - after[low, axis]) / old, LEAST_RATIO)
                count += 1
        if count >= FEWEST_POINTS // 2:
            # The logarithm of the middle ones, not the median of all logarithms.
            chosen = np.sort(ratios[:count])
            middle = np.log(chosen[count // 2]) + np.log(chosen[(count - 1) // 2])
            change[axis] = min(max(0.5 * middle, -LARGEST_STRETCH), LARGEST_STRETCH)
    return change


@compiled(float64(_FLOW, _CELLS, _POINTS, _POINTS, _POINTS))
def carried_share(
    flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
) -> float:
    """See `shared_motion.carried_share`."""
    columns, count = cells[1, 0], cells[1, 0] * cells[1, 1]
    place, off, limits = np.empty((count, 2)), np.empty((count, 2)), np.empty(count)
    near = 0
    a = d = TURN_INERTIA
    b = 0.0
    right = np.zeros((2, 2))
    for i in range(count):
        column, row = (cells[0, 0] + i % columns) * CELL, (cells[0, 1] + i // columns) * CELL
        column, row = column + CELL // 2, row + CELL // 2
        x, y = column + 0.5, row + 0.5
        from_x, from_y = x + flow[row, column, 0], y + flow[row, column, 1]
        place[i, 0], place[i, 1] = x * places[0, 0] + places[1, 0], y * places[0, 1] + places[1, 1]
        off[i, 0] = from_x - (x * vehicle[0, 0] + vehicle[1, 0])
        off[i, 1] = from_y - (y * vehicle[0, 1] + vehicle[1, 1])
        limits[i] = STRAYED_PX
        if len(background):
            stays_x = from_x - (x * background[0, 0] + y * background[1, 0] + background[2, 0])
            stays_y = from_y - (x * background[0, 1] + y * background[1, 1] + background[2, 1])
            limits[i] = min(STRAYED_PX, np.sqrt(stays_x * stays_x + stays_y * stays_y))
        if np.sqrt(off[i, 0] ** 2 + off[i, 1] ** 2) < NEARLY * limits[i]:
            near += 1
            a += place[i, 0] * place[i, 0]
            b += place[i, 0] * place[i, 1]
            d += place[i, 1] * place[i, 1]
            for axis in range(2):
                right[0, axis] += place[i, 0] * off[i, axis]
                right[1, axis] += place[i, 1] * off[i, axis]
    turn = np.zeros((2, 2))
    if near >= FEWEST_CARRIED:
        determinant = a * d - b * b
        for axis in range(2):
            turn[0, axis] = (d * right[0, axis] - b * right[1, axis]) / determinant
            turn[1, axis] = (a * right[1, axis] - b * right[0, axis]) / determinant
    carried = 0.0
    for i in range(count):
        off_x = off[i, 0] - (place[i, 0] * turn[0, 0] + place[i, 1] * turn[1, 0])
        off_y = off[i, 1] - (place[i, 0] * turn[0, 1] + place[i, 1] * turn[1, 1])
        carried += np.sqrt(off_x * off_x + off_y * off_y) < limits[i]
    return float(carried / count)

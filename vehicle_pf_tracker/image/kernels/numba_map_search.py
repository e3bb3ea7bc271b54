# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Search of a map close to some places, compiled; `image.correlation.map_search` says what it is.

Numpy needs a dozen calls, each of which takes longer than its few numbers.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.map_search import Places
from vehicle_pf_tracker.image.kernels.numba_types import RECTANGLES
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined

_MAP = "Array(float64, 2, 'C', readonly=True)"
"""Numbers by [y, x]."""


@inlined
def _best_move(values: Array, x: int, y: int, costs: Array) -> tuple[int, int, float]:
    """Find the best move from a place, the first of equal ones, and the gain there."""
    reach = len(costs) // 2
    best_x, best_y = 0, 0
    highest = -np.inf
    for dy in range(-reach, reach + 1):
        # Beyond the border the outermost values are repeated.
        row = min(max(y + dy, 0), values.shape[0] - 1)
        for dx in range(-reach, reach + 1):
            column = min(max(x + dx, 0), values.shape[1] - 1)
            gain = values[row, column] - costs[dy + reach, dx + reach]
            if gain > highest:
                best_x, best_y, highest = dx, dy, gain
    return best_x, best_y, highest


@compiled(f"Tuple(({RECTANGLES}, float64[::1]))", _MAP, RECTANGLES, _MAP)
def climbed(values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
    """Move places to the best value in reach; see `image.correlation.map_search.climbed`."""
    rows, columns = values.shape
    # Numba does not check indices.
    if len(costs) % 2 == 0 or costs.shape[1] != len(costs) or places.shape[1] != 2:
        raise IndexError("the costs are not those of moves to all sides")
    moves = np.empty((len(places), 2), np.int64)
    gains = np.empty(len(places))
    # Many places are the same, and each is searched once.
    first = np.full((rows, columns), -1, np.int64)
    for i in range(len(places)):
        x, y = places[i]
        if not (0 <= x < columns and 0 <= y < rows):
            raise IndexError("a place is beside the map")
        if first[y, x] < 0:
            first[y, x] = i
            moves[i, 0], moves[i, 1], gains[i] = _best_move(values, x, y, costs)
        else:
            moves[i] = moves[first[y, x]]
            gains[i] = gains[first[y, x]]
    return moves, gains

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

"""Climbing on a map, compiled; see `image.climbing` for what it is."""

from __future__ import annotations

import numpy as np
from numba import float64, intp, types

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.climbing import Places
from vehicle_pf_tracker.image.kernels.numba_jit import compiled

_MAP = types.Array(float64, 2, "C", readonly=True)
_PLACES = types.Array(intp, 2, "C")


@compiled(types.Tuple([_PLACES, types.Array(float64, 1, "C")])(_MAP, _PLACES, _MAP))
def climbed(values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
    """See `climbing.climbed`."""
    reach, last = len(costs) // 2, len(values) - 1
    moves, gains = np.zeros_like(places), np.empty(len(places))
    for i in range(len(places)):
        best = -np.inf
        for dy in range(-reach, reach + 1):
            row = min(max(places[i, 1] + dy, 0), last)
            for dx in range(-reach, reach + 1):
                column = min(max(places[i, 0] + dx, 0), last)
                gain = values[row, column] - costs[dy + reach, dx + reach]
                if gain > best:
                    best, moves[i, 0], moves[i, 1] = gain, dx, dy
        gains[i] = best
    return moves, gains

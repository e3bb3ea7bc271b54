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

"""Climbing on a map: the best place close to each of some places, in numpy."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Places = npt.NDArray[np.intp]
"""Places (N, 2) on a map, as x and y."""


def climbed(values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
    """Move places to the best value in reach, less what the move costs.

    Parameters
    ----------
    values : (m, m) array
        The map by [y, x]; beyond its border the outermost values are repeated.
    places : (N, 2) array
        On the map.
    costs : (2 r + 1, 2 r + 1) array
        Of the moves by up to `r` places, by [y, x].

    Returns
    -------
    moves : (N, 2) array
        The best of the moves; of equal ones the first.
    gains : (N,) array
        Value there, less the cost.
    """
    reach, last = len(costs) // 2, len(values) - 1
    offsets = np.arange(-reach, reach + 1)
    dy, dx = (grid.ravel() for grid in np.meshgrid(offsets, offsets, indexing="ij"))
    rows = np.clip(places[:, 1, np.newaxis] + dy, 0, last)
    columns = np.clip(places[:, 0, np.newaxis] + dx, 0, last)
    gains = values[rows, columns] - costs.ravel()
    best = gains.argmax(axis=1)
    return np.column_stack([dx[best], dy[best]]), gains[np.arange(len(best)), best]

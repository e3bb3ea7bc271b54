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

"""Row of the horizon, from how vehicles grow on their way through the image.

On a plane a vehicle's width is proportional to the distance of its lower edge from the horizon, so
that the line through its widths over its lower edges is zero there.
"""

from __future__ import annotations

import bisect
from collections import deque

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.road.plane import RoadPlane

_LEAST_WAY = 0.15
"""Scatter of a vehicle's lower edges, from the highest to the lowest, of the image's height, from
which on its growth tells the horizon."""
_LEAST_BOXES = 20
_REMEMBERED = 51
"""Vehicles that are remembered."""
_PRIOR = 3
"""Vehicles that the assumed horizon counts as."""
_HIGHEST, _LOWEST = -2.0, 0.7
"""Bounds of a row, of the image's height: above, perspective is none; below is no road."""


class Growth:
    """Regression of one vehicle's widths on its lower edges, in px."""

    def __init__(self) -> None:
        self._sums = np.zeros(5)
        self._span = (np.inf, -np.inf)

    def add(self, edges: Array) -> None:
        """Add a detection (4,) that shows the whole vehicle."""
        width, bottom = float(edges[2] - edges[0]), float(edges[3])
        self._sums += (1.0, bottom, bottom**2, width, bottom * width)
        self._span = (min(self._span[0], bottom), max(self._span[1], bottom))

    def horizon(self, height: int) -> float | None:
        """Row of the horizon, of the image's height; None where the vehicle does not tell."""
        count, total, squares, widths, products = self._sums.tolist()
        if count < _LEAST_BOXES or self._span[1] - self._span[0] < _LEAST_WAY * height:
            return None
        scatter = squares - total * total / count
        slope = (products - total * widths / count) / max(scatter, 1e-9)
        if slope <= 0:
            return _HIGHEST
        row = (total - widths / slope) / count / height
        return float(min(max(row, _HIGHEST), _LOWEST))


def calibrated_row(road: RoadPlane, size: tuple[int, int]) -> float:
    """Row of a calibrated road's horizon in the image's middle column, of the image's height.

    Parameters
    ----------
    road : RoadPlane
        Map from the image to the road.
    size : (int, int)
        Width and height of the image.
    """
    width, height = size
    across, down, level = road.homography.matrix[2].tolist()
    if down <= 0:  # it looks straight down, or stands on its head
        return _HIGHEST
    row = -(across * width / 2 + level) / down / height
    return float(min(max(row, _HIGHEST), _LOWEST))


class Horizon:
    """Median over vehicles of the rows that their growth tells."""

    def __init__(self) -> None:
        self._rows: deque[float] = deque(maxlen=_REMEMBERED)

    def learn(self, growth: Growth, height: int) -> None:
        """Add a vehicle whose way has ended."""
        row = growth.horizon(height)
        if row is not None:
            self._rows.append(row)

    def row(self, assumed: float) -> float:
        """Row of the horizon, of the image's height.

        Parameters
        ----------
        assumed : float
            That is assumed before vehicles tell.
        """
        rows = sorted(self._rows)
        for _ in range(_PRIOR):
            bisect.insort(rows, assumed)
        return rows[len(rows) // 2]

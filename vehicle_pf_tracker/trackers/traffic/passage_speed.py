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

"""Speed of a vehicle as it passes a line."""

from __future__ import annotations

from collections import deque

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.road.motion import KMH
from vehicle_pf_tracker.road.plane import RoadPlane

_WINDOW_NS = 500_000_000
"""Length of path that a speed is taken from, ns: at 30 frames/s, an error of 1 px of each of the 15
positions leaves 2 px/s, and no car changes its speed by more than 15 km/h meanwhile."""
_FEWEST = 3
"""Positions that a speed needs; of two, all the error is the speed's."""
_MOST = 120
"""Positions kept; those of a camera with 240 frames/s."""


class PassageSpeed:
    """Slope of a vehicle's path over time.

    Parameters
    ----------
    plane : RoadPlane or None
        Road, for speeds in km/h.
    """

    def __init__(self, plane: RoadPlane | None) -> None:
        self._plane = plane
        self._path: deque[tuple[int, Position]] = deque(maxlen=_MOST)

    def add(self, point: Position, stamp_ns: int) -> None:
        """Take the next position in px."""
        self._path.append((stamp_ns, point))
        while stamp_ns - self._path[0][0] > _WINDOW_NS:
            self._path.popleft()

    def clear(self) -> None:
        """Forget the path."""
        self._path.clear()

    def pixels(self) -> float | None:
        """Speed in px/s; None where the path is too short."""
        return _slope(self._stamps(), self._points())

    def kmh(self) -> float | None:
        """Speed on the road in km/h; None where it has no road, or the path is too short."""
        if self._plane is None or len(self._path) < _FEWEST:
            return None
        points = self._points()
        if any(self._plane.objection(self._plane.ideal(point)) for point in points):
            return None
        slope = _slope(self._stamps(), self._plane.to_road(points))
        return None if slope is None else slope * KMH

    def _stamps(self) -> Array:
        # Differences of integers: a stamp in s since 1970 has no digits left for milliseconds.
        first = self._path[0][0] if self._path else 0
        return np.array([(stamp_ns - first) * 1e-9 for stamp_ns, _ in self._path])

    def _points(self) -> Array:
        return np.array([point for _, point in self._path]).reshape(-1, 2)


def _slope(seconds: Array, points: Array) -> float | None:
    """Return the length of the least-squares velocity, per s."""
    if len(seconds) < _FEWEST:
        return None
    since = seconds - seconds.mean()
    spread = float(since @ since)
    return float(np.linalg.norm(since @ points / spread)) if spread > 0 else None

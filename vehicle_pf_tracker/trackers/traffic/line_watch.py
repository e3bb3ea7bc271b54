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

"""Crossings of one line by one vehicle."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.parameters.counting_plan import CountingLine
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

_MARGIN = 0.1
"""Distance from a line at which a vehicle is clearly on one side, in heights of its box. Of two
detectors on a real highway, the lower edges of nine boxes in ten lay within 9 and 12 % of the
height around the true ones: closer to the line, a standing vehicle could be on either side."""
_LEAST_MARGIN = 1.0
"""The same in px, for the smallest boxes: detections are rounded to whole pixels."""


@dataclass(frozen=True, slots=True)
class Place:
    """Position of a vehicle in one image.

    Attributes
    ----------
    point : (float, float)
        Middle of the box's lower edge, px.
    stamp_ns : int
        Stamp of the image in ns.
    height : float
        Height of the box in px.
    mode : TrackMode
        Claim about the vehicle.
    """

    point: Position
    stamp_ns: int
    height: float
    mode: TrackMode

    @property
    def margin(self) -> float:
        """Distance in px over which a standing vehicle may seem to move."""
        return max(_LEAST_MARGIN, _MARGIN * self.height)

    def towards(self, other: Place, share: float) -> Place:
        """Return the place that lies `share` of the way to `other`, with the mode of that one."""
        (x, y), (to_x, to_y) = self.point, other.point
        point = x + share * (to_x - x), y + share * (to_y - y)
        stamp_ns = self.stamp_ns + round(share * (other.stamp_ns - self.stamp_ns))
        return Place(point, stamp_ns, other.height, other.mode)


class LineWatch:
    """Follows one vehicle's side of one line.

    Parameters
    ----------
    line : CountingLine
        The line.
    """

    def __init__(self, line: CountingLine) -> None:
        self.line = line
        self._last: Place | None = None
        self._side = 0
        self._crossed: Place | None = None
        self._done: set[int] = set()
        self._is_predicted = False

    def follow(self, place: Place) -> tuple[str, Place] | None:
        """Take the next place; returns direction, time and point of a crossing that it completes.

        Each direction is returned once. A predicted vehicle that turns back within the same
        occlusion, or is then seen before the line after all, has not crossed it back: the forecast
        was early.
        """
        last, self._last = self._last, place
        distance = self.line.distance(place.point)
        if last is not None:
            self._note_crossing(last, place, distance)
        side = 0 if abs(distance) <= place.margin else 1 if distance > 0 else -1
        passage = self._passage(side, place) if side and side != self._side else None
        if place.mode is not TrackMode.OCCLUDED and side:
            self._is_predicted = False
        return passage

    def _note_crossing(self, last: Place, place: Place, distance: float) -> None:
        """Keep the point at which the path last crossed the line, None where it went past it."""
        before = self.line.distance(last.point)
        if (before > 0) == (distance > 0):
            return
        at = last.towards(place, before / (before - distance))
        self._crossed = at if 0 <= self.line.share(at.point) <= 1 else None

    def _passage(self, side: int, place: Place) -> tuple[str, Place] | None:
        """Change to `side`; returns what that completes."""
        before, self._side = self._side, side
        crossed, self._crossed = self._crossed, None
        if before == 0 or crossed is None or side in self._done or self._is_predicted:
            return None
        self._done.add(side)
        self._is_predicted = TrackMode.OCCLUDED in (crossed.mode, place.mode)
        return self.line.directions[0 if side > 0 else 1], crossed

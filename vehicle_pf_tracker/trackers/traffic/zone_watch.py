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

"""Presence of one vehicle in one zone."""

from __future__ import annotations

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.parameters.counting_plan import CountingZone
from vehicle_pf_tracker.trackers.traffic.line_watch import Place

ENTRY, EXIT = "entry", "exit"
"""Directions of a zone."""


class ZoneWatch:
    """Follows whether one vehicle is in one zone.

    It is in as soon as it has passed the edge, and out when it is clearly outside, so that one
    that shakes on the edge enters once.

    Parameters
    ----------
    zone : CountingZone
        The zone.

    Attributes
    ----------
    is_inside : bool
        True while the vehicle is in the zone.
    """

    def __init__(self, zone: CountingZone) -> None:
        self.zone = zone
        self.is_inside = False
        self._outline = np.array(zone.corners, np.float32)
        self._last: Place | None = None

    def follow(self, place: Place) -> Place | None:
        """Take the next place; returns where and when it entered or left, None if it did neither.

        A vehicle that is inside when it is first seen has not entered.
        """
        depth = self._depth(place.point)
        last, self._last = self._last, place
        was_inside = self.is_inside
        self.is_inside = depth > (-place.margin if was_inside else 0.0)
        if last is None or self.is_inside == was_inside:
            return None
        before = self._depth(last.point)
        # Where the way in or out was already passed (by less than the margin), this step ends it.
        share = before / (before - depth) if before * depth < 0 else 1.0
        return last.towards(place, share)

    def _depth(self, point: Position) -> float:
        """Return the distance from the edge in px; positive inside."""
        return float(cv2.pointPolygonTest(self._outline, point, True))

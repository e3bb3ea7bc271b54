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

"""The vehicle that is reported as that of a single tracker is."""

from __future__ import annotations

import math
from collections.abc import Sequence

from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

NONE = 0
"""Number that ends a selection; vehicles have numbers from 1."""
_SHOWN = 10
"""Numbers of vehicles that an error lists."""


class Selection:
    """Number of the selected vehicle.

    Attributes
    ----------
    identity : int
        Its number; `NONE` where none is selected.
    """

    def __init__(self) -> None:
        self.identity = NONE

    def choose(self, identity: int, estimates: Sequence[TrackEstimate]) -> None:
        """Select a vehicle by its number; `NONE` selects none.

        Raises
        ------
        InputError
            If no vehicle has it.
        """
        numbers = [one.identity for one in estimates]
        if identity != NONE and identity not in numbers:
            known = ", ".join(map(str, numbers[:_SHOWN])) + (", …" if numbers[_SHOWN:] else "")
            there = f"there are {known}" if numbers else "there is none"
            raise InputError(f"no vehicle has the number {identity}; {there}")
        self.identity = identity

    def choose_at(self, point: Position, estimates: Sequence[TrackEstimate]) -> None:
        """Select the vehicle at a point: of several the one with the smallest box.

        Raises
        ------
        InputError
            If there is none, within the size of a vehicle.
        """
        shown = [one for one in estimates if one.mode is not TrackMode.LOST]
        inside = [one for one in shown if _contains(one.box, point)]
        if inside:
            self.identity = min(inside, key=lambda one: (one.box.area, one.identity)).identity
            return
        near = [one for one in shown if _distance(one.box, point) < one.box.diagonal]
        if not near:
            raise InputError(f"there is no vehicle at {point[0]:g},{point[1]:g} px")
        self.identity = min(near, key=lambda one: _distance(one.box, point)).identity

    def clear(self) -> None:
        """Select none."""
        self.identity = NONE

    def of(self, estimates: Sequence[TrackEstimate]) -> TrackEstimate | None:
        """Return the estimate of the selected vehicle, where there is one."""
        return next((one for one in estimates if one.identity == self.identity), None)


def _contains(box: Box, point: Position) -> bool:
    x, y = point
    return box.x <= x < box.x + box.width and box.y <= y < box.y + box.height


def _distance(box: Box, point: Position) -> float:
    return math.dist(box.centre, point)

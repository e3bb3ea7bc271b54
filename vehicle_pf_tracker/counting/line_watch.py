# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle at one counting line."""

from __future__ import annotations

import math

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.count_signs import Sign, missed_at
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.side_watch import Passage, SideWatch
from vehicle_pf_tracker.parameters.counting_plan import CountingLine


class LineEdge:
    """A counting line as an edge: its first direction leads to the positive side.

    Parameters
    ----------
    line : CountingLine
        The line.
    """

    # A line has no far side, as a zone has: no vehicle is too large for it.
    room = math.inf

    def __init__(self, line: CountingLine) -> None:
        self.line = line
        x, y = line.start
        to_x, to_y = line.end
        # The line turned by a quarter to the right, as y points down in an image.
        self._normal = (y - to_y) / line.length, (to_x - x) / line.length

    def distance(self, point: Position) -> float:
        """Return the distance from the endless line in px, positive on the right-hand side."""
        return self.line.distance(point)

    def normal(self, point: Position) -> Position:
        """Return the unit vector to the right-hand side."""
        del point  # it is the same everywhere
        return self._normal

    def has(self, point: Position) -> bool:
        """Test whether a point on the endless line lies between its ends."""
        return 0 <= self.line.share(point) <= 1


class LineWatch:
    """Follows one vehicle over one line, and returns each direction once.

    Parameters
    ----------
    edge : LineEdge
        The line.
    """

    def __init__(self, edge: LineEdge) -> None:
        self.line = edge.line
        self._watch = SideWatch(edge)
        self._done: set[str] = set()

    def follow(self, foot: FootPoint, path: RecentPath) -> list[tuple[str, FootPoint]]:
        """Take the next point; returns direction, time and point of a crossing it completes."""
        return self._new(self._watch.follow(foot, path))

    def resume(self, before: LineWatch) -> list[tuple[str, FootPoint]]:
        """Go on from the track of the same vehicle before it was hidden, in the same way."""
        # First: what was counted before the gap is not counted again by the passage that ends it.
        self._done |= before._done
        return self._new(self._watch.resume(before._watch))

    def missed(self, *, has_ended: bool) -> tuple[str, Sign] | None:
        """Return the direction in which it may have crossed uncounted, and the sign; or None."""
        ends = self._watch.ends
        found = None if ends is None else missed_at(self._watch.edge, *ends, has_ended=has_ended)
        if found is None:
            return None
        side, sign = found
        direction = self._direction(side)
        # Having been counted in this direction, it has missed nothing there.
        return None if direction in self._done else (direction, sign)

    def _direction(self, side: int) -> str:
        return self.line.directions[0 if side > 0 else 1]

    def _new(self, passage: Passage | None) -> list[tuple[str, FootPoint]]:
        if passage is None:
            return []
        direction = self._direction(passage.side)
        if direction in self._done:
            return []
        # Once for good: a vehicle that comes round again in this direction is the same one.
        self._done.add(direction)
        return [(direction, passage.at)]

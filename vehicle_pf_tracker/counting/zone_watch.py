# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle at one zone."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.side_watch import Passage, SideWatch
from vehicle_pf_tracker.parameters.counting_plan import CountingZone

ZONE_ENTRY = "entry"
"""Direction of what drives into a zone."""
ZONE_EXIT = "exit"
"""Direction of what drives out of it."""
_GRID = 32
"""Points across a zone among which its middle is looked for: it is then known to a few percent."""
_MOST_STEPS = 64
"""Steps that a path between two images is cut into: a zone smaller than a sixtieth of it is passed
within a step even of a vehicle that crosses the whole image."""


class ZoneEdge:
    """The outline of a zone as an edge: its positive side is inside.

    Parameters
    ----------
    zone : CountingZone
        The zone.

    Attributes
    ----------
    zone : CountingZone
        The same.
    room : float
        Distance of its innermost point from the outline, px.
    """

    def __init__(self, zone: CountingZone) -> None:
        self.zone = zone
        self._outline = np.array(zone.corners, np.float32)
        low = self._outline.min(axis=0)
        high = self._outline.max(axis=0)
        steps = (np.arange(_GRID) + 0.5) / _GRID
        across, down = (low + np.outer(steps, high - low)).T.tolist()
        # At least a px, as the grid may miss the inside of a sliver.
        self.room = max(1.0, *(self.distance((x, y)) for x in across for y in down))

    def distance(self, point: Position) -> float:
        """Return the distance from the outline in px, positive inside."""
        return float(cv2.pointPolygonTest(self._outline, point, True))

    def normal(self, point: Position) -> Position:
        """Return the unit vector across the side of the zone that is nearest to a point."""
        begin = self._outline
        along = np.roll(begin, -1, axis=0) - begin
        # Two corners on one point make a side without length.
        squares = np.maximum((along**2).sum(axis=1), np.finfo(np.float32).tiny)
        # Nearest point on each side of the outline, as a share of the side.
        shares = (((np.array(point) - begin) * along).sum(axis=1) / squares).clip(0, 1)
        away = np.array(point) - (begin + shares[:, np.newaxis] * along)
        x, y = along[np.argmin((away**2).sum(axis=1))].tolist()
        length = math.hypot(x, y)
        return (-y / length, x / length) if length else (1.0, 0.0)

    def has(self, point: Position) -> bool:
        """Tell that the outline has no ends."""
        del point
        return True


class ZoneWatch:
    """Follows whether one vehicle is in one zone.

    Parameters
    ----------
    edge : ZoneEdge
        The zone.

    Attributes
    ----------
    is_inside : bool
        True while the vehicle is in the zone. One that is first seen on the outline stays where it
        seemed to be until it is clearly on one side.
    """

    def __init__(self, edge: ZoneEdge) -> None:
        self.zone = edge.zone
        self.is_inside = False
        self._watch = SideWatch(edge)
        self._last: FootPoint | None = None

    def follow(self, foot: FootPoint, path: RecentPath) -> list[tuple[str, FootPoint]]:
        """Take the next point; returns direction, time and point of entries and exits.

        A vehicle that is inside when it is first seen has not entered. One that was on both sides
        of the zone in two images has passed through it.
        """
        last = self._last
        self._last = foot
        if last is None:
            # Without a margin: the occupancy needs an answer now, and no entry is counted by it.
            self.is_inside = self._watch.edge.distance(foot.point) > 0
        between = [] if last is None else self._between(last, foot)
        return self._new([self._watch.follow(at, path) for at in (*between, foot)])

    def _between(self, last: FootPoint, foot: FootPoint) -> list[FootPoint]:
        """Return points of the path between two images by which it cannot miss the zone."""
        edge = self._watch.edge
        apart = math.dist(last.point, foot.point)
        if abs(edge.distance(last.point) + edge.distance(foot.point)) >= apart:
            return []  # it cannot have reached the outline and come back
        # Steps of half the zone's inner radius: none can go in and out again between two points.
        steps = min(math.ceil(2 * apart / edge.room), _MOST_STEPS)
        return [last.towards(foot, step / steps) for step in range(1, steps)]

    def resume(self, before: ZoneWatch) -> list[tuple[str, FootPoint]]:
        """Go on from the track of the same vehicle before it was hidden, in the same way."""
        return self._new([self._watch.resume(before._watch)])

    def _new(self, passages: list[Passage | None]) -> list[tuple[str, FootPoint]]:
        if self._watch.side:
            # Until the side is clear, what the first point has said stands.
            self.is_inside = self._watch.side > 0
        done = [passage for passage in passages if passage is not None]
        return [(ZONE_ENTRY if passage.side > 0 else ZONE_EXIT, passage.at) for passage in done]

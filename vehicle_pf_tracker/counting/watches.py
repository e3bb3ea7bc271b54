# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle at one place: crossings of a line, presence in a zone, and speed of the passage."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingZone
from vehicle_pf_tracker.road.motion import KMH
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

_LEAST_MARGIN = 1.0
"""Distance from a line in px at which the smallest box is clearly on one side: detections are
rounded to whole pixels."""
_SEEMS_TO_MOVE = 0.1
"""Distance, of its height, over which a standing vehicle may seem to move; see `Place.margin`."""


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
        """Distance in px over which a standing vehicle may seem to move.

        Of two detectors on a real highway, the lower edges of nine boxes in ten lay within 9 and
        12 % of the height around the true ones.
        """
        return max(_LEAST_MARGIN, _SEEMS_TO_MOVE * self.height)

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

    def join(self, before: LineWatch) -> None:
        """Go on from the track of the same vehicle before it was hidden."""
        self._done |= before._done

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


_WINDOW_NS = 500_000_000
"""Length of path that a speed is taken from, ns: at 30 frames/s, an error of 1 px of each of the 15
positions leaves 2 px/s, and no car changes its speed by more than 15 km/h meanwhile."""
_FEWEST = 3
"""Positions that a speed needs; of two, all the error is the speed's."""


class PassageSpeed:
    """Slope of a vehicle's path over time.

    Parameters
    ----------
    plane : RoadPlane or None
        Road, for speeds in km/h.
    """

    def __init__(self, plane: RoadPlane | None) -> None:
        self._plane = plane
        self._path: deque[tuple[int, Position]] = deque()

    def add(self, point: Position, stamp_ns: int) -> None:
        """Take the next position in px."""
        self._path.append((stamp_ns, point))
        while stamp_ns - self._path[0][0] > _WINDOW_NS:
            self._path.popleft()

    def clear(self) -> None:
        """Discard the path."""
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

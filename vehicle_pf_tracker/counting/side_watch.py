# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Side of an edge on which one vehicle is, decided against the noise of its position.

A vehicle that waits on a line shakes over it by the noise of its boxes, which no fixed margin
holds: it is the detector's, and may be a quarter of the box. Two rules make one crossing of it.

1. A side counts when the vehicle is clearly there: the latest point by the tracker's covariance,
   and the end of a steady drive through the last half second by the scatter of the points.
2. A passage needs a real drive: between the furthest point on the one side and the latest on the
   other the vehicle has driven further than noise does in hundreds of images. Back again it must
   drive at least as far as the vehicle is long.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

_SETTLED = 3.0
"""Standard deviations from the edge at which the end of a steady drive is clearly on one side: it
is tried some ten times in a stop of 6 s, and chance does it once in 740."""
_AT_ONCE = 5.0
"""Standard deviations that a dozen images of a standing vehicle do not span, where they are too
rare for the end of a steady drive; the span is 3.3 in the mean."""
_RANGE = 8.0
"""Standard deviations that noise does not span: 360 images of a standing vehicle (6 s of 60 Hz)
span 6 in the mean, and more than 8 in one of a thousand stops."""
_FORESEEN = 4.0
"""Standard deviations of a prediction within which a hidden vehicle may not have driven at all: it
is one draw, not hundreds."""


class Edge(Protocol):
    """Edge with two sides: a line, or the outline of a zone.

    Attributes
    ----------
    room : float
        Largest distance from it on its positive side, px.
    """

    room: float

    def distance(self, point: Position) -> float:
        """Return the distance of a point in px, positive on the one side."""
        ...

    def normal(self, point: Position) -> Position:
        """Return the unit vector across the edge where it is nearest to a point."""
        ...

    def has(self, point: Position) -> bool:
        """Test whether a passage at this point is one over the edge, and not past its ends."""
        ...


@dataclass(frozen=True, slots=True)
class Passage:
    """Passage of one vehicle over an edge.

    Attributes
    ----------
    side : int
        Side that it came to: 1 or -1.
    at : FootPoint
        Where and when it crossed, between two images.
    """

    side: int
    at: FootPoint


class SideWatch:
    """Follows the side of one edge that one vehicle is on.

    Parameters
    ----------
    edge : Edge
        The edge.

    Attributes
    ----------
    edge : Edge
        The same.
    side : int
        1 or -1; 0 until it is known.
    """

    def __init__(self, edge: Edge) -> None:
        self.edge = edge
        self.side = 0
        self._began = 0  # the first side that was known
        self._first: FootPoint | None = None
        self._last: FootPoint | None = None
        self._seen: FootPoint | None = None  # the last that was not predicted
        self._furthest = 0.0  # distance of the furthest point that was seen on the present side
        self._over: FootPoint | None = None  # where the path last went over the edge
        self._changed_ns = 0  # when it came to the present side
        self._passages = 0  # without those that were predicted, and not made
        self._is_forecast = False  # the present side is predicted, and not yet confirmed
        self._ahead = 0  # side of a passage that was returned while it was predicted

    def follow(self, foot: FootPoint, path: RecentPath) -> Passage | None:
        """Take the next point of a path that has it, and return a passage that it completes.

        A predicted vehicle that is then seen on the other side after all has not passed back: the
        forecast was early, and its passage is not returned again.
        """
        # The order matters: the point of the crossing is needed where the side changes, and the
        # furthest point is one on the side that it is on after that.
        distance = self.edge.distance(foot.point)
        self._note_crossing(foot, distance)
        side = self._clear_side(foot, distance, path)
        passage = None
        if side and side == self.side:
            self._over = None  # it was noise, or it turned round before it was clearly over
        elif side and self._may_change(side, foot, distance, path):
            passage = self._change(side, foot)
        self._note_furthest(foot, distance, is_clear=bool(side))
        return passage

    @property
    def ends(self) -> tuple[FootPoint, FootPoint] | None:
        """First and last point at which the vehicle was seen; None where it never was."""
        if self._first is None or self._seen is None:
            return None
        return self._first, self._seen

    def _note_furthest(self, foot: FootPoint, distance: float, *, is_clear: bool) -> None:
        """Keep the furthest point on the present side, by which a drive back is measured."""
        if foot.is_seen:
            self._seen = foot
            if is_clear and self._is_forecast:  # confirmed: where it was predicted is no drive
                self._is_forecast = False
                self._ahead = 0
                self._furthest = distance
        if foot.is_seen or self._is_forecast:
            self._furthest = self.side * max(self.side * distance, self.side * self._furthest)

    def resume(self, before: SideWatch) -> Passage | None:
        """Go on from the track of the same vehicle before it was hidden.

        Returns
        -------
        Passage or None
            What lies between the last point seen of that one and the first of this, at a straight
            drive.
        """
        if not before.side:
            # The earlier track was on no clear side: there is nothing to go on from.
            return None
        # Passages are those of the vehicle: only its first needs no drive of its own length.
        self._passages += before._passages
        self._ahead = self._ahead or before._ahead
        if not self.side:
            # Not clear yet: it stays on the side of before until its own points say otherwise.
            self.side = self._began = before.side
            self._furthest = before._furthest
            self._is_forecast = before._is_forecast
            return None
        # The side on which this track began: what it did since is counted by its own passages.
        side = self._began
        self._began = before._began
        if side == before.side:
            return None
        # From the first detection of this track on, that of before followed something else.
        began_ns = self._first.stamp_ns if self._first else 0
        if before._is_forecast or before._changed_ns > began_ns:
            self._ahead = before.side if before._passages else 0
            self._passages -= self._ahead == before.side
            return None
        return self._between(before, side)

    def _between(self, before: SideWatch, side: int) -> Passage | None:
        first = self._first
        last = before._seen
        if first is None or last is None:
            return None
        begin = self.edge.distance(last.point)
        end = self.edge.distance(first.point)
        # One of both may lie on the edge, within the noise, on the side that it did not come to.
        at = last.towards(first, begin / (begin - end)) if begin * end < 0 else first
        seen = min(abs(begin), abs(before._furthest))  # the rest of the way was predicted
        # As in `_may_change`: back over the edge it must have driven its own length.
        is_back = before._passages and seen + abs(end) < first.extent(self.edge.normal(at.point))
        if is_back or not self.edge.has(at.point):
            return None
        return self._passed(side, replace(at, mode=TrackMode.LOST))

    def _note_crossing(self, foot: FootPoint, distance: float) -> None:
        """Keep the point at which the path last went over the edge."""
        last = self._last
        self._last = foot
        if last is None:
            self._first = foot
            return
        before = self.edge.distance(last.point)
        if (before > 0) == (distance > 0):
            return
        at = last.towards(foot, before / (before - distance))
        if self.edge.has(at.point):
            self._over = at

    def _clear_side(self, foot: FootPoint, distance: float, path: RecentPath) -> int:
        """Return the side that the vehicle is clearly on; 0 on neither."""
        side = 1 if distance > 0 else -1
        # In a zone smaller than its vehicles, half of the way to the middle has to do.
        most = self.edge.room / 2
        # The first side may be wrong: it is the drive from there that makes a passage.
        if abs(distance) <= min(foot.margin if self.side else foot.rounding, most):
            return 0
        # The test by scatter is for a change of side of a point that was seen: predicted points
        # scatter around nothing, and points between two images are not in the path.
        is_known = self.side not in (0, side)
        if not (is_known and foot.is_seen and path.ends_at(foot)):
            return side
        settled = path.settled()
        if settled is None:
            return side
        end, share = settled
        scatter = path.scatter(self.edge.normal(foot.point))
        margin = min(_SETTLED * share * scatter, most)
        return side if side * self.edge.distance(end) > margin else 0

    def _may_change(self, side: int, foot: FootPoint, distance: float, path: RecentPath) -> bool:
        """Test whether the vehicle has really driven from its present side to this one."""
        if not self.side or (self._is_forecast and foot.is_seen):
            return True
        # From the furthest point, not from the edge: noise around a standing vehicle spans little.
        driven = side * (distance - self._furthest)
        normal = self.edge.normal(foot.point)
        scatter = path.scatter(normal)
        if not self._passages:
            return driven >= _AT_ONCE * scatter
        # Any later passage may be the shake of a vehicle that waits on the edge; in a zone smaller
        # than itself it cannot drive its own length.
        needed = max(_RANGE * scatter, min(foot.extent(normal), self.edge.room))
        if not foot.is_seen:
            needed = max(needed, _FORESEEN * foot.deviation(normal))
        return driven >= needed

    def _change(self, side: int, foot: FootPoint) -> Passage | None:
        """Be on another side; returns the passage to it."""
        before = self.side
        self.side = side
        over = self._over
        self._over = None
        self._furthest = 0.0
        self._changed_ns = foot.stamp_ns
        if not before:
            self._began = side
            return None
        if self._is_forecast and foot.is_seen:
            # Seen on the other side after all: the forecast passage is taken back, not made again.
            self._is_forecast = False
            self._passages -= self._ahead == before
            return None
        self._is_forecast = not foot.is_seen
        passage = None if over is None else self._passed(side, over)
        if passage is not None and self._is_forecast:
            self._ahead = side
        return passage

    def _passed(self, side: int, at: FootPoint) -> Passage | None:
        self._passages += 1
        if self._ahead == side:  # it was returned when it was predicted
            self._ahead = 0
            return None
        return Passage(side, at)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Latest path of one vehicle: its speed, and how far its points scatter around a steady drive."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.road.motion import KMH_PER_MS
from vehicle_pf_tracker.road.plane import RoadPlane

_STEADY_NS = 500_000_000
"""Length of path in ns that is taken as one speed: at 30 frames/s, an error of 1 px of each of the
15 positions leaves 2 px/s, and no car changes its speed by more than 15 km/h meanwhile."""
_STRAIGHT_NS = 200_000_000
"""Length of path in ns that is straight whatever the driver does: at 1 g it bends by 5 cm."""
_FEWEST_POSITIONS = 3
"""Positions that a speed needs; of two, all the error is the speed's."""
_SETTLED = 4
"""Positions that the end of a steady drive needs: two more than a drive at one speed takes up."""
_ASSUMED = 0.25
"""Standard deviation, of the box, of a point of which nothing is known: that of poor detectors."""
_ASSUMED_BY = 2
"""Positions that this assumption outweighs: after half a second at 30 Hz it is a third of it."""
_OVERLAP = 0.5
"""Independent values of each three positions in a row: the next three share two of them."""
_REMEMBERED_NS = 4 * 10**9
"""Path in ns that a scatter is taken from: what a detector does changes with the distance."""
_REMEMBERED = 24
"""Positions that it is taken from at least, where images are rare: they give it to a fifth."""

_MOST_REMEMBERED = 1000
"""Positions that are kept at most, four seconds of 250 images each: where the stamps of a camera
stand still, no time lets go of those of a parked vehicle."""


class RecentPath:
    """Latest points of one vehicle.

    Parameters
    ----------
    plane : RoadPlane or None
        Road, for speeds in km/h.
    """

    def __init__(self, plane: RoadPlane | None = None) -> None:
        self._plane = plane
        self._points: deque[FootPoint] = deque(maxlen=_MOST_REMEMBERED)
        self._scatter: list[tuple[Array, float]] | None = None

    def add(self, foot: FootPoint) -> None:
        """Take the point of the next image."""
        points = self._points
        points.append(foot)
        self._scatter = None
        # Both bounds have to be passed: where images are rare, old points are kept for the number.
        while len(points) > _REMEMBERED and foot.stamp_ns - points[0].stamp_ns > _REMEMBERED_NS:
            points.popleft()

    def clear(self) -> None:
        """Discard the path."""
        self._points.clear()
        self._scatter = None

    def ends_at(self, foot: FootPoint) -> bool:
        """Test whether this is its latest point, and none between two images."""
        # By identity: points that `towards` makes between two images may share its stamp.
        return bool(self._points) and self._points[-1] is foot

    def pixels(self) -> float | None:
        """Speed in px/s; None where the path is too short."""
        latest = self._latest()
        return _speed(*_arrays(latest)) if len(latest) >= _FEWEST_POSITIONS else None

    def kmh(self) -> float | None:
        """Speed on the road in km/h; None where it has no road, or the path is too short."""
        latest = self._latest()
        if self._plane is None or len(latest) < _FEWEST_POSITIONS:
            return None
        seconds, points = _arrays(latest)
        # Outside its calibrated area the plane extrapolates: no speed is better than a wrong one.
        if any(self._plane.objection(self._plane.ideal(point)) for point in points):
            return None
        speed = _speed(seconds, self._plane.to_road(points))
        return None if speed is None else speed * KMH_PER_MS

    def scatter(self, normal: Position) -> float:
        """Return the standard deviation along a unit vector around a steady drive, px.

        Predicted points follow no vehicle, and are left out.
        """
        if not self._points:
            return 0.0
        # Kept until the next point: every line and zone asks for it along a normal of its own.
        if self._scatter is None:
            path = [foot for foot in self._points if foot.is_seen]
            # Noise of a detector differs from image to image, that of a tracker's estimates less.
            scales = {1, _images_in(path, _STRAIGHT_NS)}
            self._scatter = [_bends(path, apart) for apart in scales if len(path) > 2 * apart]
        along = np.array(normal)
        # A prior of `_ASSUMED_BY` points: a few that happen to lie straight do not prove that
        # there is no noise. Of the scales the worst counts, as too much noise only delays a
        # passage.
        assumed = (_ASSUMED * self._points[-1].extent(normal)) ** 2
        variances = [
            (_ASSUMED_BY * assumed + max(float(along @ products @ along), 0.0))
            / (_ASSUMED_BY + free)
            for products, free in self._scatter
        ]
        return math.sqrt(max(variances, default=assumed))

    def settled(self) -> tuple[Position, float] | None:
        """Return where a steady drive ends, px, and its standard deviation, of one point's.

        None where images are too rare: a drive of more than half a second is not steady.
        """
        piece = [foot for foot in self._latest(_STRAIGHT_NS) if foot.is_seen]
        if len(piece) < _SETTLED:
            return None
        seconds, points = _arrays(piece)
        since = seconds - seconds.mean()
        spread = float(since @ since)
        if spread <= 0:
            return None
        # The end of the line of regression; its variance, of one point's, is least in the middle.
        x, y = points.mean(axis=0) + since[-1] * (since @ points / spread)
        return (float(x), float(y)), math.sqrt(1 / len(piece) + float(since[-1]) ** 2 / spread)

    def _latest(self, length_ns: int = _STEADY_NS) -> list[FootPoint]:
        last_ns = self._points[-1].stamp_ns if self._points else 0
        return [foot for foot in self._points if last_ns - foot.stamp_ns <= length_ns]


def _arrays(path: list[FootPoint]) -> tuple[Array, Array]:
    """Return times since the first in s, (N,), and points in px, (N, 2)."""
    # Differences of integers: a stamp in s since 1970 has no digits left for milliseconds.
    seconds = [(foot.stamp_ns - path[0].stamp_ns) * 1e-9 for foot in path]
    return np.array(seconds), np.array([foot.point for foot in path]).reshape(-1, 2)


def _speed(seconds: Array, points: Array) -> float | None:
    """Return the length of the least-squares velocity, per s."""
    since = seconds - seconds.mean()
    spread = float(since @ since)
    return float(np.linalg.norm(since @ points / spread)) if spread > 0 else None


def _images_in(path: list[FootPoint], length_ns: int) -> int:
    """Return the number of images in a time in ns, at least 1."""
    if len(path) < 2:
        return 1
    whole_ns = max(path[-1].stamp_ns - path[0].stamp_ns, 1)
    return max(1, round(length_ns * (len(path) - 1) / whole_ns))


def _bends(path: list[FootPoint], apart: int) -> tuple[Array, float]:
    """Return how far points are from straight drives between those so many images before and after.

    These are products (2, 2) in px² of one point's error, and the number of independent ones.
    """
    seconds, points = _arrays(path)
    first = slice(None, -2 * apart)
    middle = slice(apart, -apart)
    last = slice(2 * apart, None)
    # Two images of one stamp would divide by zero.
    whole = np.maximum(seconds[last] - seconds[first], np.finfo(float).tiny)
    share = ((seconds[middle] - seconds[first]) / whole)[:, np.newaxis]
    bends = points[middle] - (1 - share) * points[first] - share * points[last]
    # A bend has the errors of three points: scaled so that it has the variance of one.
    bends /= np.sqrt(1 + share**2 + (1 - share) ** 2)
    return _OVERLAP * (bends.T @ bends), _OVERLAP * len(bends)

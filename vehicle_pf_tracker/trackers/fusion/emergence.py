"""A hidden vehicle that comes out where nobody foretold it: a blob that was not there before."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.trackers.fusion.foreground import Blob, Span
from vehicle_pf_tracker.trackers.fusion.history import Trend
from vehicle_pf_tracker.trackers.fusion.turning import Colour, Turns

_FRAMES = 4
"""Latest frames of a blob that its velocity and its growth are taken from."""
_THERE_BEFORE = 2.0
"""Frames hidden up to which blobs that are seen are others: the target has just gone."""
_REACH = 1.3
"""How far it may have come, of the way at its last speed."""
_LEAST_AREA = 0.06
_MOVES = 0.02
_GAP = 2.0
_COLOURED = 0.6


@dataclass(frozen=True, slots=True, eq=False)
class _Sighting:
    time: float
    blob: Blob


@dataclass(frozen=True, slots=True, eq=False)
class Emerged:
    """The blob that has to be the target, and its velocity in px per frame."""

    blob: Blob
    velocity: Position


class Emergence:
    """Watches the surroundings of the place where a target went out of sight.

    Parameters
    ----------
    turns : Turns
        Knows how the target's blob looks.
    extent : float
        Geometric mean of the sides of the target's box, px.
    """

    def __init__(self, turns: Turns, extent: float) -> None:
        self._turns = turns
        self._extent = extent
        self._time = 0.0
        self._tracks: list[list[_Sighting]] = []

    def look(self, frame: Frame, trend: Trend, elapsed: float, colour: Colour) -> Emerged | None:
        """Follow all blobs around; returns the one that is proven to be the target.

        Parameters
        ----------
        frame : (H, W, 3) array
            RGB.
        trend : Trend
            Motion of the target when it was seen last.
        elapsed : float
            Frames since the last one.
        colour : callable
            Gives the share of pixels that speaks for the target.
        """
        self._time += elapsed
        foreground, area = self._turns.foreground, self._turns.usual_area
        speed = math.hypot(*trend.motion.velocity)
        if foreground is None or area is None or speed < _MOVES * self._extent:
            self._tracks = []
            return None
        reach = _REACH * speed * trend.age + self._extent
        span = _square(frame, trend.motion.place, reach)
        blobs = foreground.blobs(frame, span, _LEAST_AREA * area)
        self._tracks = [self._continued(one, speed) for one in blobs]
        for track in self._tracks:
            if self._is_new(track) and _comes_out(track, trend, area, self._extent):
                emerged = track[-1].blob
                if colour(emerged.pixels) >= _COLOURED * self._turns.usual_colour:
                    return Emerged(emerged, _velocity(track))
        return None

    def _continued(self, blob: Blob, speed: float) -> list[_Sighting]:
        """Give the track that a blob goes on with, or a new one."""
        (x, y), (width, height) = blob.centre, blob.size
        now = _Sighting(self._time, blob)
        for track in self._tracks:
            last = track[-1]
            (u, v), (wide, high) = last.blob.centre, last.blob.size
            near_x = abs(x - u) < (width + wide) / 4 + speed
            near_y = abs(y - v) < (height + high) / 4 + speed
            if near_x and near_y and self._time - last.time <= _GAP:
                return [*track, now]
        return [now]

    def _is_new(self, track: list[_Sighting]) -> bool:
        return len(track) >= _FRAMES and track[0].time > _THERE_BEFORE


def _velocity(track: list[_Sighting]) -> Position:
    first, last = track[-_FRAMES], track[-1]
    (x, y), (u, v) = first.blob.centre, last.blob.centre
    time = last.time - first.time
    return (u - x) / time, (v - y) / time


def _comes_out(track: list[_Sighting], trend: Trend, area: float, extent: float) -> bool:
    """Whether a blob came out bit by bit on the far side, is whole now, and drives as a vehicle."""
    last = track[-1].blob
    return (
        0.3 * area < last.area < 1.6 * area
        and track[0].blob.area <= 0.8 * last.area
        and _is_whole(track, extent)
        and _is_far_enough(last, trend)
        and _drives(_velocity(track), trend.motion.velocity)
    )


def _is_whole(track: list[_Sighting], extent: float) -> bool:
    """Whether it has the shape of a vehicle, and grows no more."""
    blob, before = track[-1].blob, track[-_FRAMES].blob
    width, height = blob.size
    growth = np.abs(np.divide(blob.size, before.size) - 1).max()
    return (
        min(width, height) >= 0.35 * extent
        and max(width, height) <= 2.5 * extent
        and blob.area >= 0.4 * width * height
        and float(growth) <= 0.12
    )


def _is_far_enough(blob: Blob, trend: Trend) -> bool:
    """Whether it lies ahead of the place of the last sighting, and as far as time allows for."""
    (x, y), (u, v), velocity = trend.motion.place, blob.centre, trend.motion.velocity
    away = u - x, v - y
    ahead = away[0] * velocity[0] + away[1] * velocity[1] >= 0
    return ahead and math.hypot(*away) >= 0.3 * math.hypot(*velocity) * trend.age


def _drives(velocity: Position, before: Position) -> bool:
    """Whether a vehicle of the velocity `before` may have turned into this one."""
    speed, now = math.hypot(*before), math.hypot(*velocity)
    cross = velocity[0] * before[1] - velocity[1] * before[0]
    along = velocity[0] * before[0] + velocity[1] * before[1]
    angle = abs(math.atan2(cross, along))
    return 0.35 * speed < now < 1.6 * speed and 0.45 < angle < 2.1


def _square(frame: Frame, centre: Position, reach: float) -> Span:
    width, height = frame_size(frame)
    x, y = centre
    return Span(
        max(int(x - reach), 0),
        max(int(y - reach), 0),
        min(int(x + reach) + 1, width),
        min(int(y + reach) + 1, height),
    )

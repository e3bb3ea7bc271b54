# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Crossings, and which of them cannot be those of one more vehicle."""

from __future__ import annotations

import math
import statistics
from collections import defaultdict, deque
from collections.abc import Iterable
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

FASTER, AGAINST, TWICE = "faster", "against", "twice"
"""Doubts: far faster than the others; against all others, and seldom detected; born twice."""
_KNOWN = 5
"""Crossings by which a place is known: of fewer, one in a hundred traffic jams is all one way."""
_FASTEST = 3.0
"""Speed, of the median of the others there, that no vehicle has: at 100 km/h it would be 300."""
_ROOM = 1.5
"""Distance, in sides of the box, within which there is no room for a second vehicle."""
_REMEMBERED = 200
"""Crossings of a place that are remembered: some minutes of a busy road."""


@dataclass(frozen=True, slots=True)
class Crossing:
    """Passage of one vehicle over a line, or into or out of a zone.

    Attributes
    ----------
    stamp_ns : int
        Time at which it crossed, between the images before and after it, ns.
    place : str
        Name of the line or zone.
    direction : str
        Name of the line's direction; ``entry`` or ``exit`` of a zone.
    identity : int
        Number of the vehicle.
    label : str
        Class of the vehicle; "" where it is unknown.
    mode : TrackMode
        Claim about it when it crossed: where that is `OCCLUDED`, its path was predicted; where it
        is `LOST`, it was seen before and after, and its path is taken to be straight.
    speed_px : float or None
        Speed of the lower edge's middle over the last half second, px/s; None where it was not
        followed for long enough.
    speed_kmh : float or None
        The same on the road, km/h; None without a road, or outside its calibrated area.
    point : (float, float)
        Where it crossed, px.
    doubt : str
        Why it is left out of the totals: `FASTER`, `AGAINST` or `TWICE`; "" where it counts.
    """

    stamp_ns: int
    place: str
    direction: str
    identity: int
    label: str
    mode: TrackMode
    speed_px: float | None
    speed_kmh: float | None
    point: Position
    doubt: str = ""


@dataclass(slots=True)
class Life:
    """How long a vehicle was seen, and how well.

    Attributes
    ----------
    first_ns, seen_ns : int
        First and last time that it was seen, ns.
    side : float
        Its longer side, px.
    images, detected : int
        Number of images of it, and of its detections.
    """

    first_ns: int
    seen_ns: int
    side: float = 0.0
    images: int = 0
    detected: int = 0

    @property
    def is_vague(self) -> bool:
        """True where it was predicted or held by its pixels for most of its way."""
        return self.detected < self.images / 2


class Plausibility:
    """Judges crossings by those before at the same place."""

    def __init__(self) -> None:
        self._past: dict[str, deque[tuple[Crossing, Life]]] = defaultdict(
            lambda: deque(maxlen=_REMEMBERED)
        )

    def doubt(self, crossing: Crossing, life: Life) -> str:
        """Tell why a crossing by a vehicle of this life does not count; "" if it does."""
        past = self._past[crossing.place]
        same = [one for one, _ in past if one.direction == crossing.direction]
        near = [one for one, _ in past if math.dist(one.point, crossing.point) < _ROOM * life.side]
        if any(_is_twin(crossing, life, *other) for other in past):
            return TWICE
        if _is_faster(crossing, same):
            return FASTER
        against = all(one.direction != crossing.direction for one in near)
        if life.is_vague and len(near) >= _KNOWN and against:
            return AGAINST
        past.append((crossing, life))
        return ""


def _is_faster(crossing: Crossing, others: Iterable[Crossing]) -> bool:
    speeds = [one.speed_px for one in others if one.speed_px is not None]
    if crossing.speed_px is None or len(speeds) < _KNOWN:
        return False
    return crossing.speed_px > _FASTEST * statistics.median(speeds)


def _is_twin(crossing: Crossing, life: Life, other: Crossing, before: Life) -> bool:
    """Test for the same vehicle: one was predicted, and born again when it was last seen."""
    if crossing.direction != other.direction or crossing.identity == other.identity:
        return False
    if TrackMode.OCCLUDED not in (crossing.mode, other.mode):
        return False
    if life.first_ns <= before.seen_ns and before.first_ns <= life.seen_ns:
        return False  # both were seen at the same time
    speed = max(crossing.speed_px or 0.0, other.speed_px or 0.0)
    ahead = speed * abs(crossing.stamp_ns - other.stamp_ns) / 1e9
    apart = math.dist(crossing.point, other.point)
    return math.hypot(ahead, apart) < _ROOM * max(life.side, before.side)

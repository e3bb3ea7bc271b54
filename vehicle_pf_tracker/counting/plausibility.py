# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubts about crossings that cannot be those of one more vehicle."""

from __future__ import annotations

import math
import statistics
from collections import defaultdict, deque
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

FASTER = "faster"
"""Doubt: it is far faster than the others."""
AGAINST = "against"
"""Doubt: it goes against all others, and was seldom detected."""
TWICE = "twice"
"""Doubt: it was born twice."""
_KNOWN = 5
"""Crossings by which a place is known: of fewer, one in a hundred traffic jams is all one way."""
_FASTEST = 3.0
"""Speed, of the median of the others there, that no vehicle has: at 100 km/h it would be 300."""
_ROOM = 1.5
"""Distance, in sides of the box, within which there is no room for a second vehicle, a choice:
they are one apart where they touch, and drive with a gap."""
_REMEMBERED = 200
"""Crossings of a place that are remembered, a choice: some minutes of a busy road, and a cost per
crossing that does not grow."""


@dataclass(slots=True)
class Life:
    """Record of where and when a vehicle was seen, and how well.

    Attributes
    ----------
    first, last : FootPoint
        First and last point at which it was seen.
    path : RecentPath
        Latest path of the vehicle.
    images, detected : int
        Number of images of it, and of its detections.
    """

    first: FootPoint
    last: FootPoint
    path: RecentPath
    images: int = 0
    detected: int = 0

    @property
    def side(self) -> float:
        """Longer side of its last box that was seen, px."""
        return max(self.last.size)

    def add(self, foot: FootPoint, *, is_detected: bool) -> None:
        """Take the next image of it."""
        if foot.is_seen:
            # A predicted point is no sight: it would end where nobody has seen it.
            self.last = foot
        self.images += 1
        self.detected += is_detected

    @property
    def is_vague(self) -> bool:
        """True where it was predicted or held by its pixels in most of its images."""
        return self.detected < self.images / 2

    def precedes(self, other: Life) -> bool:
        """Test whether the other began where this one must still have been, and it was not seen."""
        gap_ns = other.first.stamp_ns - self.last.stamp_ns
        if gap_ns <= 0:
            # Both were seen at once, and so are two.
            return False
        driven = (self.path.pixels() or 0.0) * gap_ns / 1e9
        apart = math.dist(self.last.point, other.first.point)
        # Summed: it hardly moved, and the other began upon it. One that drove on has left room.
        return apart + driven < max(self.side, other.side)


class Plausibility:
    """Judges crossings by those before at the same place."""

    def __init__(self) -> None:
        self._past: dict[str, deque[tuple[Crossing, Life]]] = defaultdict(
            partial(deque, maxlen=_REMEMBERED)
        )

    def doubt(self, crossing: Crossing, life: Life) -> str:
        """Tell why a crossing by a vehicle of this life does not count; "" if it does."""
        past = self._past[crossing.place]
        # By direction: in px the far carriageway is slower, and would make the near one suspect.
        same = [one for one, _ in past if one.direction == crossing.direction]
        # By place: over a line across both carriageways both directions are usual, but not in one
        # lane.
        near = [one for one, _ in past if math.dist(one.point, crossing.point) < _ROOM * life.side]
        if any(_is_twin(crossing, life, *other) for other in past):
            return TWICE
        if _is_faster(crossing, same):
            return FASTER
        against = all(one.direction != crossing.direction for one in near)
        # Only if it was hardly detected: a vehicle that was well seen may be on the wrong side.
        if life.is_vague and len(near) >= _KNOWN and against:
            return AGAINST
        # What is in doubt is not remembered: it would make the next of its kind plausible.
        past.append((crossing, life))
        return ""


def _is_faster(crossing: Crossing, others: Iterable[Crossing]) -> bool:
    speeds = [one.speed_px for one in others if one.speed_px is not None]
    if crossing.speed_px is None or len(speeds) < _KNOWN:
        # Unknown is no reason to doubt.
        return False
    return crossing.speed_px > _FASTEST * statistics.median(speeds)


def _is_twin(crossing: Crossing, life: Life, other: Crossing, before: Life) -> bool:
    """Test for the same vehicle: it was lost, or predicted, and born again."""
    if crossing.direction != other.direction or crossing.identity == other.identity:
        return False
    if before.precedes(life):
        return True
    # Two crossings in sight are two vehicles; only a predicted one may repeat another.
    if TrackMode.OCCLUDED not in (crossing.mode, other.mode):
        return False
    are_apart = life.first.stamp_ns > before.last.stamp_ns
    if not (are_apart or before.first.stamp_ns > life.last.stamp_ns):
        return False  # both were seen at the same time
    # How far the earlier one has driven on when the other crosses, and how far apart they crossed
    # along the line: about at right angles, hence the hypotenuse.
    speed = max(crossing.speed_px or 0.0, other.speed_px or 0.0)
    ahead = speed * abs(crossing.stamp_ns - other.stamp_ns) / 1e9
    apart = math.dist(crossing.point, other.point)
    return math.hypot(ahead, apart) < _ROOM * max(life.side, before.side)

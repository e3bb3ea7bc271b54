# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle at all lines and zones: its watches there, its path, and crossings that wait."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.line_watch import LineWatch
from vehicle_pf_tracker.counting.plausibility import Life
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.sign_tally import PlacedSign
from vehicle_pf_tracker.counting.zone_watch import ZoneWatch

_PROMISING = 4
"""Detections of a track that was never confirmed by which it may have been a vehicle: by chance
false alarms follow each other twice or three times."""

Passages = list[tuple[str, str, FootPoint]]
"""Lines and zones that a vehicle has passed: name, direction, and the point and time."""


class Counted(NamedTuple):
    """Crossing that has been returned, and the sign that it has left."""

    crossing: Crossing
    sign: PlacedSign


@dataclass(slots=True)
class WatchedVehicle:
    """Memory of one vehicle.

    Attributes
    ----------
    lines : list of LineWatch
        Where it is at each line of the plan.
    zones : list of ZoneWatch
        Where it is at each zone of the plan.
    path : RecentPath
        Its latest points.
    last_ns : int
        Stamp at which it was last among the estimates.
    life : Life
        First and latest points, by which crossings are judged.
    is_confirmed : bool
        True once the tracker has confirmed it.
    label : str
        Its class, empty before it has one.
    waiting : list of Crossing
        Crossings that count once it is confirmed.
    counted : dict of (str, str) to Counted
        What has counted of it, or is in doubt, by place and direction; the latest of a zone.
    """

    lines: list[LineWatch]
    zones: list[ZoneWatch]
    path: RecentPath
    last_ns: int
    life: Life
    is_confirmed: bool = False
    label: str = ""
    waiting: list[Crossing] = field(default_factory=list)
    counted: dict[tuple[str, str], Counted] = field(default_factory=dict)

    def follow(self, foot: FootPoint) -> Passages:
        """Follow it to its next point, and return what it has passed on the way."""
        self.path.add(foot)
        lines = [
            (line.line.name, *at) for line in self.lines for at in line.follow(foot, self.path)
        ]
        zones = [
            (zone.zone.name, *at) for zone in self.zones for at in zone.follow(foot, self.path)
        ]
        return lines + zones

    def missed(self, *, has_ended: bool) -> list[PlacedSign]:
        """Return signs of crossings that do not count, and may be true."""
        if not self.is_confirmed:
            # Until it has ended it may be confirmed yet, and then its crossings count.
            if not has_ended or self.life.detected < _PROMISING:
                return []
            places = [(one.place, one.direction) for one in self.waiting]
            return [(*at, self.label, Sign.UNCONFIRMED) for at in places]
        found = [(line.line.name, line.missed(has_ended=has_ended)) for line in self.lines]
        return [(name, one[0], self.label, one[1]) for name, one in found if one is not None]

    def join(self, other: WatchedVehicle) -> Passages:
        """Go on as the track that it turned out to be after it was hidden.

        Returns what it has passed in between.
        """
        lines = [
            (line.line.name, *at)
            for own, line in zip(self.lines, other.lines, strict=True)
            for at in line.resume(own)
        ]
        zones = [
            (zone.zone.name, *at)
            for own, zone in zip(self.zones, other.zones, strict=True)
            for at in zone.resume(own)
        ]
        # The later track goes on, as its watches know the present sides; `resume` has given them
        # the memory of this one.
        self.lines = other.lines
        self.zones = other.zones
        self.path = self.life.path = other.path
        # What both tracks passed is one crossing: this vehicle has counted it already.
        self.waiting = [
            one for one in other.waiting if (one.place, one.direction) not in self.counted
        ]
        own = {at: one for at, one in self.counted.items() if not one.crossing.doubt}
        self.counted = self.counted | other.counted | own
        return lines + zones

    def repeats(self, other: WatchedVehicle) -> list[Counted]:
        """Return what has counted of `other`, and of this vehicle before; none is in doubt."""
        return [
            one
            for at, one in other.counted.items()
            if at in self.counted and not (one.crossing.doubt or self.counted[at].crossing.doubt)
        ]

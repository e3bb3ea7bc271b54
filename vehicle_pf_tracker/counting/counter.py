# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counting of vehicles at lines and in zones."""

from __future__ import annotations

import math
from collections import Counter as Tally
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace
from typing import NamedTuple

from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.line_watch import LineEdge, LineWatch
from vehicle_pf_tracker.counting.plausibility import Life, Plausibility
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.sign_tally import SignTally
from vehicle_pf_tracker.counting.trust import OF_BLOBS, OF_BOXES
from vehicle_pf_tracker.counting.watched_vehicle import Counted, Passages, WatchedVehicle
from vehicle_pf_tracker.counting.zone_watch import ZONE_ENTRY, ZONE_EXIT, ZoneEdge, ZoneWatch
from vehicle_pf_tracker.parameters.counting_plan import CountingPlan
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

REMEMBERED_NS = 600 * 10**9
"""Time in ns that a vehicle which is not among the estimates is remembered: the longest that a
tracker keeps the number of a lost one for."""
_MOST_REMEMBERED = 5000
"""Vehicles that are remembered at most, eight new ones a second: where the stamps of a camera stand
still, no time lets go of any."""

COUNTED_MODES = (TrackMode.TRACKING, TrackMode.OCCLUDED)
"""Modes of vehicles that count."""


class _Edges(NamedTuple):
    """All lines and zones of a plan."""

    lines: list[LineEdge]
    zones: list[ZoneEdge]


class Counter:
    """Counts each vehicle once per line and direction.

    A vehicle has crossed a line when it has gone from clearly before it to clearly behind it, so
    that one which shakes on the line counts once. Crossings under an occluder count at the time
    that is predicted; those of a tentative vehicle count when it is confirmed. An implausible
    crossing is marked, and left out of the totals. Where two tracks turn out to be one vehicle, as
    of a lorry and its cab, what both have counted is one crossing: the later track's is withdrawn.

    Parameters
    ----------
    plan : CountingPlan
        Lines and zones.
    plane : RoadPlane or None
        Road, for speeds in km/h.
    apart : set of str
        Classes that have totals of their own, and are in no total of vehicles.

    Attributes
    ----------
    totals : Counter of (str, str, str)
        Crossings by place, direction and class, but those in doubt.
    withdrawn : tuple of Crossing
        Crossings, as they were returned, that the last image has taken back from the totals.
    plane : RoadPlane or None
        The road, for vehicles that come from now on.
    """

    def __init__(
        self,
        plan: CountingPlan,
        plane: RoadPlane | None = None,
        apart: Set[str] = frozenset(),
    ) -> None:
        self.plan = plan
        self._apart = apart
        self._edges = _Edges(
            [LineEdge(line) for line in plan.lines], [ZoneEdge(zone) for zone in plan.zones]
        )
        # Crossings by place, direction and class; a Counter of the standard library, not this one.
        self.totals: Tally[tuple[str, str, str]] = Tally()
        self.withdrawn: tuple[Crossing, ...] = ()
        self.plane = plane
        self.vehicles: dict[int, WatchedVehicle] = {}  # by their tracks
        self._plausibility = Plausibility()
        self._occupancy = {zone.name: 0 for zone in plan.zones}
        self._last_ns: int | None = None
        # Stamp of the image before the last: a vehicle whose last point is older was lost between.
        self._before_ns: int | None = None
        self._signs = SignTally()

    @property
    def directions(self) -> Mapping[str, tuple[str, str]]:
        """Names of the two directions of each line and zone, by its name."""
        lines = {line.name: line.directions for line in self.plan.lines}
        return lines | {zone.name: (ZONE_ENTRY, ZONE_EXIT) for zone in self.plan.zones}

    @property
    def occupancy(self) -> Mapping[str, int]:
        """Confirmed vehicles in each zone in the last image, by its name."""
        return self._occupancy

    def is_vehicle(self, label: str) -> bool:
        """Test whether this class, "" where it is unknown, belongs to the totals of vehicles."""
        return label not in self._apart

    def by_class(self, place: str, direction: str) -> Tally[str]:
        """Return the crossings at a place in a direction by class, those apart included."""
        here = place, direction
        return Tally({label: n for (*at, label), n in self.totals.items() if tuple(at) == here})

    def count(self, place: str, direction: str) -> int:
        """Return the crossings of vehicles at a place in a direction."""
        classes = self.by_class(place, direction).items()
        return sum(number for label, number in classes if self.is_vehicle(label))

    def signs(self, place: str, direction: str, label: str | None = None) -> Tally[Sign]:
        """Return the signs at a place in a direction, of vehicles or of one class."""
        followed = [
            sign
            for vehicle in self.vehicles.values()
            if vehicle.last_ns == self._last_ns
            for sign in vehicle.missed(has_ended=False)
        ]
        is_asked = self.is_vehicle if label is None else label.__eq__
        return self._signs.at(place, direction, is_asked, followed)

    def interval(self, place: str, direction: str, label: str | None = None) -> tuple[int, int]:
        """Return the least and largest likely true count of vehicles, or of one class, at a line.

        Nine of ten intervals are to hold the true count; see `counting.trust`.
        """
        trust = OF_BLOBS if self._signs.has_blobs else OF_BOXES
        return trust.interval(self.signs(place, direction, label))

    def speed_kmh(self, serial: int) -> float | None:
        """Return the speed of the vehicle with this track; None where it is not known."""
        vehicle = self.vehicles.get(serial)
        return None if vehicle is None else vehicle.path.kmh()

    def forget_vehicles(self) -> None:
        """Discard where all vehicles were, as when a recording begins again; totals stay."""
        for serial, vehicle in self.vehicles.items():
            # Those that were lost earlier have ended then: their signs must not count twice.
            if vehicle.last_ns == self._last_ns:
                self._signs.end(serial, vehicle.missed(has_ended=True))
            # None comes back: whichever track has this number next, it withdraws nothing.
            self._signs.keep(serial)
        self.vehicles.clear()
        self._occupancy = {zone.name: 0 for zone in self.plan.zones}
        self._last_ns = None
        self._plausibility = Plausibility()

    def reset(self) -> None:
        """Begin anew, all totals at 0."""
        self.forget_vehicles()
        self.totals.clear()
        self._signs.clear()

    def update(
        self,
        estimates: Sequence[TrackEstimate],
        stamp_ns: int,
        *,
        ambiguous: int | None = None,
    ) -> tuple[Crossing, ...]:
        """Take the estimates of the next image.

        Parameters
        ----------
        estimates : sequence of TrackEstimate
            All vehicles followed.
        stamp_ns : int
            Stamp of the image in ns. Time that goes back begins all paths anew.
        ambiguous : int or None
            Blobs in the image that may hold several vehicles; None of detectors that report
            vehicles.

        Returns
        -------
        tuple of Crossing
            Crossings that are known with this image, also those in doubt.
        """
        if self._last_ns is not None and stamp_ns < self._last_ns:
            self.forget_vehicles()
        self.withdrawn = ()
        # 1. Shift the stamps first: `_follow` finds by them who was in the image before.
        self._before_ns = self._last_ns
        self._last_ns = stamp_ns
        self._occupancy = {zone.name: 0 for zone in self.plan.zones}
        # 2. Follow all vehicles; the crossings of tentative ones wait for their confirmation.
        counted = [one for estimate in estimates for one in self._follow(estimate, stamp_ns)]
        # Once blobs, always blobs: an interval is about all crossings since the totals began.
        self._signs.has_blobs = self._signs.has_blobs or ambiguous is not None
        # 3. Count what is plausible. Where a blob may hold two vehicles, one crossing may be two.
        for one in counted:
            if not one.doubt:
                self.totals[one.place, one.direction, one.label] += 1
                if ambiguous:
                    self._signs.add((one.place, one.direction, one.label, Sign.JOINED))
        for serial, vehicle in self.vehicles.items():
            # 4. In the image before, and not in this one: it has just ended. `_follow` takes these
            # signs back if it comes again.
            if vehicle.last_ns == self._before_ns != stamp_ns:
                self._signs.end(serial, vehicle.missed(has_ended=True))
        # 5. Discard what no tracker can bring back: the memory of a node must not grow for weeks.
        self._drop_old(stamp_ns)
        return tuple(counted)

    def _follow(self, estimate: TrackEstimate, stamp_ns: int) -> list[Crossing]:
        if estimate.mode is TrackMode.LOST:
            return []
        # 1. Its memory, and after a gap a mark on what it passes: nobody saw the path.
        vehicle, is_back = self._remembered(estimate, stamp_ns)
        # 2. The track that it turned out to be, before its own point: passages in the gap are
        # earlier.
        joined = self.vehicles.pop(estimate.joined, None)
        self._signs.withdraw(estimate.joined)
        passages = [] if joined is None else self._join(vehicle, joined)
        # 3. Its next point. A vehicle that was once confirmed stays one, whatever its mode
        # becomes.
        mode = TrackMode.LOST if is_back else estimate.mode
        foot = replace(FootPoint.of(estimate, stamp_ns), mode=mode)
        passages += vehicle.follow(foot)
        vehicle.last_ns = stamp_ns
        vehicle.label = estimate.label
        vehicle.life.add(foot, is_detected=not math.isnan(estimate.score))
        vehicle.is_confirmed = vehicle.is_confirmed or estimate.mode in COUNTED_MODES
        vehicle.waiting += _crossings(passages, vehicle.path, estimate)
        # 4. Only confirmed vehicles count; then also what they passed before.
        return self._counted(vehicle, estimate) if vehicle.is_confirmed else []

    def _remembered(self, estimate: TrackEstimate, stamp_ns: int) -> tuple[WatchedVehicle, bool]:
        """Return what is known of a track, and whether it is back after it was lost."""
        # By its track: a tentative one has no number yet.
        vehicle = self.vehicles.get(estimate.serial)
        if vehicle is None:
            vehicle = self.vehicles[estimate.serial] = self._made(FootPoint.of(estimate, stamp_ns))
            return vehicle, False
        is_back = vehicle.last_ns != self._before_ns
        if is_back:
            vehicle.path.clear()
            self._signs.withdraw(estimate.serial)
        return vehicle, is_back

    def _counted(self, vehicle: WatchedVehicle, estimate: TrackEstimate) -> list[Crossing]:
        """Count a confirmed vehicle in the zones it is in, and what it has passed so far."""
        for zone in vehicle.zones:
            is_one_more = zone.is_inside and self.is_vehicle(estimate.label)
            self._occupancy[zone.zone.name] += is_one_more
        waiting = vehicle.waiting
        vehicle.waiting = []
        judged = [self._judged(one, estimate, vehicle.life) for one in waiting]
        # Kept for `join`: another track of the same vehicle may have passed here, too.
        vehicle.counted.update({one.sign[:2]: one for one in judged})
        return [one.crossing for one in judged]

    def _join(self, vehicle: WatchedVehicle, other: WatchedVehicle) -> Passages:
        """Go on as `other`, and take back what both have counted."""
        repeats = vehicle.repeats(other)
        # In place, and without a class that is left at 0.
        self.totals -= Tally(one.sign[:3] for one in repeats)
        for _, sign in repeats:
            self._signs.remove(sign)
        self.withdrawn += tuple(one.crossing for one in repeats)
        return vehicle.join(other)

    def _judged(self, one: Crossing, estimate: TrackEstimate, life: Life) -> Counted:
        """Judge a crossing by what is known of its vehicle now."""
        is_vague = life.is_vague or one.mode in (TrackMode.OCCLUDED, TrackMode.LOST)
        # Number and class of now: when it crossed it may have been tentative, without either.
        one = replace(one, identity=estimate.identity, label=estimate.label or one.label)
        doubt = self._plausibility.doubt(one, life)
        # Doubt first: such a crossing is in no total, however well it was seen.
        kind = Sign.DOUBTED if doubt else Sign.VAGUE if is_vague else Sign.SEEN
        sign = one.place, one.direction, one.label, kind
        self._signs.add(sign)
        return Counted(replace(one, doubt=doubt), sign)

    def _made(self, first: FootPoint) -> WatchedVehicle:
        lines = [LineWatch(edge) for edge in self._edges.lines]
        zones = [ZoneWatch(edge) for edge in self._edges.zones]
        path = RecentPath(self.plane)
        return WatchedVehicle(lines, zones, path, first.stamp_ns, Life(first, first, path))

    def _drop_old(self, stamp_ns: int) -> None:
        vehicles = self.vehicles
        old = [
            identity
            for identity, vehicle in vehicles.items()
            if stamp_ns - vehicle.last_ns > REMEMBERED_NS
        ]
        surplus = len(vehicles) - _MOST_REMEMBERED
        if surplus > len(old):
            # Those that are gone for longest, among which are the old ones.
            old = sorted(vehicles, key=lambda identity: vehicles[identity].last_ns)[:surplus]
        for identity in old:
            del self.vehicles[identity]
            self._signs.keep(identity)


def _crossings(passages: Passages, path: RecentPath, estimate: TrackEstimate) -> list[Crossing]:
    """Return the crossings of a vehicle that has this path up to now."""
    if not passages:
        return []
    speeds = path.pixels(), path.kmh()
    identity = estimate.identity
    label = estimate.label
    return [
        Crossing(at.stamp_ns, place, direction, identity, label, at.mode, *speeds, at.point)
        for place, direction, at in passages
    ]

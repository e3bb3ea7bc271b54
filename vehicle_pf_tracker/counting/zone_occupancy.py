# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Occupancy of zones over time: how many vehicles were in each, interval by interval."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

USUAL_INTERVAL_S = 60.0
"""Length of an interval, s: a minute, in which counting rooms reckon."""
_LONGEST_NS = 2 * 10**9
"""Time in ns that an image stands for at most: what happens in a longer gap is not known. Cameras
of parking places send an image a second."""
_NS = 1e9
"""Nanoseconds per second."""


@dataclass(slots=True)
class Occupancy:
    """Vehicles in one zone over some time.

    Attributes
    ----------
    seconds : float
        Time that images stand for, s.
    vehicle_seconds : float
        Sum over the vehicles of their time inside, s.
    occupied_seconds : float
        Time with a vehicle inside, s.
    largest : int
        Most vehicles at once.
    """

    seconds: float = 0.0
    vehicle_seconds: float = 0.0
    occupied_seconds: float = 0.0
    largest: int = 0

    @property
    def mean(self) -> float:
        """Mean number of vehicles inside."""
        return self.vehicle_seconds / self.seconds if self.seconds else 0.0

    @property
    def share(self) -> float:
        """Share of the time with a vehicle inside."""
        return self.occupied_seconds / self.seconds if self.seconds else 0.0

    def add(self, vehicles: int, seconds: float) -> None:
        """Take a time with so many vehicles inside."""
        self.seconds += seconds
        self.vehicle_seconds += vehicles * seconds
        self.occupied_seconds += seconds if vehicles else 0.0
        self.largest = max(self.largest, vehicles)


@dataclass(frozen=True, slots=True)
class ZoneInterval:
    """Occupancy of a zone in an interval that begins at a stamp in ns."""

    zone: str
    start_ns: int
    occupancy: Occupancy


class ZoneOccupancy:
    """Gathers the occupancy of zones: over intervals that are multiples of a length, and overall.

    What an image shows stands until the next one, and the last image as long as that before it.

    Parameters
    ----------
    zones : iterable of str
        Names of the zones.
    interval_s : float
        Length of an interval, s. Intervals begin at multiples of it: stamps of a clock give whole
        minutes.

    Attributes
    ----------
    overall : dict of str to Occupancy
        Occupancy since the beginning by zone.
    """

    def __init__(self, zones: Iterable[str], interval_s: float = USUAL_INTERVAL_S) -> None:
        self.overall = {zone: Occupancy() for zone in zones}
        self._length_ns = max(1, round(interval_s * _NS))
        self._start_ns: int | None = None
        self._in_interval: dict[str, Occupancy] = {}
        self._last: tuple[int, Mapping[str, int]] | None = None
        self._period_ns = 0

    def add(self, stamp_ns: int, inside: Mapping[str, int]) -> list[ZoneInterval]:
        """Take the vehicles inside by zone of the next image; return the intervals that ended."""
        if not self.overall:
            return []
        ended: list[ZoneInterval] = []
        if self._last is not None:
            apart = stamp_ns - self._last[0]
            # Time that goes back, as where a recording loops, says nothing about the last image.
            if apart >= 0:
                self._period_ns = min(apart, _LONGEST_NS)
            ended += self._spend(*self._last)
        self._last = stamp_ns, dict(inside)
        return ended

    def rest(self) -> list[ZoneInterval]:
        """Return the intervals that end with the last image; then there is none."""
        ended = [] if self._last is None else [*self._spend(*self._last), *self._end()]
        self._last = None
        return ended

    def _spend(self, stamp_ns: int, inside: Mapping[str, int]) -> Iterator[ZoneInterval]:
        """Assign the time of an image to its intervals, and yield those that have ended."""
        end_ns = stamp_ns + self._period_ns
        while stamp_ns < end_ns:
            start_ns = stamp_ns - stamp_ns % self._length_ns
            if start_ns != self._start_ns:
                yield from self._end()
                self._start_ns = start_ns
                self._in_interval = {zone: Occupancy() for zone in self.overall}
            until_ns = min(end_ns, start_ns + self._length_ns)
            for zone, whole in self.overall.items():
                for one in (self._in_interval[zone], whole):
                    one.add(inside[zone], (until_ns - stamp_ns) / _NS)
            stamp_ns = until_ns

    def _end(self) -> list[ZoneInterval]:
        if self._start_ns is None:
            return []
        start_ns = self._start_ns
        self._start_ns = None
        return [ZoneInterval(zone, start_ns, one) for zone, one in self._in_interval.items()]

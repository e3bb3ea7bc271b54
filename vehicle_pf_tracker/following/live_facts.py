# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Numbers beside the picture of a live page: tables of what is followed and counted."""

from __future__ import annotations

from collections import Counter as Tally
from collections import deque
from collections.abc import Iterable, Mapping
from statistics import fmean

from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.results.estimates import EstimateRow, clock_words
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_MINUTE_NS = 60 * 10**9
"""Time that counts as recent, ns: a page with crossings per minute needs no other."""

_MOST_RECENT = 10_000
"""Crossings that are kept at most, far more than any road has in a minute: where the stamps of a
camera stand still, no time lets go of any."""


class RecentCrossings:
    """Crossings of the last minute, by the stamps."""

    def __init__(self) -> None:
        self._of: deque[Crossing] = deque(maxlen=_MOST_RECENT)

    def add(self, crossings: Iterable[Crossing], stamp_ns: int) -> None:
        """Take the plausible crossings of the next image."""
        self._of.extend(crossing for crossing in crossings if not crossing.doubt)
        # Also below 0: after time has gone back they are of another minute.
        while self._of and not 0 <= stamp_ns - self._of[0].stamp_ns < _MINUTE_NS:
            self._of.popleft()

    def withdraw(self, crossings: Iterable[Crossing]) -> None:
        """Take out crossings that turned out to be none."""
        for crossing in crossings:
            if crossing in self._of:
                self._of.remove(crossing)

    def at(self, place: str, direction: str) -> list[Crossing]:
        """Return the recent crossings at a place in a direction."""
        return [
            crossing
            for crossing in self._of
            if (crossing.place, crossing.direction) == (place, direction)
        ]


def traffic_facts(
    counter: Counter, recent: RecentCrossings, estimates: Iterable[TrackEstimate], when: str
) -> dict[str, object]:
    """Return what a page shows of all vehicles: a summary, and tables of classes, lines and zones.

    Parameters
    ----------
    counter : Counter
        Counts, with their lines and zones.
    recent : RecentCrossings
        Crossings of the last minute.
    estimates : iterable of TrackEstimate
        Vehicles of the last image.
    when : str
        Time of the image, and words about it.
    """
    # 1. Vehicles in view, and a table of their classes.
    confirmed = [vehicle for vehicle in estimates if vehicle.mode in COUNTED_MODES]
    # What is counted apart, as bicycles are, is in none of the summary's numbers.
    vehicles = [vehicle for vehicle in confirmed if counter.is_vehicle(vehicle.label)]
    hidden = sum(vehicle.mode is TrackMode.OCCLUDED for vehicle in vehicles)
    speeds = [kmh for vehicle in vehicles if (kmh := counter.speed_kmh(vehicle.serial)) is not None]
    tables = []
    classes = Tally(vehicle.label or "unknown" for vehicle in confirmed)
    # A detector of motion knows no classes: then the table says nothing.
    if set(classes) - {"unknown"}:
        tables.append(_table("in view", ("class", "vehicles"), classes.most_common()))
    # 2. Lines, with the interval of the true count beside what was counted.
    lines = [
        _line_row(counter, recent, line.name, to)
        for line in counter.plan.lines
        for to in line.directions
    ]
    if lines:
        columns = ("line", "direction", "counted", "last minute", "km/h", "90 %")
        tables.append(_table("lines", columns, lines))
    # 3. Zones.
    zones = [
        (zone.name, counter.occupancy[zone.name], *(counter.count(zone.name, to) for to in both))
        for zone in counter.plan.zones
        for both in [counter.directions[zone.name]]
    ]
    if zones:
        tables.append(_table("zones", ("zone", "inside", "entered", "left"), zones))
    # 4. The summary in words.
    noun = "vehicle" if len(vehicles) == 1 else "vehicles"
    words = [when, f"{len(vehicles)} {noun} in view"]
    words += [f"{hidden} hidden"] if hidden else []
    words += [f"mean {fmean(speeds):.0f} km/h"] if speeds else []
    return {"vehicles": len(vehicles), "summary": ", ".join(filter(None, words)), "tables": tables}


def _line_row(
    counter: Counter, recent: RecentCrossings, line: str, direction: str
) -> tuple[object, ...]:
    """Return what a page shows of a line in a direction; its columns are in `traffic_facts`."""
    crossings = recent.at(line, direction)
    last = [crossing for crossing in crossings if counter.is_vehicle(crossing.label)]
    return (
        line,
        direction,
        counter.count(line, direction),
        len(last),
        _mean_kmh(crossing.speed_kmh for crossing in last),
        "{} to {}".format(*counter.interval(line, direction)),
    )


def target_facts(rows: Mapping[str, EstimateRow], elapsed_ns: int) -> dict[str, object]:
    """Return what a page shows of single targets, by their names, some ns after the first frame."""
    cells = [
        (name, row.mode, _digits(row.confidence, 2), _digits(row.x, 1), _digits(row.y, 1))
        for name, row in rows.items()
    ]
    number = max((row.frame for row in rows.values()), default=0)
    table = _table("targets", ("target", "mode", "confidence", "x, px", "y, px"), cells)
    return {"summary": f"{clock_words(elapsed_ns)}, frame {number}", "tables": [table]}


def _table(
    title: str, columns: tuple[str, ...], rows: Iterable[tuple[object, ...]]
) -> dict[str, object]:
    return {"title": title, "columns": columns, "rows": list(rows)}


def _mean_kmh(speeds: Iterable[float | None]) -> str | None:
    """Return the mean of the speeds that are known, in words; None without any."""
    known = [kmh for kmh in speeds if kmh is not None]
    return f"{fmean(known):.0f}" if known else None


def _digits(value: float | None, decimals: int) -> str | None:
    return None if value is None else f"{value:.{decimals}f}"

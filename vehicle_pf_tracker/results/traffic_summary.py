# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Summary of a run over many vehicles: how many, of what class, through how many occlusions."""

from __future__ import annotations

import math
from collections import Counter as Tally
from collections.abc import Iterable, Iterator
from statistics import median
from typing import Any

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.counting.trust import HELD_SHARE
from vehicle_pf_tracker.counting.zone_occupancy import (
    USUAL_INTERVAL_S,
    Occupancy,
    ZoneOccupancy,
)
from vehicle_pf_tracker.counting.zone_watch import ZONE_ENTRY, ZONE_EXIT
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.parameters.counting_plan import CountingLine
from vehicle_pf_tracker.results.vehicle_log import VehicleLog, Whereabouts
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_GONE = (Whereabouts.BORDER, Whereabouts.ROI, Whereabouts.FAR)
"""Ends that the summary reports in a line of their own."""


class TrafficSummary:
    """Tally of vehicles and occlusions, frame by frame.

    Parameters
    ----------
    counter : Counter
        Counts, of a plan with regions of interest: a vehicle that drives out of them leaves.
    zone_interval_s : float
        Length of the intervals of the zones' occupancy, s.

    Attributes
    ----------
    zones : ZoneOccupancy
        Occupancy of the zones over time, which takes images by itself.
    frames : int
        Frames so far.
    most_at_once : int
        Largest number of confirmed vehicles in a frame.
    vehicles : dict of int to VehicleLog
        Every vehicle that was visible and confirmed, by its number, those of classes that are
        counted apart included.
    """

    def __init__(self, counter: Counter, zone_interval_s: float = USUAL_INTERVAL_S) -> None:
        self.counter = counter
        self.zones = ZoneOccupancy((zone.name for zone in counter.plan.zones), zone_interval_s)
        self.frames = 0
        self.most_at_once = 0
        self.vehicles: dict[int, VehicleLog] = {}
        self._followed: set[int] = set()

    def add(self, estimates: Iterable[TrackEstimate]) -> None:
        """Take the next frame."""
        self.frames += 1
        confirmed = [
            estimate for estimate in estimates if estimate.mode in (*COUNTED_MODES, TrackMode.LOST)
        ]
        for estimate in confirmed:
            self._follow(estimate)
        followed = {estimate.identity for estimate in confirmed} & self.vehicles.keys()
        for identity in self._followed - followed:
            self.vehicles[identity].end()
        self._followed = followed
        vehicles = [estimate for estimate in confirmed if self.counter.is_vehicle(estimate.label)]
        present = sum(estimate.mode is not TrackMode.LOST for estimate in vehicles)
        self.most_at_once = max(self.most_at_once, present)

    def _follow(self, estimate: TrackEstimate) -> None:
        if estimate.mode is TrackMode.TRACKING:
            vehicle = self.vehicles.setdefault(estimate.identity, VehicleLog())
            vehicle.see(estimate, is_at_edge=self._is_outside(_ahead(estimate)))
        elif estimate.identity in self.vehicles:
            self.vehicles[estimate.identity].miss(
                estimate, is_outside=self._is_outside(estimate.position)
            )

    def _is_outside(self, point: Position) -> bool:
        """Test whether a point lies outside the regions."""
        regions = self.counter.plan.regions
        if not regions:
            return False
        return not len(Detections.make([[*point, 0.0, 0.0]], None).within(regions))

    @property
    def survived(self) -> int:
        """Occlusions after which a vehicle was visible under the same number."""
        return sum(vehicle.survived for vehicle in self.vehicles.values())

    @property
    def ended_hidden(self) -> int:
        """Vehicles that stayed invisible after their last occlusion."""
        return self.ends[Whereabouts.HIDDEN]

    @property
    def ends(self) -> Tally[Whereabouts]:
        """Vehicles by where they are in the end."""
        return Tally(vehicle.whereabouts for vehicle in self.vehicles.values())

    @property
    def least_size(self) -> float | None:
        """Longer side, px, below which vehicles are too far; None where none drove there."""
        sizes = [size for vehicle in self.vehicles.values() for size in vehicle.far_sizes]
        return median(sizes) if sizes else None

    def _numbers(self) -> tuple[int, Tally[str], Tally[str]]:
        """Count vehicles, those of each class, and what is counted apart by class."""
        labels = Tally(vehicle.label for vehicle in self.vehicles.values())
        apart = Tally({name: n for name, n in labels.items() if not self.counter.is_vehicle(name)})
        vehicles = labels - apart
        return vehicles.total(), vehicles, apart

    def sentences(self) -> list[str]:
        """Return the summary, a line for each fact."""
        counter = self.counter
        total, classes, apart = self._numbers()
        found = [
            f"{_number(total, 'vehicle')} in {self.frames} frames, at most "
            f"{self.most_at_once} at once{_listed(classes)}{_besides(apart)}",
            f"{_number(self.survived, 'occlusion')} survived under the same number; "
            f"{_number(self.ended_hidden, 'vehicle')} not seen again after an occlusion",
        ]
        ends = [f"{self.ends[where]} {where.value}" for where in _GONE if self.ends[where]]
        if ends:
            found.append(f"{', '.join(ends)}; {self.ends[Whereabouts.IN_VIEW]} in view at the end")
        if self.least_size is not None:
            found.append(
                f"vehicles were followed down to {self.least_size:.0f} px, as they are far away; "
                "smaller ones are not counted"
            )
        lines = [
            f"line {line.name}: "
            + ", ".join(_direction(counter, line.name, to) for to in line.directions)
            + f"; 90 % intervals {_intervals_of(counter, line)}"
            for line in counter.plan.lines
        ]
        zones = [
            f"zone {zone.name}: {counter.count(zone.name, ZONE_ENTRY)} entered, "
            f"{counter.count(zone.name, ZONE_EXIT)} left; {_inside(self.zones.overall[zone.name])}"
            for zone in counter.plan.zones
        ]
        return [*found, *lines, *zones]

    def to_json(self) -> dict[str, Any]:
        """Return the summary for `run.json`."""
        total, _, apart = self._numbers()
        return {
            "frames": self.frames,
            "vehicles": total,
            "counted_apart": dict(sorted(apart.items())),
            "most_at_once": self.most_at_once,
            "occlusions_survived": self.survived,
            "ended_occluded": self.ended_hidden,
            "ended": {where.name.lower(): self.ends[where] for where in Whereabouts},
            "least_size_px": self.least_size,
            "counts": [
                {"place": place, "direction": direction, "class": label, "count": count}
                for (place, direction, label), count in sorted(self.counter.totals.items())
            ],
            "intervals": [
                {"line": line.name, "direction": to, **each}
                for line in self.counter.plan.lines
                for to in line.directions
                for each in _intervals(self.counter, line.name, to)
            ],
            "zones": [
                {"zone": zone, "seconds": round(found.seconds, 3), **_occupancy(found)}
                for zone, found in self.zones.overall.items()
            ],
        }


def _direction(counter: Counter, place: str, direction: str) -> str:
    known = Tally({name: n for name, n in counter.by_class(place, direction).items() if name})
    apart = Tally({name: n for name, n in known.items() if not counter.is_vehicle(name)})
    count = counter.count(place, direction)
    return f"{count} {direction}{_listed(known - apart)}{_besides(apart)}"


def _occupancy(found: Occupancy) -> dict[str, float | None]:
    """Return the numbers of an occupancy; all None where images stand for no time."""
    if not found.seconds:
        return dict.fromkeys(("mean", "max", "occupied"))
    return {
        "mean": round(found.mean, 4),
        "max": found.largest,
        "occupied": round(found.share, 4),
    }


def _inside(found: Occupancy) -> str:
    if not found.seconds:
        return "occupancy unknown, as no time passed between images"
    return (
        f"{found.mean:.1f} inside on average, at most {found.largest}, occupied "
        f"{100 * found.share:.0f} % of the time"
    )


def _intervals_of(counter: Counter, line: CountingLine) -> str:
    both = [(*counter.interval(line.name, to), to) for to in line.directions]
    return ", ".join(f"{low} to {high} {to}" for low, high, to in both)


def _intervals(counter: Counter, place: str, direction: str) -> Iterator[dict[str, Any]]:
    """Yield the intervals of the true count: of vehicles, and of each class that crossed."""
    for label in (None, *sorted(filter(None, counter.by_class(place, direction)))):
        low, high = counter.interval(place, direction, label)
        yield {"class": label, "low": low, "high": high, "probability": HELD_SHARE}


def _listed(classes: Tally[str]) -> str:
    """Return the classes in brackets, the most frequent first; empty where none is known."""
    words = _words(classes)
    return f" ({words})" if words else ""


def _besides(apart: Tally[str]) -> str:
    """Return the classes that are counted apart; empty where there are none."""
    words = _words(apart)
    return f" besides {words}" if words else ""


def _words(classes: Tally[str]) -> str:
    return ", ".join(f"{count} {label}" for label, count in classes.most_common() if label)


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _ahead(estimate: TrackEstimate) -> Position:
    """Return the point half a vehicle ahead of its centre, px: where it is detected last."""
    x, y = estimate.position
    across, down = estimate.velocity
    speed = math.hypot(across, down)
    way = max(estimate.box.width, estimate.box.height) / 2 / speed if speed else 0.0
    return x + way * across, y + way * down

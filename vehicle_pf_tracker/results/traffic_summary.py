# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Summary of a run over many vehicles: how many, of what class, through how many occlusions."""

from __future__ import annotations

import math
from collections import Counter as Tally
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.counter import CONFIRMED, Counter
from vehicle_pf_tracker.counting.zone_watch import ZONE_ENTRY, ZONE_EXIT
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.parameters.counting_plan import Region
from vehicle_pf_tracker.trackers.traffic.estimate import BORDER, TrackEstimate, TrackMode


@dataclass(slots=True)
class VehicleLog:
    """Life of one vehicle in a run.

    Attributes
    ----------
    labels : Counter of str
        Frames in which it was visible as each class.
    survived : int
        Occlusions after which it was visible under the same number.
    is_hidden : bool
        True from the beginning of an occlusion until it is visible again; leaving is none.
    is_at_edge : bool
        True where it was about to drive out of the regions of interest when it was last visible.
    """

    labels: Tally[str] = field(default_factory=Tally)
    survived: int = 0
    is_hidden: bool = False
    is_at_edge: bool = False

    @property
    def label(self) -> str:
        """Class of most frames: a lorry far away looks like a car; "" where it is unknown."""
        return max(self.labels, key=self.labels.__getitem__, default="")


class TrafficSummary:
    """Counts vehicles and occlusions, frame by frame.

    Parameters
    ----------
    regions : sequence of Region
        Regions of interest: a vehicle that drives out of them leaves.

    Attributes
    ----------
    frames : int
        Frames so far.
    most_at_once : int
        Largest number of confirmed vehicles in a frame.
    vehicles : dict of int to VehicleLog
        Every vehicle that was visible and confirmed, by its number.
    """

    def __init__(self, regions: Sequence[Region] = ()) -> None:
        self.regions = tuple(regions)
        self.frames = 0
        self.most_at_once = 0
        self.vehicles: dict[int, VehicleLog] = {}

    def add(self, estimates: Iterable[TrackEstimate]) -> None:
        """Take the next frame."""
        self.frames += 1
        confirmed = [one for one in estimates if one.mode in (*CONFIRMED, TrackMode.LOST)]
        for one in confirmed:
            self._follow(one)
        present = sum(one.mode is not TrackMode.LOST for one in confirmed)
        self.most_at_once = max(self.most_at_once, present)

    def _follow(self, one: TrackEstimate) -> None:
        if one.mode is TrackMode.TRACKING:
            vehicle = self.vehicles.setdefault(one.identity, VehicleLog())
            vehicle.survived += vehicle.is_hidden
            vehicle.labels.update([one.label] * bool(one.label))
            vehicle.is_hidden = False
            vehicle.is_at_edge = self._is_outside(_ahead(one))
        elif one.identity in self.vehicles:
            vehicle = self.vehicles[one.identity]
            is_out = not vehicle.is_hidden and self._is_outside(one.position)
            has_left = one.hidden_by == BORDER or vehicle.is_at_edge or is_out
            vehicle.is_hidden = vehicle.is_hidden or not has_left

    def _is_outside(self, point: Position) -> bool:
        """Tell whether a point lies outside the regions."""
        if not self.regions:
            return False
        return not len(Detections.make([[*point, 0.0, 0.0]], None).within(self.regions))

    @property
    def survived(self) -> int:
        """Occlusions after which a vehicle was visible under the same number."""
        return sum(one.survived for one in self.vehicles.values())

    @property
    def ended_hidden(self) -> int:
        """Vehicles that stayed invisible after their last occlusion."""
        return sum(one.is_hidden for one in self.vehicles.values())

    def sentences(self, counter: Counter) -> list[str]:
        """Return the summary, a line for each fact."""
        classes = Tally(one.label for one in self.vehicles.values() if one.label)
        found = [
            f"{_number(len(self.vehicles), 'vehicle')} in {self.frames} frames, at most "
            f"{self.most_at_once} at once{_listed(classes)}",
            f"{_number(self.survived, 'occlusion')} survived under the same number; "
            f"{_number(self.ended_hidden, 'vehicle')} not seen again after an occlusion",
        ]
        lines = [
            f"line {line.name}: "
            + ", ".join(_direction(counter, line.name, to) for to in line.directions)
            for line in counter.plan.lines
        ]
        zones = [
            f"zone {zone.name}: {counter.count(zone.name, ZONE_ENTRY)} entered, "
            f"{counter.count(zone.name, ZONE_EXIT)} left"
            for zone in counter.plan.zones
        ]
        return [*found, *lines, *zones]

    def to_json(self, counter: Counter) -> dict[str, Any]:
        """Return the summary for `run.json`."""
        return {
            "frames": self.frames,
            "vehicles": len(self.vehicles),
            "most_at_once": self.most_at_once,
            "occlusions_survived": self.survived,
            "ended_occluded": self.ended_hidden,
            "counts": [
                {"place": place, "direction": direction, "class": label, "count": count}
                for (place, direction, label), count in sorted(counter.totals.items())
            ],
        }


def _direction(counter: Counter, place: str, direction: str) -> str:
    both = [place, direction]
    totals = counter.totals.items()
    classes = Tally({label: count for (*at, label), count in totals if at == both and label})
    return f"{counter.count(place, direction)} {direction}{_listed(classes)}"


def _listed(classes: Tally[str]) -> str:
    """Return the classes in brackets, the most frequent first; empty where none is known."""
    words = ", ".join(f"{count} {label}" for label, count in classes.most_common())
    return f" ({words})" if words else ""


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _ahead(one: TrackEstimate) -> Position:
    """Return the point half a vehicle ahead of its centre, px: where it is detected last."""
    x, y = one.position
    across, down = one.velocity
    speed = math.hypot(across, down)
    way = max(one.box.width, one.box.height) / 2 / speed if speed else 0.0
    return x + way * across, y + way * down

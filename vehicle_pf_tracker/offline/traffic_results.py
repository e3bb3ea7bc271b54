# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Results of a run over many vehicles: its files, written row by row, and its summary."""

from __future__ import annotations

import csv
import math
from collections import Counter as Tally
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import Any, TextIO

from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.offline.output_files import replacing
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter, Crossing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.watches import ENTRY, EXIT

TRACKS, MOT_TRACKS, COUNTS = "tracks.csv", "tracks.txt", "counts.csv"

TRACK_COLUMNS = (
    "frame", "stamp_ns", "id", "x", "y", "width", "height", "vx", "vy", "mode", "confidence",
    "label", "score", "age", "hidden_by",
)  # fmt: skip
"""Columns of `tracks.csv`: x and y are the centre of the box in px, vx and vy its velocity in px
per nominal frame period, which is also the unit of age."""
COUNT_COLUMNS = (
    "frame", "stamp_ns", "place", "direction", "id", "label", "mode", "speed_px_s", "speed_kmh",
)  # fmt: skip
"""Columns of `counts.csv`: the stamp is that of the crossing, the frame the one it counted in."""

_HIDDEN_CONFIDENCE = 0.5
"""Share of its confidence that an occluded vehicle is written to `tracks.txt` with, so that a
threshold of a half leaves no predicted box."""


IN_TRACKS = frozenset({TrackMode.TENTATIVE, *CONFIRMED})
"""Modes of numbered vehicles that `tracks.txt` has."""
_HELD_FRAMES = 90
"""Frames that are held back at most until their tentative vehicles are known: 3 s at 30 Hz."""
FrameEstimates = tuple[int, int, Sequence[TrackEstimate]]
"""Number of a frame, its stamp in ns, and the vehicles in it."""
Frames = Iterator[FrameEstimates]


class Backdating:
    """Holds frames back until it is known which of their tentative vehicles are confirmed.

    These get their numbers from their first detection on; the others are left out.
    """

    def __init__(self) -> None:
        self._held: deque[FrameEstimates] = deque()
        self._numbers: dict[int, int] = {}

    def add(self, frame: int, stamp_ns: int, estimates: Sequence[TrackEstimate]) -> Frames:
        """Take the next frame, and return those that are known, in order."""
        self._held.append((frame, stamp_ns, estimates))
        self._numbers.update({one.serial: one.identity for one in estimates if one.identity})
        open_ones = {one.serial for one in estimates if not one.identity}
        while self._held and (
            len(self._held) > _HELD_FRAMES
            or open_ones.isdisjoint(one.serial for one in self._held[0][2])
        ):
            yield self._known(*self._held.popleft())

    def rest(self) -> Frames:
        """Return the frames that are still held back, as the source has ended."""
        while self._held:
            yield self._known(*self._held.popleft())

    def _known(
        self, frame: int, stamp_ns: int, estimates: Sequence[TrackEstimate]
    ) -> FrameEstimates:
        numbered = [
            one if one.identity else replace(one, identity=self._numbers.get(one.serial, 0))
            for one in estimates
        ]
        return frame, stamp_ns, [one for one in numbered if one.identity]


class TrackFiles:
    """Writes the estimates of frame after frame, tentative ones once they are confirmed.

    Parameters
    ----------
    csv_file, mot_file : text streams
        Files to write to.
    counts_file : text stream or None
        File for crossings; None where nothing is counted.
    visible_only : bool
        Leave occluded vehicles out of the MOTChallenge file.
    """

    def __init__(
        self,
        csv_file: TextIO,
        mot_file: TextIO,
        counts_file: TextIO | None = None,
        *,
        visible_only: bool = False,
    ) -> None:
        self._tracks = csv.writer(csv_file, lineterminator="\n")
        self._mot = mot_file
        self._counts = csv.writer(counts_file, lineterminator="\n") if counts_file else None
        self._in_mot = IN_TRACKS - ({TrackMode.OCCLUDED} if visible_only else set())
        self._backdating = Backdating()
        self._tracks.writerow(TRACK_COLUMNS)
        if self._counts:
            self._counts.writerow(COUNT_COLUMNS)

    def write(
        self,
        frame: int,
        stamp_ns: int,
        estimates: Sequence[TrackEstimate],
        crossings: Iterable[Crossing] = (),
    ) -> None:
        """Take what is known of a frame, whose number counts from 1."""
        self._write(self._backdating.add(frame, stamp_ns, estimates))
        if self._counts:
            self._counts.writerows(_count_row(frame, one) for one in crossings)

    def finish(self) -> None:
        """Write what was held back."""
        self._write(self._backdating.rest())

    def _write(self, frames: Frames) -> None:
        for frame, stamp_ns, estimates in frames:
            self._tracks.writerows(_track_row(frame, stamp_ns, one) for one in estimates)
            self._mot.writelines(
                _mot_row(frame, one) for one in estimates if one.mode in self._in_mot
            )


@contextmanager
def track_files(
    folder: Path, *, counting: bool = False, visible_only: bool = False
) -> Iterator[TrackFiles]:
    """Open the files of a run in `folder`; they appear under their names when all is written.

    Until then, and if anything goes wrong, those of an earlier run stay as they are.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    names = [TRACKS, MOT_TRACKS, COUNTS] if counting else [TRACKS, MOT_TRACKS]
    with ExitStack() as stack:
        partials = [stack.enter_context(replacing(folder / name)) for name in names]
        with ExitStack() as opened:
            files = [
                opened.enter_context(partial.open("w", encoding="utf-8", newline="\n"))
                for partial in partials
            ]
            tracks = TrackFiles(*files, visible_only=visible_only)
            yield tracks
            tracks.finish()
    if not counting:  # none of an earlier run beside the tracks of this one
        with output_errors(folder / COUNTS):
            (folder / COUNTS).unlink(missing_ok=True)


def _track_row(frame: int, stamp_ns: int, one: TrackEstimate) -> list[Any]:
    """Return the row of an estimate, in the order of `TRACK_COLUMNS`, every digit kept."""
    numbers = *one.box.centre, one.box.width, one.box.height, *one.velocity
    hidden_by = "" if one.hidden_by is None else str(one.hidden_by)
    return [
        frame, stamp_ns, one.identity, *map(_exact, numbers), one.mode.value,
        _exact(one.confidence), one.label, _exact(one.score), _exact(one.age), hidden_by,
    ]  # fmt: skip


def _mot_row(frame: int, one: TrackEstimate) -> str:
    """Return the MOTChallenge row of a tracked or occluded vehicle."""
    share = _HIDDEN_CONFIDENCE if one.mode is TrackMode.OCCLUDED else 1.0
    numbers = ",".join(f"{value:.2f}" for value in astuple(one.box))
    return f"{frame},{one.identity},{numbers},{share * one.confidence:.4f},-1,-1,-1\n"


def _count_row(frame: int, crossing: Crossing) -> list[Any]:
    """Return the row of a crossing, in the order of `COUNT_COLUMNS`."""
    speeds = [crossing.speed_px, crossing.speed_kmh]
    return [
        frame, crossing.stamp_ns, crossing.place, crossing.direction, crossing.identity,
        crossing.label, crossing.mode.value,
        *("" if speed is None else f"{speed:.2f}" for speed in speeds),
    ]  # fmt: skip


def _exact(value: float) -> str:
    """Return a number with all its digits; "" for one that is not known."""
    return "" if math.isnan(value) else repr(float(value))


@dataclass(slots=True)
class VehicleLog:
    """Life of one vehicle in a run.

    Attributes
    ----------
    label : str
        Class; "" where it is unknown.
    survived : int
        Occlusions after which it was visible under the same number.
    is_hidden : bool
        True from the beginning of an occlusion until it is visible again.
    """

    label: str = ""
    survived: int = 0
    is_hidden: bool = False


class TrafficSummary:
    """Counts vehicles and occlusions, frame by frame.

    Attributes
    ----------
    frames : int
        Frames so far.
    most_at_once : int
        Largest number of confirmed vehicles in a frame.
    vehicles : dict of int to VehicleLog
        Every vehicle that was visible and confirmed, by its number.
    """

    def __init__(self) -> None:
        self.frames = 0
        self.most_at_once = 0
        self.vehicles: dict[int, VehicleLog] = {}
        self._occupancy: Tally[str] = Tally()
        self._most_in_zone: dict[str, int] = {}

    def add(self, estimates: Iterable[TrackEstimate], occupancy: Mapping[str, int]) -> None:
        """Take the next frame, and the number of vehicles in each zone."""
        self.frames += 1
        confirmed = [one for one in estimates if one.mode in (*CONFIRMED, TrackMode.LOST)]
        for one in confirmed:
            self._follow(one)
        present = sum(one.mode is not TrackMode.LOST for one in confirmed)
        self.most_at_once = max(self.most_at_once, present)
        for zone, count in occupancy.items():
            self._occupancy[zone] += count
            self._most_in_zone[zone] = max(count, self._most_in_zone.get(zone, 0))

    def _follow(self, one: TrackEstimate) -> None:
        is_visible = one.mode is TrackMode.TRACKING
        vehicle = self.vehicles.get(one.identity)
        if vehicle is None:
            if is_visible:
                self.vehicles[one.identity] = VehicleLog(one.label)
            return
        if is_visible:
            vehicle.survived += vehicle.is_hidden
            vehicle.label = one.label or vehicle.label
        vehicle.is_hidden = not is_visible

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
        if not self.vehicles:
            return [f"no vehicle was found in {self.frames} frames"]
        found = [
            f"{_number(len(self.vehicles), 'vehicle')} in {self.frames} frames, at most "
            f"{self.most_at_once} at once{self._classes()}",
            f"{_number(self.survived, 'occlusion')} survived under the same number; "
            f"{_number(self.ended_hidden, 'vehicle')} not seen again after an occlusion",
        ]
        return found + self._counts(counter)

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
            "occupancy": {
                zone.name: {
                    "mean": self._mean_in(zone.name),
                    "most": self._most_in_zone.get(zone.name, 0),
                }
                for zone in counter.plan.zones
            },
        }

    def _classes(self) -> str:
        classes = Tally(one.label for one in self.vehicles.values() if one.label)
        return f" ({_listed(classes)})" if classes else ""

    def _counts(self, counter: Counter) -> list[str]:
        lines = [
            f"line {line.name}: "
            + ", ".join(_direction(counter, line.name, to) for to in line.directions)
            for line in counter.plan.lines
        ]
        zones = [
            f"zone {zone.name}: {counter.count(zone.name, ENTRY)} entered, "
            f"{counter.count(zone.name, EXIT)} left, {self._mean_in(zone.name):.1f} there on "
            f"average, at most {self._most_in_zone.get(zone.name, 0)}"
            for zone in counter.plan.zones
        ]
        return lines + zones

    def _mean_in(self, zone: str) -> float:
        return self._occupancy[zone] / max(self.frames, 1)


def _direction(counter: Counter, place: str, direction: str) -> str:
    classes = Tally(
        {
            label: count
            for (at, to, label), count in counter.totals.items()
            if (at, to) == (place, direction) and label
        }
    )
    known = f" ({_listed(classes)})" if classes else ""
    return f"{counter.count(place, direction)} {direction}{known}"


def _listed(classes: Tally[str]) -> str:
    return ", ".join(f"{count} {label}" for label, count in classes.most_common())


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of a run over many vehicles, written row by row."""

from __future__ import annotations

import csv
import math
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sequence, Set
from contextlib import ExitStack, contextmanager
from dataclasses import astuple, replace
from pathlib import Path
from typing import Any, TextIO

from vehicle_pf_tracker.counting.counter import COUNTED_MODES, REMEMBERED_NS
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.plausibility import TWICE
from vehicle_pf_tracker.counting.zone_occupancy import ZoneInterval
from vehicle_pf_tracker.results.backdating import Backdating, Frames
from vehicle_pf_tracker.results.output_files import replacing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

TRACKS_FILE = "tracks.csv"
"""File of all vehicles, a row for each in each frame."""
MOT_TRACKS = "tracks.txt"
"""File of all but the lost ones in the format of MOTChallenge, which tools for scoring read."""
COUNTS_FILE = "counts.csv"
"""File of the crossings, a row for each."""
ZONES = "zones.csv"
"""File of the occupancy of zones, a row for each zone and interval."""

TRACK_COLUMNS = (
    "frame",
    "stamp_ns",
    "id",
    "x",
    "y",
    "width",
    "height",
    "vx",
    "vy",
    "mode",
    "confidence",
    "label",
    "score",
    "age",
    "hidden_by",
)
"""Columns of `tracks.csv`: x and y are the centre of the box in px, vx and vy its velocity in px
per nominal frame period, which is also the unit of age."""
COUNT_COLUMNS = (
    "frame",
    "stamp_ns",
    "place",
    "direction",
    "id",
    "label",
    "mode",
    "speed_px_s",
    "speed_kmh",
    "doubt",
)
"""Columns of `counts.csv`: the stamp is that of the crossing, the frame the one it counted in."""
ZONE_COLUMNS = ("zone", "stamp_ns", "seconds", "mean", "max", "occupied")
"""Columns of `zones.csv`: the stamp at which the interval begins, the time that was observed in it,
mean and largest number of vehicles inside, and the share of the time with any."""

_HIDDEN_CONFIDENCE = 0.5
"""Share of its confidence that an occluded vehicle is written to `tracks.txt` with, so that a
threshold of a half leaves no predicted box."""
_MOT_ROW = "{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.4f},{},{},{}\n"
"""Row of `tracks.txt`, of `mot_numbers`."""
IN_TRACKS = frozenset({TrackMode.TENTATIVE, *COUNTED_MODES})
"""Modes of numbered vehicles that `tracks.txt` has."""


class TrackFiles:
    """Writer of the estimates of frame after frame, tentative ones once they are confirmed.

    Crossings wait for as long as their vehicles are remembered: until then they may be withdrawn.

    Parameters
    ----------
    csv_file, mot_file : text streams
        Files to write to.
    counts_file : text stream or None
        File for crossings; None where nothing is counted.
    zones_file : text stream or None
        File for the occupancy of zones; None without zones.
    """

    def __init__(
        self,
        csv_file: TextIO,
        mot_file: TextIO,
        counts_file: TextIO | None = None,
        zones_file: TextIO | None = None,
    ) -> None:
        self._tracks = csv.writer(csv_file, lineterminator="\n")
        self._mot = mot_file
        self._counts = csv.writer(counts_file, lineterminator="\n") if counts_file else None
        self._zones = csv.writer(zones_file, lineterminator="\n") if zones_file else None
        self._backdating = Backdating()
        self._waiting: deque[tuple[int, Crossing]] = deque()  # with the frames they counted in
        self._tracks.writerow(TRACK_COLUMNS)
        if self._counts:
            self._counts.writerow(COUNT_COLUMNS)
        if self._zones:
            self._zones.writerow(ZONE_COLUMNS)

    def write(
        self,
        frame: int,
        stamp_ns: int,
        estimates: Sequence[TrackEstimate],
        crossings: Iterable[Crossing] = (),
        undecided: Set[int] = frozenset(),
        withdrawn: Collection[Crossing] = (),
    ) -> None:
        """Take what is known of a frame, whose number counts from 1; see `Backdating`.

        Earlier crossings that are `withdrawn` are in doubt, as counted twice.
        """
        self._write(self._backdating.add(frame, stamp_ns, estimates, undecided))
        if withdrawn:
            self._waiting = deque(
                (number, replace(one, doubt=TWICE) if one in withdrawn else one)
                for number, one in self._waiting
            )
        self._waiting.extend((frame, crossing) for crossing in crossings)
        while self._waiting and stamp_ns - self._waiting[0][1].stamp_ns > REMEMBERED_NS:
            self._write_crossing()

    def write_zones(self, intervals: Iterable[ZoneInterval]) -> None:
        """Write the occupancy of zones in intervals that have ended."""
        if self._zones:
            self._zones.writerows(map(_zone_row, intervals))

    def finish(self) -> None:
        """Write what was held back."""
        self._write(self._backdating.rest())
        while self._waiting:
            self._write_crossing()

    def _write_crossing(self) -> None:
        row = _count_row(*self._waiting.popleft())
        if self._counts:
            self._counts.writerow(row)

    def _write(self, frames: Frames) -> None:
        for frame, stamp_ns, estimates in frames:
            self._tracks.writerows(_track_row(frame, stamp_ns, estimate) for estimate in estimates)
            shown = (estimate for estimate in estimates if estimate.mode in IN_TRACKS)
            self._mot.writelines(
                _MOT_ROW.format(*mot_numbers(frame, estimate)) for estimate in shown
            )


@contextmanager
def track_files(
    folder: Path, *, counting: bool = False, zones: bool = False
) -> Iterator[TrackFiles]:
    """Open the files of a run in `folder`; they appear under their names when all is written.

    Until then, and if anything goes wrong, those of an earlier run stay as they are.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    asked = {TRACKS_FILE: True, MOT_TRACKS: True, COUNTS_FILE: counting or zones, ZONES: zones}
    names = [name for name, is_asked in asked.items() if is_asked]
    with ExitStack() as stack:
        partials = [stack.enter_context(replacing(folder / name)) for name in names]
        files = [
            stack.enter_context(partial.open("w", encoding="utf-8", newline="\n"))
            for partial in partials
        ]
        tracks = TrackFiles(*files)
        yield tracks
        tracks.finish()
    for name in asked.keys() - names:  # none of an earlier run beside the tracks of this one
        (folder / name).unlink(missing_ok=True)


def _track_row(frame: int, stamp_ns: int, estimate: TrackEstimate) -> list[Any]:
    """Return the row of an estimate, in the order of `TRACK_COLUMNS`, every digit kept."""
    numbers = *estimate.box.centre, estimate.box.width, estimate.box.height, *estimate.velocity
    hidden_by = "" if estimate.hidden_by is None else str(estimate.hidden_by)
    return [
        frame,
        stamp_ns,
        estimate.identity,
        *map(_exact, numbers),
        estimate.mode.value,
        _exact(estimate.confidence),
        estimate.label,
        _exact(estimate.score),
        _exact(estimate.age),
        hidden_by,
    ]


def mot_numbers(frame: int, estimate: TrackEstimate) -> list[float]:
    """Return the MOTChallenge row of a tracked or occluded vehicle."""
    share = _HIDDEN_CONFIDENCE if estimate.mode is TrackMode.OCCLUDED else 1.0
    return [
        frame,
        estimate.identity,
        *astuple(estimate.box),
        share * estimate.confidence,
        -1,
        -1,
        -1,
    ]


def _count_row(frame: int, crossing: Crossing) -> list[Any]:
    """Return the row of a crossing, in the order of `COUNT_COLUMNS`."""
    speeds = [crossing.speed_px, crossing.speed_kmh]
    return [
        frame,
        crossing.stamp_ns,
        crossing.place,
        crossing.direction,
        crossing.identity,
        crossing.label,
        crossing.mode.value,
        *("" if speed is None else f"{speed:.2f}" for speed in speeds),
        crossing.doubt,
    ]


def _zone_row(interval: ZoneInterval) -> list[Any]:
    """Return the row of a zone in an interval, in the order of `ZONE_COLUMNS`."""
    occupancy = interval.occupancy
    return [
        interval.zone,
        interval.start_ns,
        f"{occupancy.seconds:.3f}",
        f"{occupancy.mean:.4f}",
        occupancy.largest,
        f"{occupancy.share:.4f}",
    ]


def _exact(value: float) -> str:
    """Return a number with all its digits; "" for one that is not known."""
    return "" if math.isnan(value) else repr(float(value))

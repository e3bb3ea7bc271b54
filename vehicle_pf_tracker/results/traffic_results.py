# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of a run over many vehicles, written row by row."""

from __future__ import annotations

import csv
import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence, Set
from contextlib import ExitStack, contextmanager
from dataclasses import astuple, replace
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.counting.counter import CONFIRMED
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.results.output_files import replacing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

TRACKS = "tracks.csv"
"""File of all vehicles, a row for each in each frame."""
MOT_TRACKS = "tracks.txt"
"""The same in the format of MOTChallenge, which tools for scoring read."""
COUNTS = "counts.csv"
"""File of the crossings, a row for each."""

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

_HIDDEN_CONFIDENCE = 0.5
"""Share of its confidence that an occluded vehicle is written to `tracks.txt` with, so that a
threshold of a half leaves no predicted box."""
_MOT_ROW = "{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.4f},{},{},{}\n"
"""Row of `tracks.txt`, of `mot_numbers`."""
IN_TRACKS = frozenset({TrackMode.TENTATIVE, *CONFIRMED})
"""Modes of numbered vehicles that `tracks.txt` has."""
_SEEN = frozenset({TrackMode.TENTATIVE, TrackMode.TRACKING})
"""Modes in which a box was measured, not predicted."""
_HELD_FRAMES = 90
"""Frames that are held back at most until their tentative vehicles are known: 3 s at 30 Hz."""
FrameEstimates = tuple[int, int, Sequence[TrackEstimate]]
"""Number of a frame, its stamp in ns, and the vehicles in it."""
Frames = Iterator[FrameEstimates]


class Backdating:
    """Holds frames back until vehicles and classes in them are known.

    Tentative vehicles that are confirmed get their numbers from their first detection on; the
    others are left out. A vehicle has the class that was decided for it in all frames. A hidden one
    that was found again has the boxes of the track that it turned out to be, not its prediction.
    """

    def __init__(self) -> None:
        self._held: deque[FrameEstimates] = deque()
        self._numbers: dict[int, int] = {}
        self._labels: dict[int, str] = {}

    def add(
        self,
        frame: int,
        stamp_ns: int,
        estimates: Sequence[TrackEstimate],
        undecided: Set[int] = frozenset(),
    ) -> Frames:
        """Take the next frame, and return those that are known, in order.

        `undecided` has the numbers of the vehicles whose class may still change.
        """
        self._held.append((frame, stamp_ns, estimates))
        known = [one for one in estimates if one.identity]
        self._numbers.update({one.serial: one.identity for one in known})
        self._numbers.update({one.joined: one.identity for one in known if one.joined})
        self._labels.update({one.identity: one.label for one in known if one.label})
        open_ones = {
            one.serial for one in estimates if not one.identity or one.identity in undecided
        }
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
        by_number: dict[int, TrackEstimate] = {}
        for one in estimates:
            number = self._numbers.get(one.serial, 0)
            other = by_number.get(number)
            if number and (other is None or other.mode not in _SEEN):
                label = self._labels.get(number, one.label)
                is_same = (one.identity, one.label) == (number, label)
                by_number[number] = one if is_same else replace(one, identity=number, label=label)
        return frame, stamp_ns, list(by_number.values())


class TrackFiles:
    """Writes the estimates of frame after frame, tentative ones once they are confirmed.

    Parameters
    ----------
    csv_file, mot_file : text streams
        Files to write to.
    counts_file : text stream or None
        File for crossings; None where nothing is counted.
    """

    def __init__(
        self, csv_file: TextIO, mot_file: TextIO, counts_file: TextIO | None = None
    ) -> None:
        self._tracks = csv.writer(csv_file, lineterminator="\n")
        self._mot = mot_file
        self._counts = csv.writer(counts_file, lineterminator="\n") if counts_file else None
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
        undecided: Set[int] = frozenset(),
    ) -> None:
        """Take what is known of a frame, whose number counts from 1; see `Backdating`."""
        self._write(self._backdating.add(frame, stamp_ns, estimates, undecided))
        if self._counts:
            self._counts.writerows(_count_row(frame, one) for one in crossings)

    def finish(self) -> None:
        """Write what was held back."""
        self._write(self._backdating.rest())

    def _write(self, frames: Frames) -> None:
        for frame, stamp_ns, estimates in frames:
            self._tracks.writerows(_track_row(frame, stamp_ns, one) for one in estimates)
            shown = (one for one in estimates if one.mode in IN_TRACKS)
            self._mot.writelines(_MOT_ROW.format(*mot_numbers(frame, one)) for one in shown)


@contextmanager
def track_files(folder: Path, *, counting: bool = False) -> Iterator[TrackFiles]:
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
        files = [
            stack.enter_context(partial.open("w", encoding="utf-8", newline="\n"))
            for partial in partials
        ]
        tracks = TrackFiles(*files)
        yield tracks
        tracks.finish()
    if not counting:  # none of an earlier run beside the tracks of this one
        (folder / COUNTS).unlink(missing_ok=True)


def _track_row(frame: int, stamp_ns: int, one: TrackEstimate) -> list[Any]:
    """Return the row of an estimate, in the order of `TRACK_COLUMNS`, every digit kept."""
    numbers = *one.box.centre, one.box.width, one.box.height, *one.velocity
    hidden_by = "" if one.hidden_by is None else str(one.hidden_by)
    return [
        frame,
        stamp_ns,
        one.identity,
        *map(_exact, numbers),
        one.mode.value,
        _exact(one.confidence),
        one.label,
        _exact(one.score),
        _exact(one.age),
        hidden_by,
    ]


def mot_numbers(frame: int, one: TrackEstimate) -> list[float]:
    """Return the MOTChallenge row of a tracked or occluded vehicle."""
    share = _HIDDEN_CONFIDENCE if one.mode is TrackMode.OCCLUDED else 1.0
    return [frame, one.identity, *astuple(one.box), share * one.confidence, -1, -1, -1]


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


def _exact(value: float) -> str:
    """Return a number with all its digits; "" for one that is not known."""
    return "" if math.isnan(value) else repr(float(value))


_INTEGERS = {"frame", "stamp_ns", "id"}
"""Columns that are read as integers: a stamp in ns has more digits than a float."""
_TEXTS = {"mode", "label", "hidden_by", "place", "direction"}
"""Columns that are read as text; all others are floats."""


def read_tracks(folder: str | Path, *, pandas: bool = False) -> Any:
    """Read ``tracks.csv`` of a folder that `traffic` has written.

    Parameters
    ----------
    folder : str or Path
        The folder.
    pandas : bool
        Return a data frame instead.

    Returns
    -------
    numpy.recarray or pandas.DataFrame
        A row for each vehicle and frame, with the columns of the file; NaN where it has no number.

    Raises
    ------
    InputError
        If it cannot be read, or pandas is not installed.
    """
    return _read(Path(folder) / TRACKS, pandas)


def read_counts(folder: str | Path, *, pandas: bool = False) -> Any:
    """Read ``counts.csv``, a row for each crossing; see `read_tracks`."""
    return _read(Path(folder) / COUNTS, pandas)


def _read(path: Path, as_frame: bool) -> Any:
    names, *rows = csv.reader(read_text(path, "the table").splitlines())
    try:
        columns = {
            name: _column(name, [row[index] for row in rows]) for index, name in enumerate(names)
        }
    except (ValueError, IndexError) as error:
        raise InputError(f"cannot read the table {path}: {error}") from None
    if not as_frame:
        kinds = [(name, column.dtype) for name, column in columns.items()]
        return np.rec.fromarrays(list(columns.values()), dtype=np.dtype(kinds))
    try:
        from pandas import DataFrame  # noqa: PLC0415 - no dependency of ours
    except ImportError:
        raise InputError("a data frame needs pandas: pip install pandas") from None
    return DataFrame(columns)


def _column(name: str, cells: list[str]) -> Any:
    if name in _TEXTS:
        return np.array(cells, str)
    return np.array([cell or "nan" for cell in cells], np.int64 if name in _INTEGERS else float)

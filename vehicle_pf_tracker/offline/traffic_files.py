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

"""Files of a run over many vehicles, written row by row.

Detections of a MOTChallenge file, `det.txt`.
"""

from __future__ import annotations

import csv
import math
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.offline.output_files import replacing
from vehicle_pf_tracker.trackers.traffic.counting import Crossing
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

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


class TrackFiles:
    """Writes the estimates of frame after frame.

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
        counts_file: TextIO | None,
        *,
        visible_only: bool = False,
    ) -> None:
        self._tracks = csv.writer(csv_file, lineterminator="\n")
        self._mot = mot_file
        self._counts = csv.writer(counts_file, lineterminator="\n") if counts_file else None
        self._visible_only = visible_only
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
        """Write what is known of a frame, whose number counts from 1."""
        for one in estimates:
            self._tracks.writerow(track_row(frame, stamp_ns, one))
            if one.mode is TrackMode.TRACKING or (
                one.mode is TrackMode.OCCLUDED and not self._visible_only
            ):
                self._mot.write(mot_row(frame, one) + "\n")
        if self._counts:
            self._counts.writerows(count_row(frame, one) for one in crossings)


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
            csv_file, mot_file, *counts = files
            yield TrackFiles(
                csv_file, mot_file, counts[0] if counts else None, visible_only=visible_only
            )
    if not counting:  # none of an earlier run beside the tracks of this one
        with output_errors(folder / COUNTS):
            (folder / COUNTS).unlink(missing_ok=True)


def track_row(frame: int, stamp_ns: int, estimate: TrackEstimate) -> list[Any]:
    """Return the row of an estimate, in the order of `TRACK_COLUMNS`, every digit kept."""
    box, (x, y), (vx, vy) = estimate.box, estimate.box.centre, estimate.velocity
    numbers = [x, y, box.width, box.height, vx, vy]
    hidden_by = "" if estimate.hidden_by is None else str(estimate.hidden_by)
    return [
        frame, stamp_ns, estimate.identity, *map(_exact, numbers), estimate.mode.value,
        _exact(estimate.confidence), estimate.label, _exact(estimate.score), _exact(estimate.age),
        hidden_by,
    ]  # fmt: skip


def mot_row(frame: int, estimate: TrackEstimate) -> str:
    """Return the MOTChallenge row of a tracked or occluded vehicle."""
    is_hidden = estimate.mode is TrackMode.OCCLUDED
    confidence = estimate.confidence * (_HIDDEN_CONFIDENCE if is_hidden else 1.0)
    box = estimate.box
    numbers = ",".join(f"{value:.2f}" for value in (box.x, box.y, box.width, box.height))
    return f"{frame},{estimate.identity},{numbers},{confidence:.4f},-1,-1,-1"


def count_row(frame: int, crossing: Crossing) -> list[Any]:
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


_COLUMNS = ("frame", "id", "left", "top", "width", "height", "score")
_REQUIRED = 6
"""Columns that a row must have; without a seventh, all detections score 1."""
_LAST_FRAME = 10**9
"""Largest number of a frame: a year of video."""
_LONGEST_ROW = 1000
"""Letters of a row, which is cut off there; one with ten numbers has sixty."""
_SHOWN = 60
"""Letters of a bad row that an error shows."""


class DetectionFile:
    """Detections by the number of their frame.

    Parameters
    ----------
    path : Path
        Text file with a row per detection: frame from 1, id (not used), left, top, width and height
        in px, score; columns after these are not used. Rows may be in any order.

    Attributes
    ----------
    notices : list of str
        Irregularities, a sentence each.

    Raises
    ------
    InputError
        If it cannot be read, or a row is not of this form; the row is named by its number.
    """

    def __init__(self, path: Path) -> None:
        rows = _read_rows(path)
        frames = rows[:, 0].astype(np.int64)
        order = np.argsort(frames, kind="stable")
        self.notices: list[str] = []
        usable = np.isfinite(rows[order, 1:]).all(axis=1) & (rows[order, 3:5] > 0).all(axis=1)
        if not usable.all():
            self.notices.append(
                f"{np.count_nonzero(~usable)} of {len(rows)} detections in {path} have no area, or "
                "numbers that are not finite, and are left out"
            )
        self._frames, self._rows = frames[order][usable], rows[order][usable, 1:]

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def last_frame(self) -> int:
        """Number of the last frame that has a detection; 0 without any."""
        return int(self._frames[-1]) if len(self) else 0

    def of(self, frame: int) -> Detections:
        """Return the detections of a frame; one without rows is one in which nothing was seen."""
        begin, end = np.searchsorted(self._frames, [frame, frame + 1])
        return Detections.make(self._rows[begin:end, :4], self._rows[begin:end, 4])


def _read_rows(path: Path) -> Array:
    """Return frame, left, top, width, height and score of every row, shape (N, 6)."""
    numbers = array("d")  # 48 bytes per row: a list of a million rows would take ten times as much
    try:
        with path.open(encoding="utf-8-sig") as file:
            for number, line in enumerate(iter(partial(file.readline, _LONGEST_ROW), ""), start=1):
                if line.strip() and not line.lstrip().startswith("#"):
                    numbers.extend(_row(line, f"row {number} of the detections {path}"))
    except OSError as error:
        raise InputError(f"cannot read the detections {path}: {error.strerror}") from error
    except UnicodeDecodeError:
        raise InputError(f"the detections {path} are not text") from None
    return np.frombuffer(numbers, np.float64).reshape(-1, 6)


def _row(line: str, what: str) -> tuple[float, ...]:
    words = line.split(",")
    if len(words) < _REQUIRED:
        raise InputError(f"{what} is not {','.join(_COLUMNS)}: {line.strip()[:_SHOWN]!r}")
    try:
        values = [float(word) for word in islice(words, len(_COLUMNS))]
    except ValueError:
        raise InputError(
            f"{what} has a word that is no number: {line.strip()[:_SHOWN]!r}"
        ) from None
    frame = values[0]
    if not (math.isfinite(frame) and frame.is_integer() and 1 <= frame <= _LAST_FRAME):
        raise InputError(f"{what} has the frame {words[0].strip()}; frames are integers from 1")
    score = values[6] if len(values) > _REQUIRED else 1.0
    return (frame, *values[2:6], score)

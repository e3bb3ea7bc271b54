# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`estimates.csv`: one row per frame of a recording, with every digit kept."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from types import MappingProxyType

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.output_files import read_csv, write_csv
from vehicle_pf_tracker.trackers.estimate import Mode

_MOST_SPANS = 12
"""Spans in a summary; more are counted, since nobody reads a line of hundreds."""
_ANOTHER_CLOCK_NS = 86_400 * 1_000_000_000
"""Distance of stamps, a day, at which they are not of one clock: a camera without a time yet stamps
its first images with zero."""


@dataclass(frozen=True, slots=True)
class EstimateRow:
    """The estimate of one frame.

    Attributes
    ----------
    frame : int
        Number of the frame in its recording, from 1.
    stamp_ns : int
        Stamp of its image in ns.
    x, y : float or None
        Centre of the vehicle in px; None, as all numbers, where there is no estimate.
    width, height : float or None
        Size of its box in px.
    mode : str
        ``TRACKING``, ``OCCLUDED``, ``LOST``, or `WAITING_MODE` or `REJECTED_MODE`.
    confidence : float or None
        Confidence of the estimate, 0 to 1.
    n_eff : float or None
        Effective sample size of the particles.
    step_ms : float or None
        Time that the step took, in ms.
    """

    frame: int
    stamp_ns: int
    x: float | None
    y: float | None
    width: float | None
    height: float | None
    mode: str
    confidence: float | None
    n_eff: float | None
    step_ms: float | None

    @classmethod
    def from_scalars(
        cls, frame: int, stamp_ns: int, scalars: Mapping[str, float | int | str]
    ) -> EstimateRow:
        """Make a row from the scalars of an `Estimate`, or from their text in `~/mode`.

        Scalars that are missing or empty are None; those that have no column are left out.

        Raises
        ------
        InputError
            If there is no mode, or the text of a number is not one.
        """
        if "mode" not in scalars:
            raise InputError(f"the estimate of frame {frame} has no mode")
        numbers = {name: _number(name, scalars.get(name, "")) for name in _NUMBERS}
        return cls(frame=frame, stamp_ns=stamp_ns, mode=str(scalars["mode"]), **numbers)

    @classmethod
    def without(cls, frame: int, stamp_ns: int, mode: str) -> EstimateRow:
        """Make the row of a frame without an estimate."""
        return cls.from_scalars(frame, stamp_ns, {"mode": mode})

    @property
    def position(self) -> tuple[float, float] | None:
        """Centre (x, y) in px; None where there is no estimate."""
        return None if self.x is None or self.y is None else (self.x, self.y)

    @property
    def box(self) -> Box | None:
        """Box in px; None where there is no estimate."""
        if self.position is None or self.width is None or self.height is None:
            return None
        return Box.around(self.position, self.width, self.height)


WAITING_MODE = "WAITING"
"""Mode of a frame before there is a target; all numbers are empty."""
REJECTED_MODE = "REJECTED"
"""Mode of a frame that the tracker could not use; all numbers are empty."""

ESTIMATE_COLUMNS = tuple(field.name for field in fields(EstimateRow))
"""Columns of `estimates.csv`."""
_NUMBERS = ("x", "y", "width", "height", "confidence", "n_eff", "step_ms")
"""Columns that are empty where there is no estimate."""


def write_estimates(
    path: Path,
    rows: Iterable[EstimateRow],
    extra: Mapping[str, Sequence[float | None]] = MappingProxyType({}),
) -> None:
    """Write `rows` to the file `path`, with the columns `extra` after their own.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    found = zip(rows, *extra.values(), strict=True)
    cells = ((*astuple(row), *more) for row, *more in found)
    write_csv(path, [*ESTIMATE_COLUMNS, *extra], cells)


def write_tracks(path: Path, rows: Mapping[str, Sequence[EstimateRow]]) -> None:
    """Write the rows of several targets to one file: ``target`` and the columns of estimates.

    Frames follow each other, and in each of them the targets in their order.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    cells = (
        (name, *astuple(row))
        for of_frame in zip(*rows.values(), strict=True)
        for name, row in zip(rows, of_frame, strict=True)
    )
    write_csv(path, ["target", *ESTIMATE_COLUMNS], cells)


def read_estimates(path: Path) -> list[EstimateRow]:
    """Read the rows of the file `path`; columns after those of `EstimateRow` are ignored.

    Raises
    ------
    InputError
        If there is no such file, or a line of it is not as `write_estimates` writes it.
    """
    return read_csv(path, "the estimates", ESTIMATE_COLUMNS, _row)


def _row(line: Mapping[str, str]) -> EstimateRow:
    return EstimateRow.from_scalars(int(line["frame"]), int(line["stamp_ns"]), line)


def _number(name: str, value: float | str) -> float | None:
    if isinstance(value, str) and not value:
        return None
    try:
        return float(value)
    except ValueError:
        raise InputError(f"{name} is not a number: {value!r}") from None


def summary(rows: Sequence[EstimateRow], size: tuple[int, int] | None = None) -> str:
    """Return the modes of a run in one sentence, times in min:s after its first frame.

    A vehicle that was lost for good at the border of images of the `size` given (width, height in
    px) has left.
    """
    if not rows:
        return "no frames"
    start_ns = rows[0].stamp_ns
    timed = []
    for row in rows:
        start_ns = start_of_clock(start_ns, row.stamp_ns)
        timed.append((row.mode, clock_words(row.stamp_ns - start_ns)))
    spans = [list(group) for _, group in groupby(timed, key=itemgetter(0))]
    words = [_words(span, is_last=span is spans[-1]) for span in spans]
    mode, since = spans[-1][0]
    before = rows[-len(spans[-1]) - 1] if len(spans) > 1 else None
    if mode == Mode.LOST.value and _is_leaving(before, size):
        words[-1] = f"LEFT the image at {since}"
    if len(spans) > _MOST_SPANS:
        words[_MOST_SPANS:] = [f"and {len(spans) - _MOST_SPANS} more changes of the mode"]
    tracked = sum(row.mode == Mode.TRACKING.value for row in rows)
    return f"{', '.join(words)}; {tracked} of {len(rows)} frames tracked"


def _is_leaving(row: EstimateRow | None, size: tuple[int, int] | None) -> bool:
    """Return whether the box of a row, the last before a loss, reaches the border of the image."""
    if row is None or row.box is None or size is None:
        return False
    left, top = row.box.corners[0]
    right, bottom = row.box.corners[2]
    return min(left, top) <= 0 or right >= size[0] or bottom >= size[1]


def clock_words(nanoseconds: int) -> str:
    """Return a time as min:s with tenths, as ``1:07.5``."""
    tenths = round(nanoseconds / 1e8)
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def start_of_clock(start_ns: int | None, stamp_ns: int) -> int:
    """Return the stamp in ns that times of `stamp_ns` count from.

    It is `start_ns`, that of the images before, unless the stamp is of another clock than that.
    """
    if start_ns is None or abs(stamp_ns - start_ns) > _ANOTHER_CLOCK_NS:
        return stamp_ns
    return start_ns


def _words(span: Sequence[tuple[str, str]], *, is_last: bool) -> str:
    """Return mode and times of consecutive rows of one mode, each a mode and a time in words."""
    mode, first = span[0]
    _, last = span[-1]
    return f"LOST from {first}" if is_last and mode == Mode.LOST.value else f"{mode} {first}-{last}"

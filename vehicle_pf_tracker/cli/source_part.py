# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Part of a source that a verb tracks in: from one moment to another, or to a signal."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.stopping import StillAtWork, Stop
from vehicle_pf_tracker.core.errors import InputError

if TYPE_CHECKING:
    from vehicle_pf_tracker.core.progress import ShowCount
    from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
    from vehicle_pf_tracker.recordings.source import ImageSource
    from vehicle_pf_tracker.showing.pictures import Numbered


@dataclass(frozen=True, slots=True)
class Moment:
    """A point in a source.

    Attributes
    ----------
    value : float
        Number of a frame, from 1, or time after the first one in s, by the stamps.
    is_time : bool
        True for a time.
    """

    value: float
    is_time: bool

    @classmethod
    def parse(cls, text: str) -> Moment:
        """Read ``130`` as a frame, and ``4.3s`` as a time.

        Raises
        ------
        InputError
            If it is neither.
        """
        match = re.fullmatch(r"0*([1-9]\d{0,8})|(\d{1,9}\.?\d*|\.\d+)s", text, re.ASCII)
        if match is None:
            raise InputError(
                f"{text!r} is neither a frame (an integer >= 1) nor a time in seconds, as 4.3s"
            )
        return cls(float(match[1] or match[2]), match[1] is None)

    def after(self, number: int, elapsed: float) -> float:
        """Return by how much the moment is later than frame `number`, `elapsed` s from the first.

        The result is negative where it is earlier, and its unit is the moment's own.
        """
        return round(self.value - (elapsed if self.is_time else number), 9)  # a stamp's rounding


def numbered_part(
    source: ImageSource, start: Moment | None, end: Moment | None, stop: Stop, progress: ShowCount
) -> tuple[tuple[int, StampedFrame], Numbered]:
    """Return the first frame from `start` on, and all to `end`, with their numbers in the source.

    They end when `stop` comes; `progress` takes the number of each.

    Raises
    ------
    InputError
        If there is none.
    KeyboardInterrupt, Terminated
        If there is none because `stop` came.
    """
    frames = _numbered(source, start, end, stop, progress)
    first = next(frames, None)
    if first is None:
        stop.end_unbegun()
        raise InputError("the source ended before its first image")
    return first, itertools.chain([first], frames)


def _numbered(
    source: ImageSource, start: Moment | None, end: Moment | None, stop: Stop, progress: ShowCount
) -> Iterator[tuple[int, StampedFrame]]:
    """Yield the frames of the part with their numbers in the source."""
    first_ns: int | None = None
    number = 0
    is_empty = True
    frames = source.frames()
    if source.frame_count is None:  # it may stall
        frames = _leavable(frames, stop)
    frames = itertools.takewhile(lambda _: not stop.came, frames)
    for number, stamped in enumerate(frames, start=1):
        first_ns = stamped.stamp_ns if first_ns is None else first_ns
        elapsed = (stamped.stamp_ns - first_ns) * 1e-9
        if start is not None and start.after(number, elapsed) > 0:
            continue
        if end is not None and end.after(number, elapsed) < 0:
            break
        is_empty = False
        progress(number, source.frame_count)
        yield number, stamped
    if is_empty and not stop.came and (start is not None or end is not None):
        raise InputError(
            f"no frame lies between --start and --end; {number} frames were read from the source"
        )


def _leavable(frames: Iterator[StampedFrame], stop: Stop) -> Iterator[StampedFrame]:
    """Yield frames until one does not come after a signal."""
    with suppress(StillAtWork):
        while (stamped := stop.leaving(partial(next, frames, None))) is not None:
            yield stamped


def cut_short(stop: Stop, source: ImageSource, done: int) -> list[str]:
    """Say that a signal ended the run after `done` frames; empty if it is whole.

    A live source ends by a signal, and so its run is whole then.
    """
    if not stop.came or source.frame_count is None:
        return []
    return [f"a signal ended the run after {done} of {source.frame_count} frames"]

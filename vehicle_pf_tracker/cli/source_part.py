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

"""The part of a source that a verb tracks in: from one moment to another, or to a signal."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

from vehicle_pf_tracker.cli.stopping import StillAtWork, Stop
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.offline.driver import Numbered
from vehicle_pf_tracker.offline.processes import OnProgress
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import Source


@dataclass(frozen=True, slots=True)
class Moment:
    """A point in a source: the number of a frame, or a time after the first one.

    Attributes
    ----------
    frame : int or None
        Number of the frame, from 1.
    seconds : float or None
        Time in s, by the stamps; given where `frame` is None.
    """

    frame: int | None = None
    seconds: float | None = None

    @classmethod
    def parse(cls, text: str) -> Moment:
        """Read ``130`` as a frame, and ``4.3s`` as a time.

        Raises
        ------
        InputError
            If it is neither.
        """
        found = re.fullmatch(r"0*([1-9]\d{0,8})|(\d{1,9}\.?\d*|\.\d+)s", text, re.ASCII)
        if found is None:
            raise InputError(
                f"{text!r} is neither a frame (an integer >= 1) nor a time in seconds, as 4.3s"
            )
        return cls(int(found[1])) if found[1] else cls(seconds=float(found[2]))

    def after(self, number: int, elapsed: float) -> float:
        """Return by how much the moment is later than frame `number`, `elapsed` s from the first.

        The result is negative where it is earlier, and its unit is the moment's own.
        """
        if self.frame is not None:
            return self.frame - number
        assert self.seconds is not None
        return round(self.seconds - elapsed, 9)  # a stamp's rounding


def numbered_part(
    source: Source, start: Moment | None, end: Moment | None, stop: Stop, progress: OnProgress
) -> tuple[tuple[int, StampedFrame], Numbered]:
    """Return the first frame from `start` on, and all to `end`, with their numbers in the source.

    They end when `stop` comes; `progress` takes the number of each.

    Raises
    ------
    InputError
        If there is none.
    """
    frames = _numbered(source, start, end, stop, progress)
    first = next(frames, None)
    if first is None:
        raise InputError("the source ended before its first image")
    return first, itertools.chain([first], frames)


def _numbered(
    source: Source, start: Moment | None, end: Moment | None, stop: Stop, progress: OnProgress
) -> Iterator[tuple[int, StampedFrame]]:
    first_ns: int | None = None
    number, is_empty = 0, True
    frames = source.frames()
    if source.frame_count is None:  # it may stall
        frames = _leavable(frames, stop)
    for number, found in enumerate(stop.until(frames), start=1):
        first_ns = found.stamp_ns if first_ns is None else first_ns
        elapsed = (found.stamp_ns - first_ns) * 1e-9
        if start is not None and start.after(number, elapsed) > 0:
            continue
        if end is not None and end.after(number, elapsed) < 0:
            break
        is_empty = False
        progress(number, source.frame_count)
        yield number, found
    if is_empty and (start is not None or end is not None):
        raise InputError(
            f"no frame lies between --start and --end; {number} frames were read from the source"
        )


def _leavable(frames: Iterator[StampedFrame], stop: Stop) -> Iterator[StampedFrame]:
    """Yield frames until one does not come after a signal."""
    with suppress(StillAtWork):
        while (found := stop.leaving(partial(next, frames, None))) is not None:
            yield found


def cut_short(stop: Stop, source: Source, done: int) -> list[str]:
    """Say that a signal ended the run after `done` frames; empty if it is whole.

    A live source ends by a signal, and so its run is whole then.
    """
    if not stop.came or source.frame_count is None:
        return []
    return [f"a signal ended the run after {done} of {source.frame_count} frames"]

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

"""A part of a source: from one frame or second to another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.reader import StampedFrame


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
        if text.isdecimal() and 1 <= len(text) <= 9 and int(text) >= 1:
            return cls(frame=int(text))
        try:
            seconds = float(text.removesuffix("s")) if text.endswith("s") else math.nan
        except ValueError:
            seconds = math.nan
        if not (math.isfinite(seconds) and seconds >= 0):
            raise InputError(
                f"{text!r} is neither a frame (an integer >= 1) nor a time in seconds, as 4.3s"
            )
        return cls(seconds=seconds)

    def is_after(self, number: int, elapsed: float) -> bool:
        """Return whether the moment is later than frame `number`, `elapsed` s after the first."""
        if self.frame is not None:
            return self.frame > number
        assert self.seconds is not None
        return self.seconds > elapsed + 1e-9  # the rounding of a stamp

    def is_before(self, number: int, elapsed: float) -> bool:
        """Return whether the moment is earlier than that frame."""
        if self.frame is not None:
            return self.frame < number
        assert self.seconds is not None
        return self.seconds < elapsed - 1e-9


def numbered_part(
    frames: Iterable[StampedFrame], start: Moment | None = None, end: Moment | None = None
) -> Iterator[tuple[int, StampedFrame]]:
    """Yield frames with their numbers in the source, from `start` to `end`, both included.

    Raises
    ------
    InputError
        If no frame is in that part.
    """
    first_ns: int | None = None
    number = yielded = 0
    for number, found in enumerate(frames, start=1):
        first_ns = found.stamp_ns if first_ns is None else first_ns
        elapsed = (found.stamp_ns - first_ns) * 1e-9
        if start is not None and start.is_after(number, elapsed):
            continue
        if end is not None and end.is_before(number, elapsed):
            break
        yielded += 1
        yield number, found
    if not yielded and (start is not None or end is not None):
        raise InputError(
            f"no frame lies between --start and --end; {number} frames were read from the source"
        )

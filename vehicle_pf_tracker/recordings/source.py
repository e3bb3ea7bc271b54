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

"""Images, or a part of them, from any source: recordings, videos, folders, cameras, streams."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.footage import Footage, StampedFrame
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.recordings.video import is_recording, open_footage


class Source(Protocol):
    """A stream of stamped images, with truth where it is known.

    Attributes
    ----------
    image_topic : str
        Topic of the images; empty outside of recordings.
    """

    image_topic: str

    @property
    def frame_count(self) -> int | None:
        """Number of images; None where it is unknown."""

    @property
    def notices(self) -> list[str]:
        """Irregularities, a sentence each; complete when all images are read."""

    def frames(self) -> Iterator[StampedFrame]:
        """Yield the images in the order of time."""

    def truth(self) -> Sequence[Truth]:
        """Return the true state of the vehicle, in the order of time."""


def open_source(
    source: str | Path, *, topic: str | None = None, fps: float | None = None
) -> Recording | Footage:
    """Open a recording, a video file, a folder of images, a camera or a stream.

    Parameters
    ----------
    source : str or Path
        Path; index of a camera, as ``0``; or URL, as ``rtsp://...`` or ``https://...``.
    topic : str or None
        The image topic, where a recording has several.
    fps : float or None
        Frame rate of a folder or a video, 1/s; None takes what it states.

    Raises
    ------
    InputError
        If there is no such source, or an option does not fit it.
    """
    path = Path(source)
    if is_recording(path):
        if fps is not None:
            raise InputError(f"{path} is a recording, whose images have stamps; leave --fps out")
        return Recording(path, topic)
    footage = open_footage(source, fps=fps)
    if topic is not None:
        raise InputError(f"{source} is not a recording and has no topics; leave --topic out")
    return footage


def frame_at(
    source: Source, number: int, progress: Callable[[int, int], object] = lambda *_: None
) -> Frame:
    """Return frame `number` of a source, from 1; `progress` takes the frames read, and `number`.

    Raises
    ------
    InputError
        If there are fewer frames, or it cannot be read.
    """
    count = 0
    for count, found in enumerate(source.frames(), start=1):
        progress(count, number)
        if count == number:
            if found.frame is None:
                raise InputError(f"frame {number} cannot be read")
            return found.frame
    raise InputError(f"there is no frame {number}; the source has {count}")


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

    def after(self, number: int, elapsed: float) -> float:
        """Return by how much the moment is later than frame `number`, `elapsed` s from the first.

        The result is negative where it is earlier, and its unit is the moment's own.
        """
        if self.frame is not None:
            return self.frame - number
        assert self.seconds is not None
        return round(self.seconds - elapsed, 9)  # a stamp's rounding


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
        if start is not None and start.after(number, elapsed) > 0:
            continue
        if end is not None and end.after(number, elapsed) < 0:
            break
        yielded += 1
        yield number, found
    if not yielded and (start is not None or end is not None):
        raise InputError(
            f"no frame lies between --start and --end; {number} frames were read from the source"
        )

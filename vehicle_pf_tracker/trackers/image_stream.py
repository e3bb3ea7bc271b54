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

"""Admission of the images of one stream, with the time from one to the next.

The same for one target and for many vehicles, offline and in the nodes.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD, StampClock, StampEvent, Tick
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import CodedFrame, Frame, check_frame, frame_size
from vehicle_pf_tracker.trackers.continuity import (
    Continuation,
    Continuity,
    Size,
    StrayImageError,
    size_words,
)


@dataclass(frozen=True, slots=True)
class Turn:
    """An image that is to be tracked in.

    Attributes
    ----------
    frame : Frame
        The image.
    elapsed : float
        Time since the image before, in nominal frame periods.
    period : float
        Nominal frame period in s.
    events : tuple of str
        Irregularities.
    begins_anew : bool
        True where nothing of the images before holds any more: of another size, or time went back.
    leaps : bool
        True where the stamp may prove to be ahead when the next image comes.
    corrects : bool
        True where the stamp of the image before has proved to be ahead.
    """

    frame: Frame
    elapsed: float
    period: float
    events: tuple[str, ...]
    begins_anew: bool
    leaps: bool
    corrects: bool


class ImageStream:
    """Decides which images of a stream are tracked in, and when.

    One odd image, of another size or out of its time, is rejected and kept aside. If the next one
    agrees with it, the stream has changed, and both are admitted.

    Parameters
    ----------
    frame_rate : float
        Nominal rate in 1/s; 0 takes the median of the first ten intervals.
    reset_on_time_jump : bool
        Begin anew when stamps go back and stay back.
    """

    def __init__(self, frame_rate: float, reset_on_time_jump: bool) -> None:
        self._frame_rate = frame_rate
        self._resets = reset_on_time_jump
        self.reset()

    @property
    def size(self) -> Size | None:
        """Width and height in px that images are expected to have; None for any size."""
        return self._continuity.size

    def reset(self) -> None:
        """Discard size and time of the images before."""
        self._clock = StampClock(self._frame_rate)
        self._clock_before: StampClock | None = None
        self._continuity = Continuity()
        self._aside: tuple[Frame | CodedFrame, int] | None = None
        self._last_size: Size | None = None

    def reconfigure(self, frame_rate: float, reset_on_time_jump: bool) -> None:
        """Take new settings between two images."""
        self._frame_rate, self._resets = frame_rate, reset_on_time_jump
        for clock in (self._clock, self._clock_before):
            if clock is not None:
                clock.set_frame_rate(frame_rate)

    def admit(
        self, image: Frame | CodedFrame, stamp_ns: int, *, is_tracking: bool = True
    ) -> list[Turn]:
        """Return the images to track in now: this one, after the one kept aside if it confirms it.

        Parameters
        ----------
        image : (H, W, 3) array or CodedFrame
            RGB; not written to, and copied where it has to be kept. A coded one is decoded only if
            its size is expected, or the next one agrees with it.
        stamp_ns : int
            The image's stamp in ns.
        is_tracking : bool
            False while there is nothing to track, so that stamps do not matter.

        Raises
        ------
        StrayImageError
            If the image does not continue the stream.
        InputError
            If it is not usable.
        """
        aside, self._aside = self._aside, None
        image = self._decoded_if_expected(image, aside[0] if aside else None)
        try:
            continuation = self._continuity.judge(_size(image), stamp_ns, timed=is_tracking)
        except StrayImageError:
            self._aside = image.copy() if isinstance(image, np.ndarray) else image, stamp_ns
            raise
        turns = []
        if continuation is Continuation.CONFIRMS and aside is not None:
            frame = _decoded_if_whole(aside[0])
            if frame is not None:
                turns.append(self._turn(frame, aside[1], continuation, is_tracking))
        turns.append(self._turn(_decoded(image), stamp_ns, continuation, is_tracking))
        return turns

    def _decoded_if_expected(
        self, image: Frame | CodedFrame, aside: Frame | CodedFrame | None
    ) -> Frame | CodedFrame:
        """Decode a coded image unless it may be a stray, of any size."""
        if isinstance(image, np.ndarray):
            return check_frame(image)
        expected = {self.size, _size(aside) if aside is not None else self.size}
        # A camera that was turned by 90 degrees says so in the file, and is turned in decoding.
        return image.decode() if expected & {None, image.size, image.size[::-1]} else image

    def _turn(
        self, frame: Frame, stamp_ns: int, continuation: Continuation, is_tracking: bool
    ) -> Turn:
        corrects, leaps = continuation is Continuation.CORRECTS, continuation is Continuation.LEAPS
        events = []
        if corrects:
            events.append("the last image's stamp was ahead")
            self._clock = self._clock_before or StampClock(self._frame_rate)
        self._clock_before = copy.deepcopy(self._clock) if leaps else None
        is_timed = continuation is not Continuation.UNTIMED
        tick = self._clock.tick(stamp_ns) if is_timed else Tick(1.0, StampEvent.UNUSABLE)
        begins_anew = tick.event is StampEvent.JUMP_BACK and self._resets
        if tick.event is not None:
            events.append(tick.event.value)
        if begins_anew:
            self._clock = StampClock(self._frame_rate)
            tick = self._clock.tick(stamp_ns)
        size, before = frame_size(frame), self._last_size
        self._last_size = size
        if is_tracking and before is not None and before != size:
            change = f"from {size_words(before)} to {size_words(size)}"
            events.append(f"image size changed {change}; starting again")
            begins_anew = True
        period = self._clock.period or DEFAULT_PERIOD
        return Turn(frame, tick.elapsed, period, tuple(events), begins_anew, leaps, corrects)


def _size(image: Frame | CodedFrame) -> Size:
    return frame_size(image) if isinstance(image, np.ndarray) else image.size


def _decoded(image: Frame | CodedFrame) -> Frame:
    return image if isinstance(image, np.ndarray) else image.decode()


def _decoded_if_whole(image: Frame | CodedFrame) -> Frame | None:
    try:
        return _decoded(image)
    except InputError:
        return None

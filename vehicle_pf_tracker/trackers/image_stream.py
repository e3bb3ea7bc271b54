# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Admission of the images of one stream, with the time from one to the next.

One way for one target and for many vehicles, offline and in the nodes.
"""

from __future__ import annotations

import copy
import operator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD, StampClock, StampEvent, Tick
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.trackers.continuity import (
    Continuation,
    Continuity,
    Size,
    StrayImageError,
    size_words,
)

_SHORTEST_NS = 100_000
"""Interval in ns below which stamps are in another unit: ten times the highest rate that can be
set. Of an ordinary camera, it is one of seconds, ms or µs that were taken for ns."""
_OTHER_UNIT = "stamps less than 0.1 ms apart: they are taken as ns; are they in seconds, ms or µs?"


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
        Begin anew when stamps go back by a second or more, and stay back.
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
        self._aside: tuple[Frame | CodedImage, int] | None = None
        self._last_size: Size | None = None
        self._last_ns: int | None = None

    def reconfigure(self, frame_rate: float, reset_on_time_jump: bool) -> None:
        """Take new settings between two images."""
        self._frame_rate = frame_rate
        self._resets = reset_on_time_jump
        for clock in (self._clock, self._clock_before):
            if clock is not None:
                clock.set_frame_rate(frame_rate)

    def admit(
        self, image: Frame | CodedImage, stamp_ns: int, *, is_tracking: bool = True
    ) -> list[Turn]:
        """Return the images to track in now: this one, after the one kept aside if it confirms it.

        Parameters
        ----------
        image : (H, W, 3) array or CodedImage
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
            If it is not usable, or its stamp is no integer.
        """
        # First: a stamp in seconds would be judged as one of 1970.
        stamp_ns = checked_stamp(stamp_ns)
        aside = self._aside
        self._aside = None
        if isinstance(image, np.ndarray):
            check_frame(image)
        else:
            # Coded images are decoded only if they may be used: a stray one may be of any size.
            expected = {self.size, _size(aside[0]) if aside is not None else self.size}
            # A camera that was turned by 90 degrees says so in the file, and is turned in decoding.
            if expected & {None, image.size, image.size[::-1]}:  # else a stray, of any size
                image = image.decode()
        try:
            continuation = self._continuity.judge(_size(image), stamp_ns, timed=is_tracking)
        except StrayImageError:
            # Copied: a driver may reuse its buffer.
            self._aside = image.copy() if isinstance(image, np.ndarray) else image, stamp_ns
            raise
        turns = []
        if continuation is Continuation.CONFIRMS and aside is not None:
            with suppress(InputError):  # a coded one may be damaged
                frame = _decoded(aside[0])
                turns.append(self._turn(frame, aside[1], continuation))
        turns.append(self._turn(_decoded(image), stamp_ns, continuation))
        return turns

    def _turn(self, frame: Frame, stamp_ns: int, continuation: Continuation) -> Turn:
        corrects = continuation is Continuation.CORRECTS
        leaps = continuation is Continuation.LEAPS
        events = []
        if corrects:
            events.append("the last image's stamp was ahead")
            # The clock goes back with the image: its interval was not real.
            self._clock = self._clock_before or StampClock(self._frame_rate)
        self._clock_before = copy.deepcopy(self._clock) if leaps else None
        is_timed = continuation is not Continuation.UNTIMED
        # Without a clock each image counts as one period.
        tick = self._clock.tick(stamp_ns) if is_timed else Tick(1.0, StampEvent.UNUSABLE)
        # Told once per image: the track goes on, at speeds that make no sense.
        if self._last_ns is not None and 0 < stamp_ns - self._last_ns < _SHORTEST_NS:
            events.append(_OTHER_UNIT)
        self._last_ns = stamp_ns
        # A recording played again, which starts a track again where that is asked for.
        begins_anew = tick.event is StampEvent.JUMP_BACK and self._resets
        if tick.event is not None:
            events.append(tick.event.value)
        if begins_anew:
            self._clock = StampClock(self._frame_rate)
            tick = self._clock.tick(stamp_ns)
        size = frame_size(frame)
        before = self._last_size
        self._last_size = size
        # Pixels of another size are other places: nothing of the track can be carried over, and a
        # target that was refused may fit.
        if before is not None and before != size:
            change = f"from {size_words(before)} to {size_words(size)}"
            events.append(f"image size changed {change}; starting again")
            begins_anew = True
        # Until intervals are known, 30 Hz: the commonest rate.
        period = self._clock.period or DEFAULT_PERIOD
        return Turn(frame, tick.elapsed, period, tuple(events), begins_anew, leaps, corrects)


def checked_stamp(stamp_ns: object) -> int:
    """Return a stamp in ns as an integer of Python.

    Raises
    ------
    InputError
        If it is not an integer, as one in seconds would be.
    """
    try:
        return operator.index(stamp_ns)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(
            f"the stamp {stamp_ns!r} is not an integer: stamp_ns is in nanoseconds; "
            "give round(1e9 * seconds)"
        ) from None


def _size(image: Frame | CodedImage) -> Size:
    return frame_size(image) if isinstance(image, np.ndarray) else image.size


def _decoded(image: Frame | CodedImage) -> Frame:
    return image if isinstance(image, np.ndarray) else image.decode()

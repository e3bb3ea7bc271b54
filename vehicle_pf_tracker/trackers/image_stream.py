# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Admission of the images of one stream, with the time from one to the next.

Cameras, drivers and networks now and then deliver one image that does not belong: of another size,
without a stamp, with a stamp of yesterday or of tomorrow. A track must not pay for it. Real changes
appear the same at first, but they last. So an odd image is rejected, and accepted after all if a
second one agrees with it. A stamp that is ahead by no more than a gap cannot be distinguished from
one; it is noticed when the next image continues the one before it.

The same for one target and for many vehicles, offline and in the nodes.
"""

from __future__ import annotations

import copy
import operator
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

import numpy as np

from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD, StampClock, StampEvent, Tick
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.image.compressed_image import CodedImage

Size = tuple[int, int]

LONGEST_GAP_NS = 5_000_000_000
"""Distance of stamps in ns that is always accepted: a camera that pauses for seconds is common."""

_SLOWER = 3
"""Intervals of the previous length that a gap may last: slow cameras have long intervals too, and
may drop two images."""

_LATE = 1.5
"""Usual intervals after which a stamp may be ahead: one that makes the next image go back, which
comes two intervals after the image before, is at least two late; half a one allows for jitter."""

_REMEMBERED = 10
"""Intervals whose smallest is the usual one: it survives a run of dropped images."""

_SHORTEST_NS = 100_000
"""Interval in ns below which stamps are in another unit: ten times the highest rate that can be
set. Of an ordinary camera, it is one of seconds, ms or µs that were taken for ns."""
_OTHER_UNIT = "stamps less than 0.1 ms apart: they are taken as ns; are they in seconds, ms or µs?"

PATIENCE = 10
"""Odd stamps in a row after which a camera is taken to have no usable clock."""

_AGREED = "; rejected unless the next image agrees with it"


class StrayImageError(InputError):
    """Image that does not continue the stream it came in."""


class Continuation(Enum):
    """Relation of an image to those before it."""

    CONTINUES = "continues the stream"
    LEAPS = "comes later than usual, so that its stamp may be ahead"
    CORRECTS = "continues the image before the last, whose stamp was ahead"
    CONFIRMS = "agrees with the rejected image before it; both are accepted"
    UNTIMED = "has an unusable stamp, as all those before it"


@dataclass(frozen=True, slots=True)
class _Image:
    """Part of an image that decides about the stream."""

    size: Size
    stamp_ns: int


class Continuity:
    """Judge of the images of one stream, in their order."""

    def __init__(self) -> None:
        self._last: _Image | None = None
        self._before: _Image | None = None
        self._intervals: deque[int] = deque(maxlen=_REMEMBERED)
        self._last_leapt = False
        self._doubted: _Image | None = None
        self._interval_ns = 0
        self._believed = 0
        self._odd = 0

    @property
    def size(self) -> Size | None:
        """Width and height in px of the accepted images; None before the first."""
        return self._last.size if self._last else None

    def judge(self, size: Size, stamp_ns: int, *, timed: bool) -> Continuation:
        """Judge the next image.

        Parameters
        ----------
        size : (int, int)
            Width and height in px.
        stamp_ns : int
            Its stamp in ns.
        timed : bool
            True where its stamp matters: not while nothing is tracked.

        Raises
        ------
        StrayImageError
            With the reason, if it is to be left out.
        """
        image = _Image(size, stamp_ns)
        reason = self._oddity(image, timed)
        if reason is None:
            self._believe(image, stamp_ns - self._last.stamp_ns if self._last else 0)
            return Continuation.LEAPS if timed and self._last_leapt else Continuation.CONTINUES
        if self._doubted is not None and self._agrees(image, self._doubted):
            self._believe(image, stamp_ns - self._doubted.stamp_ns)
            return Continuation.CONFIRMS
        if self._shows_last_ahead(image):
            self._last = self._before
            self._believe(image, stamp_ns - self._last.stamp_ns if self._last else 0)
            return Continuation.CORRECTS
        self._doubted = image
        self._odd += 1
        if self._odd > PATIENCE and size == self.size:
            return Continuation.UNTIMED
        raise StrayImageError(reason + _AGREED)

    def _oddity(self, image: _Image, timed: bool) -> str | None:
        if self._last is None:
            return None
        if image.size != self._last.size:
            usual = _words(self._last.size)
            return f"the image is of {_words(image.size)} px among images of {usual} px"
        interval = image.stamp_ns - self._last.stamp_ns
        if timed and interval < 0:
            return f"the image's stamp goes back by {-interval * 1e-9:.3f} s"
        if timed and interval > max(LONGEST_GAP_NS, _SLOWER * self._interval_ns):
            return f"the image's stamp leaps ahead by {interval * 1e-9:.3f} s"
        return None

    def _agrees(self, image: _Image, doubted: _Image) -> bool:
        assert self._last is not None
        interval = image.stamp_ns - doubted.stamp_ns
        leap = doubted.stamp_ns - self._last.stamp_ns  # of a camera that has become this slow
        longest = max(LONGEST_GAP_NS, leap + leap // 2)
        return image.size == doubted.size and 0 <= interval <= longest

    def _shows_last_ahead(self, image: _Image) -> bool:
        """Test whether `image` continues the stream if the last image is left out."""
        assert self._last is not None
        if image.size != self._last.size or image.stamp_ns >= self._last.stamp_ns:
            return False
        if self._before is None:
            return self._believed == 1  # the first image's stamp has nothing on its side either
        return self._last_leapt and image.stamp_ns > self._before.stamp_ns

    def _believe(self, image: _Image, interval_ns: int) -> None:
        self._believed += 1
        self._before = self._last
        self._last = image
        self._doubted = None
        self._odd = 0
        self._last_leapt = interval_ns > _LATE * min(self._intervals, default=0)
        self._interval_ns = interval_ns
        if interval_ns > 0:
            self._intervals.append(interval_ns)


def _words(size: Size) -> str:
    """Describe a size in px."""
    return f"{size[0]}x{size[1]}"


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
        stamp_ns = checked_stamp(stamp_ns)
        aside = self._aside
        self._aside = None
        if isinstance(image, np.ndarray):
            check_frame(image)
        else:
            expected = {self.size, _size(aside[0]) if aside is not None else self.size}
            # A camera that was turned by 90 degrees says so in the file, and is turned in decoding.
            if expected & {None, image.size, image.size[::-1]}:  # else a stray, of any size
                image = image.decode()
        try:
            continuation = self._continuity.judge(_size(image), stamp_ns, timed=is_tracking)
        except StrayImageError:
            self._aside = image.copy() if isinstance(image, np.ndarray) else image, stamp_ns
            raise
        turns = []
        if continuation is Continuation.CONFIRMS and aside is not None:
            with suppress(InputError):  # a coded one may be damaged
                frame = _decoded(aside[0])
                turns.append(self._turn(frame, aside[1], continuation, is_tracking))
        turns.append(self._turn(_decoded(image), stamp_ns, continuation, is_tracking))
        return turns

    def _turn(
        self, frame: Frame, stamp_ns: int, continuation: Continuation, is_tracking: bool
    ) -> Turn:
        corrects = continuation is Continuation.CORRECTS
        leaps = continuation is Continuation.LEAPS
        events = []
        if corrects:
            events.append("the last image's stamp was ahead")
            self._clock = self._clock_before or StampClock(self._frame_rate)
        self._clock_before = copy.deepcopy(self._clock) if leaps else None
        is_timed = continuation is not Continuation.UNTIMED
        tick = self._clock.tick(stamp_ns) if is_timed else Tick(1.0, StampEvent.UNUSABLE)
        if self._last_ns is not None and 0 < stamp_ns - self._last_ns < _SHORTEST_NS:
            events.append(_OTHER_UNIT)
        self._last_ns = stamp_ns
        begins_anew = tick.event is StampEvent.JUMP_BACK and self._resets
        if tick.event is not None:
            events.append(tick.event.value)
        if begins_anew:
            self._clock = StampClock(self._frame_rate)
            tick = self._clock.tick(stamp_ns)
        size = frame_size(frame)
        before = self._last_size
        self._last_size = size
        if is_tracking and before is not None and before != size:
            change = f"from {_words(before)} to {_words(size)}"
            events.append(f"image size changed {change}; starting again")
            begins_anew = True
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

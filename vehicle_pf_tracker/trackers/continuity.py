# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Judge of whether an image continues the stream that it came in.

Cameras, drivers and networks now and then deliver one image that does not belong: of another size,
without a stamp, with a stamp of yesterday or of tomorrow. A track must not pay for it. Real changes
appear the same at first, but they last. So an odd image is rejected, and accepted after all if a
second one agrees with it. A stamp that is ahead by no more than a gap cannot be distinguished from
one; it is noticed when the next image continues the one before it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum

from vehicle_pf_tracker.core.errors import InputError

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
ODD_STAMP_PATIENCE = 10
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
            Stamp of the image, ns.
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
        # Before the others: of two that agree with each other the stream has changed.
        if self._doubted is not None and self._agrees(image, self._doubted):
            self._believe(image, stamp_ns - self._doubted.stamp_ns)
            return Continuation.CONFIRMS
        if self._shows_last_ahead(image):
            self._last = self._before
            self._believe(image, stamp_ns - self._last.stamp_ns if self._last else 0)
            return Continuation.CORRECTS
        self._doubted = image
        self._odd += 1
        # A clock that never agrees is no reason to lose the target: frames count one period each.
        if self._odd > ODD_STAMP_PATIENCE and size == self.size:
            return Continuation.UNTIMED
        raise StrayImageError(reason + _AGREED)

    def _oddity(self, image: _Image, timed: bool) -> str | None:
        if self._last is None:
            return None
        if image.size != self._last.size:
            usual = size_words(self._last.size)
            return f"the image is of {size_words(image.size)} px among images of {usual} px"
        # Size before time: an image of another camera has a stamp of its own.
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
        # The two have to agree with each other, not with what was before them.
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
        # Against the smallest interval: a mean would grow with every dropped image.
        self._last_leapt = interval_ns > _LATE * min(self._intervals, default=0)
        self._interval_ns = interval_ns
        if interval_ns > 0:
            self._intervals.append(interval_ns)


def size_words(size: Size) -> str:
    """Describe a size in px."""
    return f"{size[0]}x{size[1]}"

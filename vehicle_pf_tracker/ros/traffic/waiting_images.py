# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images that wait for the detections of their stamp."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

from vehicle_pf_tracker.detection.detections import Detections

MOST_WAITING = 16
"""Images that may wait: half a second at 30 Hz; of 1080p they are 100 MB."""
_PASSED_ON = 100
"""Images passed on whose detections are recognised as late: 3 s at 30 Hz, after which a detector
has stalled."""
_EARLY = 100
"""Detections kept whose image has not come: 3 s at 30 Hz. An image is never overtaken so long; its
stamp was not copied."""

ImageT = TypeVar("ImageT")


@dataclass(slots=True)
class _Waiting(Generic[ImageT]):
    """An image with its number in the stream, when it came and has waited for long enough, s."""

    image: ImageT
    stamp_ns: int
    number: int
    came: float
    until: float
    is_answered: bool = False
    detections: Detections | None = None


class WaitingImages(Generic[ImageT]):
    """Passes on images in their order, each with its detections or without.

    An image waits for detections of exactly its stamp: until they come, those of a later image come
    (a detector answers in order), or it has waited for too long. A detector may answer every k-th
    image; the others do not wait.

    Parameters
    ----------
    clock : callable
        Steady time in s.

    Attributes
    ----------
    matched, missed, late, unmatched : int
        Images with detections, images that waited in vain, detections that came after their image
        was passed on, and detections of stamps that no image has.
    latency : float
        Time that the last image with detections waited for them, s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.matched = 0
        self.missed = 0
        self.late = 0
        self.unmatched = 0
        self.latency = 0.0
        self._clock = clock
        self._images: deque[_Waiting[ImageT]] = deque()
        self._early: dict[int, Detections | None] = {}
        self._passed: dict[int, int] = {}
        self._number = 0
        self._awaited = 0

    def __len__(self) -> int:
        return len(self._images)

    @property
    def remembered(self) -> int:
        """Number of stamps that are kept without an image: of early and of late detections."""
        return len(self._early) + len(self._passed)

    def add_image(self, image: ImageT, stamp_ns: int, max_wait: float) -> None:
        """Take the next image, which may wait for `max_wait` s."""
        now = self._clock()
        waiting = _Waiting(image, stamp_ns, self._number, now, now + max_wait)
        if stamp_ns in self._early:
            waiting.is_answered = True
            waiting.detections = self._early.pop(stamp_ns)
        self._number += 1
        self._images.append(waiting)

    def add_detections(self, stamp_ns: int, detections: Detections | None, every: int = 1) -> None:
        """Take the detections of an image; None: the answer cannot be used.

        The detector answers every `every`-th image.
        """
        for waiting in self._images:
            if waiting.stamp_ns == stamp_ns and not waiting.is_answered:
                waiting.is_answered = True
                waiting.detections = detections
                self.latency = self._clock() - waiting.came
                return
        if stamp_ns in self._passed:
            self.late += 1
            self._awaited = self._passed.pop(stamp_ns) + every
            return
        self._early[stamp_ns] = detections
        if len(self._early) > _EARLY:
            del self._early[next(iter(self._early))]
            self.unmatched += 1

    def ready(self, every: int = 1) -> Iterator[tuple[ImageT, Detections | None]]:
        """Pass on the images that need not wait any longer."""
        while self._images:
            first = self._images[0]
            if not first.is_answered and self._waits(first):
                return
            self._images.popleft()
            if first.is_answered:
                self.matched += 1
                self._awaited = first.number + every
            else:
                self.missed += first.number >= self._awaited
                self._passed[first.stamp_ns] = first.number
                if len(self._passed) > _PASSED_ON:
                    del self._passed[next(iter(self._passed))]
            yield first.image, first.detections

    def clear(self) -> None:
        """Forget all images and detections."""
        self._images.clear()
        self._early.clear()
        self._passed.clear()

    def _waits(self, first: _Waiting[ImageT]) -> bool:
        return (
            first.number >= self._awaited
            and self._clock() < first.until
            and len(self._images) <= MOST_WAITING
            and not any(image.is_answered for image in self._images)
        )

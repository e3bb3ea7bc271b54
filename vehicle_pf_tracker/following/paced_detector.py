# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detector that looks at every k-th image, k chosen so that the images' rate is kept."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import Detector, FollowedVehicle

_SHARE = 0.8
"""Share of the images' period that detecting and following may take, a choice; decoding and
drawing need the rest."""
_LONGEST = 0.1
"""Longest time between two looks of a detector, s, also where the rate cannot be kept. On a dual
carriageway at 30 Hz every third image leaves 97 % of IDF1, every sixth 56 %."""
_RECENT = 0.1
"""Weight of the latest image among the costs: a mean over ten follows a load of the machine within
a second, and one slow image changes nothing."""

Run: TypeAlias = Callable[[Callable[[], Detections]], Detections]
"""Function that calls another one and returns its detections, as `call` does: it may do so in a
thread that can be left."""


def call(work: Callable[[], Detections]) -> Detections:
    """Call `work`, and return what it returns."""
    return work()


def every_image() -> int:
    """Return 1, for a detector that looks at every image."""
    return 1


class PacedDetector:
    """A detector that looks at every k-th image; what it found last, and how long that took.

    Parameters
    ----------
    detector : Detector
        The detector.
    wanted : callable
        Returns k, which may change; 0 chooses the smallest that keeps the rate of the images.
    run : callable
        Calls the detector.

    Attributes
    ----------
    every : int
        k in use, which differs between machines where it is chosen.
    found : int
        Number of detections in the last image that it looked at.
    seconds : float
        Time that they took, s.
    disturbed, is_blind : bool
        See `Detector`.
    """

    def __init__(
        self, detector: Detector, wanted: Callable[[], int] = every_image, run: Run = call
    ) -> None:
        self._detector = detector
        self._run = run
        self._wanted = wanted
        self.every = 1
        self.found = 0
        self.seconds = 0.0
        self.disturbed = self.is_blind = False
        self._images = 0
        # Mean time in s that an image costs without the detector, kept from image to image.
        self._others = 0.0

    def detect(
        self,
        frame: Frame,
        tracks: Sequence[FollowedVehicle] = (),
        period: float = DEFAULT_PERIOD,
    ) -> Detections:
        """Find vehicles, if it is this image's turn; see `Detector`."""
        self._images += 1
        # 0 leaves the choice to `pace`, after the last image.
        self.every = self._wanted() or self.every
        # Of this image alone: a camera is not disturbed where nobody looked.
        self.disturbed = False
        self.is_blind = self._images > 1 and self._images <= self.every
        if self.is_blind:
            return Detections.make([], [])
        passed = max(self._images - 1, 1)
        self._images = 1
        began = time.perf_counter()
        detections = self._run(partial(self._detector.detect, frame, tracks, passed * period))
        self.found = len(detections)
        self.seconds = time.perf_counter() - began
        self.disturbed = self._detector.disturbed
        self.is_blind = self._detector.is_blind
        return detections

    def pace(self, seconds: float, period: float) -> None:
        """Take the time that the last image cost in all, and the images' period, s."""
        # Only an image that was looked at has the detector's cost in it.
        others = seconds - (self.seconds if self._images == 1 else 0.0)
        self._others += (others - self._others) * (_RECENT if self._others else 1.0)
        if self._wanted() == 0:
            # Bounded in time and not in images: vehicles drive on between two looks.
            most = max(round(_LONGEST / period), 1)
            left = _SHARE * period - self._others
            least = math.ceil(self.seconds / left) if left > 0 else most
            self.every = min(max(least, 1), most)

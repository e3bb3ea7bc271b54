# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A detector that works, and fails now and then: each way to fail in its turn."""

from __future__ import annotations

import itertools
from collections import Counter

from std_msgs.msg import Header

from laboratory.faults.detector import Detector, Fault
from vehicle_pf_tracker.core.array import Array

FAILURE_EVERY = 20.0
"""Seconds from one failure to the next."""
FAILURE_LASTS = 2.0
"""Seconds that a failure lasts: a node waits in vain for a second, and then says so."""


class FailingDetector:
    """Publishes the detections of each image, or what a failure makes of them.

    Parameters
    ----------
    detector : Detector
        Publishes them.
    rate : float
        Images per second.
    counts : Counter of str
        Takes how often it failed in each way.
    never_fails : bool
        True for one that always works.
    """

    def __init__(
        self, detector: Detector, rate: float, counts: Counter[str], *, never_fails: bool
    ) -> None:
        self._detector = detector
        self._rate = rate
        self._counts = counts
        self._never_fails = never_fails
        self._ways = itertools.cycle(detector.faults.items())
        self._fault: Fault | None = None

    def publish(self, number: int, header: Header, boxes: Array) -> None:
        """Publish the detections of the image `number`."""
        since = number % round(FAILURE_EVERY * self._rate)
        # At first it works: the node must have vehicles before it can lose them.
        is_first = number < FAILURE_EVERY * self._rate
        if self._never_fails or is_first or since > FAILURE_LASTS * self._rate:
            self._detector.right(header, boxes)
            return
        if since == 0 or self._fault is None:
            words, self._fault = next(self._ways)
            self._counts[f"detector: {words}"] += 1
        self._fault(header, boxes)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Health of a node: what came of its images and targets, by the names of its report."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from vehicle_pf_tracker.ros.messages import WAITING_MESSAGE
from vehicle_pf_tracker.ros.node.arrivals import Arrivals


class Failures:
    """Number of failures of one kind, and the reason of the last.

    Attributes
    ----------
    count : int
        Failures so far.
    last : str
        Reason of the last; empty before the first.
    """

    def __init__(self) -> None:
        self.count = 0
        self.last = ""

    def add(self, reason: str) -> None:
        """Count a failure for this reason."""
        self.count += 1
        self.last = reason


class Health:
    """Health of a node since it was configured; rates are those since the last report.

    Parameters
    ----------
    clock : callable
        Steady time in s.

    Attributes
    ----------
    arrivals : Arrivals
        Images that came.
    rejections : Failures
        Images that could not be used.
    refusals : Failures
        Targets that could not be used.
    restarts : int
        Times that the tracker failed twice in a row and started anew.
    mode : str
        Mode of the last `~/mode`.
    road : mapping
        Position and speed on the road with the last estimate, by name; empty without a road.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.arrivals = Arrivals(clock)
        self.rejections = Failures()
        self.refusals = Failures()
        self.restarts = 0
        self.mode = WAITING_MESSAGE
        self.road: Mapping[str, object] = {}
        self._clock = clock
        self._mode_since = clock()
        self._step_ms = 0.0

    def answered(self, mode: str, step_ms: float | None = None) -> None:
        """Note the mode that an image was answered with, and how long the step took."""
        # Only a change starts the clock: the report says how long the mode has lasted.
        if mode != self.mode:
            self.mode = mode
            self._mode_since = self._clock()
        if step_ms is not None:
            self._step_ms = step_ms

    def report(self) -> dict[str, object]:
        """Return the values for `/diagnostics` by name, and begin the next interval."""
        arrivals = self.arrivals
        return {
            "mode": self.mode,
            "time in mode (s)": round(self._clock() - self._mode_since, 1),
            "input rate (Hz)": round(arrivals.rate(), 2),
            "age of frames (ms)": round(arrivals.age * 1e3, 1),
            "step time (ms)": round(self._step_ms, 3),
            "images": arrivals.images,
            "dropped": arrivals.dropped,
            "rejected": self.rejections.count,
            "last rejection": self.rejections.last,
            "refused targets": self.refusals.count,
            "last refused target": self.refusals.last,
            "restarts after errors": self.restarts,
            "time since last image (s)": round(arrivals.silence, 1),
            **self.road,
        }

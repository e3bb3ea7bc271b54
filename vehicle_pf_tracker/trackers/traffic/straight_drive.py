# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that detections are those of something that drives."""

from __future__ import annotations

import math

import numpy as np

_STRAIGHT = 0.8
"""Straightness of a drive, which a leap between two places that flicker cannot reach (0.75)."""


class StraightDrive:
    """Regression of the places of detections on their times."""

    def __init__(self) -> None:
        self._sums = np.zeros(8)

    def add(self, time: float, x: float, y: float) -> None:
        """Add a detection: its time in nominal periods and its centre in px."""
        self._sums += (1, time, time**2, x, y, time * x, time * y, x * x + y * y)

    def evidence(self) -> float:
        """Logarithm of how rarely detections that shake in one place are as straight.

        They shake independently, and a drive has constant speed; 0 where they are not straight.
        """
        count, time, squared, x, y, time_x, time_y, places = self._sums.tolist()
        if not count:
            return 0.0
        scatter = places - (x * x + y * y) / count
        duration = squared - time * time / count
        if scatter <= 0 or duration <= 0:
            return 0.0
        along_x, along_y = time_x - time * x / count, time_y - time * y / count
        # Share of their scatter that the drive explains.
        straightness = float((along_x**2 + along_y**2) / duration / scatter)
        if straightness < _STRAIGHT:
            return 0.0
        # The share is distributed as Beta(1, count - 2): two slopes, of twice as many coordinates.
        return float(2 - count) * math.log(max(1 - straightness, math.ulp(1.0)))

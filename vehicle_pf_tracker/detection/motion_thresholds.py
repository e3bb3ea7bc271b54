# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Thresholds of the detection of motion."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MotionThresholds:
    """Thresholds of the detection of motion.

    Attributes
    ----------
    colour_threshold : float
        Least sum of the differences of the three channels of a pixel that has changed.
    patience : float
        Images for which what has changed is not learnt as background: four seconds, in which a slow
        lorry passes.
    shadow : float
        Least brightness of a shadow, of the background's.
    apart : float
        Advantage in shape above which a blob is taken for several vehicles.
    """

    colour_threshold: float = 32.0
    patience: float = 100.0
    shadow: float = 0.6
    apart: float = 1.0


SHIPPED = MotionThresholds()
"""Thresholds in use."""

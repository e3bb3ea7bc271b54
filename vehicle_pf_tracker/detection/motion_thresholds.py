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
        Least sum of the absolute differences of the three channels, 0 to 765, of a pixel that has
        changed. A choice: noise of a few levels a channel stays below it.
    patience : float
        Time in s for which what has changed is not learnt as background: a slow lorry passes in it.
    shadow : float
        Least brightness of a shadow, fraction of the background's. Chosen on seventeen clips.
    apart : float
        Advantage in shape cost, squared standard deviations, above which a blob is taken for
        several vehicles: one standard deviation.
    """

    colour_threshold: float = 32.0
    patience: float = 4.0
    shadow: float = 0.6
    apart: float = 1.0


SHIPPED_THRESHOLDS = MotionThresholds()
"""Thresholds in use."""

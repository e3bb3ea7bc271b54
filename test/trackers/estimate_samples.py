# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates made by hand."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode


def estimate(centre=(100.0, 80.0), *, size=(20.0, 10.0), mode=Mode.TRACKING, regime="clear",
             velocity=(0.0, 0.0), confidence=1.0, particles=None, weights=None):  # fmt: skip
    """Estimate at `centre` with a cloud of one particle there unless others are given."""
    positions = np.array([centre] if particles is None else particles, float)
    shares = np.full(len(positions), 1 / len(positions)) if weights is None else np.array(weights)
    return Estimate(
        centre, Box.around(centre, *size), velocity, mode, regime, confidence, {}, 1.0, 0, 0,
        positions, shares,
    )  # fmt: skip

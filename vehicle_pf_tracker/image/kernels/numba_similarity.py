# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bhattacharyya coefficient of one window's counts, in numba (see `image.windows.similarity`)."""

from __future__ import annotations

import math

import numpy as np

from vehicle_pf_tracker.image.kernels.numba_types import Counts, Reals
from vehicle_pf_tracker.image.kernels.toolchain.kernel import inlined


@inlined
def overlap(counts: Counts, values: Reals, total: int, roots: Reals) -> float:
    """Bhattacharyya coefficient of counts with a reference, whose roots are `values`."""
    overlap = 0.0
    # A table of roots is faster than roots, as far as it stays in the cache.
    if total < len(roots):
        for k in range(len(values)):
            overlap += values[k] * roots[counts[k]]
    else:
        for k in range(len(values)):
            overlap += values[k] * math.sqrt(np.float64(counts[k]))
    return min(overlap / math.sqrt(max(total, 1)), 1.0)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarities of windows that are counted already, in numba."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.image.kernels.numba_similarity import overlap
from vehicle_pf_tracker.image.kernels.numba_types import COUNTS, SCALE, Counts, Pixels, Reals, Scale
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled


@compiled("float64[::1]", COUNTS, "int64[::1]", SCALE)
def compare_counts(counts: Counts, totals: Pixels, scale: Scale) -> Reals:
    """Compare windows that are counted already; `totals` are those of all bins, shape (N,)."""
    values, roots = scale
    if counts.shape[1] != len(values) or len(totals) != len(counts):
        raise IndexError("the counts are not those of the reference's cells")
    result = np.empty(len(counts))
    for i in range(len(counts)):
        least = np.int32(0)
        most = np.int32(0)
        for k in range(len(values)):
            least, most = min(least, counts[i, k]), max(most, counts[i, k])
        if least < 0 or most > totals[i]:
            raise IndexError("more of a bin are counted than of all together")
        result[i] = overlap(counts[i], values, totals[i], roots)
    return result

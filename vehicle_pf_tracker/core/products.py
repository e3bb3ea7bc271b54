# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Matrix products with the same bits on any number of threads.

OpenBLAS, which numpy uses, cuts a large product into one piece per thread, and rounds at the edges
of pieces otherwise than inside; `OMP_NUM_THREADS`, or the number of cores, would change estimates.
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

_FloatT = TypeVar("_FloatT", bound=np.floating[Any])

SERIAL = 1 << 18
"""Multiplications up to which OpenBLAS gives a product to one thread (its interface/gemm.c:
SMP_THRESHOLD_MIN times GEMM_MULTITHREAD_THRESHOLD)."""


def product(left: npt.NDArray[_FloatT], right: npt.NDArray[_FloatT]) -> npt.NDArray[_FloatT]:
    """Matrix products (..., m, n) of (..., m, k) and (..., k, n) arrays, in pieces of one thread.

    The longer side of a product is cut.
    """
    rows, inner = left.shape[-2:]
    columns = right.shape[-1]
    longer = max(rows, columns)
    piece = max(SERIAL * longer // max(rows * inner * columns, 1), 1)
    if piece >= longer:
        return np.asarray(left @ right)
    parts = [slice(first, first + piece) for first in range(0, longer, piece)]
    if rows > columns:
        return np.concatenate([np.matmul(left[..., part, :], right) for part in parts], axis=-2)
    return np.concatenate([np.matmul(left, right[..., part]) for part in parts], axis=-1)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Statistics of verdicts, and their format."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Sequence

import numpy as np

from vehicle_pf_tracker.core.array import Array


def median_and_range(values: Sequence[float], decimals: int = 1) -> str:
    """Format the median, and the least and the largest in brackets."""
    middle = statistics.median(values)
    least, largest = min(values), max(values)
    return f"{middle:.{decimals}f} ({least:.{decimals}f} to {largest:.{decimals}f})"


def mean_and_spread(values: Sequence[float], decimals: int = 1) -> str:
    """Format the mean and the standard deviation."""
    return f"{statistics.fmean(values):.{decimals}f} ± {spread(values):.{decimals}f}"


def spread(values: Sequence[float]) -> float:
    """Return the sample's standard deviation; 0 for a single value."""
    return statistics.stdev(values) if len(values) > 1 else 0.0


def seed_means(series: Iterable[Sequence[float]]) -> list[float]:
    """Return for each seed the mean over series that have a value of every seed."""
    return [statistics.fmean(values) for values in zip(*series, strict=True)]


def counted(hits: Sequence[bool]) -> str:
    """Format the number of hits of all."""
    return f"{sum(hits)} of {len(hits)}"


def share(hits: Sequence[bool]) -> float:
    """Return the share that is true; 0 of nothing."""
    return sum(hits) / len(hits) if hits else 0.0


def rank_correlation(xs: Sequence[float], ys: Sequence[float]) -> float:
    """Return Spearman's coefficient, equal values sharing their mean rank; 0 for a constant."""
    ranks = [_ranks(np.asarray(values, float)) for values in (xs, ys)]
    if any(np.ptp(rank) == 0 for rank in ranks):
        return 0.0
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])


def _ranks(values: Array) -> Array:
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    means: Array = (ends - (counts - 1) / 2)[place]
    return means

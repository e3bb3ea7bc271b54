# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Statistics of a metric: its mean, spread and interval over runs or recordings."""

from __future__ import annotations

import inspect
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

CONFIDENCE = 0.95
"""Confidence of the intervals, the usual one."""
RESAMPLES = 9999
"""Samples of the bootstrap, SciPy's own number: the interval's ends are right to a hundredth of its
width, and take milliseconds."""
_GENERATOR = "rng" if "rng" in inspect.signature(stats.bootstrap).parameters else "random_state"
"""Name of SciPy's argument: it changed in 1.15."""


@dataclass(frozen=True, slots=True)
class Summary:
    """Mean and spread of independent values.

    Attributes
    ----------
    count, mean : int, float
        Number of values, and their mean.
    spread : float or None
        Sample standard deviation; None for a single value.
    low, high : float or None
        Percentile bootstrap interval of the mean, of confidence `CONFIDENCE`; None for a single
        value. Of five values or fewer it is too narrow, and shows the scale only.
    """

    count: int
    mean: float
    spread: float | None
    low: float | None
    high: float | None


def summarise(values: Sequence[float]) -> Summary | None:
    """Summarise values; None if there are none.

    The same values give the same interval.
    """
    if not values:
        return None
    mean = statistics.fmean(values)
    if len(values) == 1:
        return Summary(1, mean, None, None, None)
    low, high = _interval(values)
    return Summary(len(values), mean, statistics.stdev(values), low, high)


def _interval(values: Sequence[float]) -> tuple[float, float]:
    # Every sample of equal values has their mean: there is nothing to draw.
    if min(values) == max(values):
        return values[0], values[0]
    # A fixed seed: a report that is written again has the same bytes.
    result = stats.bootstrap(
        (np.asarray(values),),
        np.mean,
        n_resamples=RESAMPLES,
        confidence_level=CONFIDENCE,
        method="percentile",
        **{_GENERATOR: np.random.default_rng(0)},
    )
    return float(result.confidence_interval.low), float(result.confidence_interval.high)


def mean_of_means(runs: Mapping[str, Sequence[float | None]]) -> float | None:
    """Return the mean over recordings of the mean over their runs; None if a run has no value."""
    means = []
    # Recordings weigh alike, however many runs each has.
    for values in runs.values():
        known = [value for value in values if value is not None]
        # A run without a value has failed: the mean of the others would reward that.
        if len(known) < len(values) or not known:
            return None
        means.append(statistics.fmean(known))
    return statistics.fmean(means) if means else None

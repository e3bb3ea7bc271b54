# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Statistics of a metric: intervals of its mean, tests of pairs of systems, and ranks.

Every recording ranks the systems. Friedman's test decides whether their mean ranks differ at all,
and Nemenyi's critical difference which of them do: on few recordings with far more power than
pairwise tests have.

Source: Demsar 2006, "Statistical comparisons of classifiers over multiple data sets", section 3.2.
"""

from __future__ import annotations

import inspect
import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

ALPHA = 0.05
"""Level of the tests."""
FEWEST_RECORDINGS = 6
"""Fewest recordings that are tested: a clean sweep of 5 has p = 2 / 2^5, above `ALPHA`."""
CONFIDENCE = 0.95
RESAMPLES = 9999
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


def summarise(values: Sequence[float | None]) -> Summary | None:
    """Summarise the values that are not None; None if there are none.

    The same values give the same interval.
    """
    known = [float(value) for value in values if value is not None]
    if not known:
        return None
    mean = statistics.fmean(known)
    if len(known) == 1:
        return Summary(1, mean, None, None, None)
    low, high = _interval(known)
    return Summary(len(known), mean, statistics.stdev(known), low, high)


def _interval(values: Sequence[float]) -> tuple[float, float]:
    if min(values) == max(values):
        return values[0], values[0]
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
    for values in runs.values():
        known = [value for value in values if value is not None]
        if len(known) < len(values) or not known:
            return None
        means.append(statistics.fmean(known))
    return statistics.fmean(means) if means else None


@dataclass(frozen=True, slots=True)
class Rank:
    """The rank of one system.

    Attributes
    ----------
    system : str
        Label of the system.
    mean_rank : float
        Mean of its ranks on the recordings; 1 is best, ties share theirs.
    place : int
        Place: 1 plus the number of significantly better systems.
    tied : tuple of str
        Systems that do not differ from it significantly.
    """

    system: str
    mean_rank: float
    place: int
    tied: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ranking:
    """Ranking of all systems, the least mean rank first.

    Attributes
    ----------
    ranks : tuple of Rank
        Rank of each system.
    recordings : int
        Number of recordings they were ranked on.
    friedman_p : float or None
        The p value of Friedman's test; None of fewer than three systems, or of too few recordings.
    critical_difference : float or None
        Mean ranks further apart than this differ significantly; None where nothing can.
    """

    ranks: tuple[Rank, ...]
    recordings: int
    friedman_p: float | None
    critical_difference: float | None


def rank_systems(
    values: Mapping[str, Mapping[str, float]], *, higher_is_better: bool
) -> Ranking | None:
    """Rank systems by their value on each recording.

    A system without a value on a recording is last there. Recordings and systems without any value
    are left out; None if nothing is left.

    Parameters
    ----------
    values : mapping of str to mapping of str to float
        Values by system and recording, means over the seeds: runs on one recording share its
        difficulties, and only recordings count as independent.
    higher_is_better : bool
        True if large values are best.
    """
    systems = [system for system, by_recording in values.items() if by_recording]
    recordings = sorted({name for system in systems for name in values[system]})
    if not systems:
        return None
    sign = -1.0 if higher_is_better else 1.0
    table = [[sign * values[s].get(name, sign * math.inf) for s in systems] for name in recordings]
    ranks = stats.rankdata(np.array(table), axis=1)
    friedman_p = _friedman(ranks)
    limit = _critical_difference(*ranks.shape)
    differ = limit is not None and (friedman_p is None or friedman_p < ALPHA)
    means = dict(zip(systems, map(float, ranks.mean(axis=0)), strict=True))
    rows = [_rank(system, means, limit if differ else None) for system in systems]
    ordered = tuple(sorted(rows, key=lambda row: row.mean_rank))
    return Ranking(ordered, len(recordings), friedman_p, limit)


def _rank(system: str, means: Mapping[str, float], limit: float | None) -> Rank:
    own = means[system]
    reach = math.inf if limit is None else limit
    better = sum(own - mean > reach for mean in means.values())
    tied = tuple(s for s, mean in means.items() if s != system and abs(mean - own) <= reach)
    return Rank(system, own, 1 + better, tied)


def _friedman(ranks: NDArray[np.float64]) -> float | None:
    recordings, systems = ranks.shape
    if systems < 3 or recordings < FEWEST_RECORDINGS:
        return None
    if not np.ptp(ranks, axis=1).any():  # all systems are equal on every recording
        return 1.0
    return float(stats.friedmanchisquare(*ranks.T).pvalue)


def _critical_difference(recordings: int, systems: int) -> float | None:
    """Return Nemenyi's critical difference of mean ranks (Demsar 2006, section 3.2.2)."""
    if systems < 2 or recordings < FEWEST_RECORDINGS:
        return None
    quantile = float(stats.studentized_range.ppf(1 - ALPHA, systems, np.inf)) / math.sqrt(2)
    return quantile * math.sqrt(systems * (systems + 1) / (6 * recordings))

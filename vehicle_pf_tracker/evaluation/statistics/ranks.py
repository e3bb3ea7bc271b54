"""Ranks over recordings, with systems that cannot be told apart shown as ties.

Every recording ranks the systems; Friedman's test says whether their mean ranks differ at all, and
Nemenyi's critical difference which of them do. It corrects for the number of pairs with far more
power than pairwise tests have on few recordings. Source: Demsar 2006, "Statistical comparisons of
classifiers over multiple data sets", section 3.2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from vehicle_pf_tracker.evaluation.statistics.paired import ALPHA, FEWEST_RECORDINGS


@dataclass(frozen=True, slots=True)
class Rank:
    """The rank of one system.

    Attributes
    ----------
    system : str
        Its name.
    mean_rank : float
        Mean over the recordings of its rank there; 1 is best, ties share theirs.
    place : int
        1 and the number of systems that are significantly better.
    tied : tuple of str
        Systems that cannot be told apart from it.
    """

    system: str
    mean_rank: float
    place: int
    tied: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Ranking:
    """All systems, the least mean rank first.

    Attributes
    ----------
    ranks : tuple of Rank
        One for each system.
    recordings : int
        How many they were ranked on.
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
        Values by system and recording, see `recording_means`.
    higher_is_better : bool
        Which end is best.
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
    if not np.ptp(ranks, axis=1).any():  # no recording tells any two apart
        return 1.0
    return float(stats.friedmanchisquare(*ranks.T).pvalue)


def _critical_difference(recordings: int, systems: int) -> float | None:
    """Return Nemenyi's critical difference of mean ranks (Demsar 2006, section 3.2.2)."""
    if systems < 2 or recordings < FEWEST_RECORDINGS:
        return None
    quantile = float(stats.studentized_range.ppf(1 - ALPHA, systems, np.inf)) / math.sqrt(2)
    return quantile * math.sqrt(systems * (systems + 1) / (6 * recordings))

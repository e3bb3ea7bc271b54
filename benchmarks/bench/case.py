# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One measured ratio, and the file that all of them go to."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """Times of ours and a baseline for the same work in one run.

    Attributes
    ----------
    name : str
        Words from the general to the special, divided by slashes.
    ours_ms, baseline_ms : float
        Medians over the rounds, in ms of CPU time.
    ratio : float
        ``baseline_ms / ours_ms``: above 1 ours is the cheaper one.
    spread : float
        Interquartile range of the ratio over the rounds.
    """

    name: str
    ours_ms: float
    baseline_ms: float
    ratio: float
    spread: float

    @classmethod
    def of(cls, name: str, ours: Sequence[float], baseline: Sequence[float]) -> Case:
        """Sum up the rounds: in each, one time of ours and one of the baseline, in seconds."""
        ours_ms, baseline_ms = (statistics.median(times) * 1e3 for times in (ours, baseline))
        # Round by round for the spread: what slows a round down slows both of its times.
        ratios = [theirs / own for own, theirs in zip(ours, baseline, strict=True)]
        return cls(name, ours_ms, baseline_ms, baseline_ms / ours_ms, interquartile_range(ratios))


def interquartile_range(values: Sequence[float]) -> float:
    """Distance of the quartiles; 0 for a single value."""
    if len(values) < 2:
        return 0.0
    # Inclusive, as the rounds are all there are, and no sample of more.
    low, _, high = statistics.quantiles(values, n=4, method="inclusive")
    return high - low

"""Which systems differ: paired tests on the same recordings and seeds.

Seeds of one recording are no independent samples of what trackers meet: their differences are
averaged first, and each recording is one sample (Demsar 2006, section 3.1.3). All pairs are tested
at once, so that their p values are adjusted by Holm's step-down method.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from vehicle_pf_tracker.evaluation.statistics.intervals import Summary, summarise
from vehicle_pf_tracker.evaluation.statistics.runs import Runs, paired_differences

ALPHA = 0.05
FEWEST_RECORDINGS = 6
"""Of fewer differences even a clean sweep has a p value above `ALPHA`: 2 / 2^5 > 0.05."""


@dataclass(frozen=True, slots=True)
class PairedTest:
    """One system held against another.

    Attributes
    ----------
    first, second : str
        The systems.
    difference : Summary or None
        Of first minus second, over the recordings that both have runs on.
    p_value, adjusted_p : float or None
        Of the two-sided Wilcoxon signed-rank test, alone and among all pairs; None where fewer
        than `FEWEST_RECORDINGS` recordings show a difference.
    """

    first: str
    second: str
    difference: Summary | None
    p_value: float | None
    adjusted_p: float | None = None

    @property
    def significant(self) -> bool:
        """Whether the two differ at the level `ALPHA` among all pairs."""
        return self.adjusted_p is not None and self.adjusted_p < ALPHA


def compare_pairs(runs: Runs) -> list[PairedTest]:
    """Test every pair of systems, in their order."""
    tests = [_test(runs, first, second) for first, second in itertools.combinations(runs, 2)]
    tested = [test.p_value for test in tests if test.p_value is not None]
    adjusted = iter(holm(tested))
    return [
        test if test.p_value is None else replace(test, adjusted_p=next(adjusted)) for test in tests
    ]


def holm(p_values: Sequence[float]) -> list[float]:
    """Adjust p values for their number (Holm 1979), in their order."""
    if not p_values:
        return []
    values = np.asarray(p_values, dtype=np.float64)
    order = np.argsort(values, kind="stable")
    steps = values[order] * np.arange(len(values), 0, -1)
    adjusted = np.empty_like(values)
    adjusted[order] = np.minimum(np.maximum.accumulate(steps), 1.0)
    return [float(value) for value in adjusted]


def smallest_adjusted_p(recordings: int, pairs: int) -> float:
    """Return the least adjusted p value that can come of so many recordings and pairs."""
    return min(1.0, float(pairs) * 2.0 ** (1 - recordings))


def _test(runs: Runs, first: str, second: str) -> PairedTest:
    differences = list(paired_differences(runs[first], runs[second]).values())
    changed = [difference for difference in differences if difference]
    p_value = None
    if len(changed) >= FEWEST_RECORDINGS:
        p_value = float(stats.wilcoxon(changed).pvalue)
    return PairedTest(first, second, summarise(differences), p_value)

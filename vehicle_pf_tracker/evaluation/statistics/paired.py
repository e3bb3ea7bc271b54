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

"""The value of one metric in every run of every system."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

import numpy as np
from scipy import stats

from vehicle_pf_tracker.evaluation.statistics.intervals import Summary, summarise


class RunKey(NamedTuple):
    """Identity of a system's run."""

    recording: str
    seed: int


Runs: TypeAlias = Mapping[str, Mapping[RunKey, float]]
"""Values by system and run; runs without a value are missing."""


def recording_means(runs: Mapping[RunKey, float]) -> dict[str, float]:
    """Return the mean over the seeds, by recording.

    Runs on one recording share its difficulties, so that only recordings count as independent.
    """
    by_recording: dict[str, list[float]] = {}
    for key, value in runs.items():
        by_recording.setdefault(key.recording, []).append(value)
    return {recording: statistics.fmean(values) for recording, values in by_recording.items()}


def paired_differences(
    first: Mapping[RunKey, float], second: Mapping[RunKey, float]
) -> dict[str, float]:
    """Return the mean of first minus second over the seeds that both have, by recording.

    A deterministic system, with one run on a recording, is compared with all runs of the other.
    """
    differences = {}
    for recording in dict.fromkeys(key.recording for key in first):
        one, other = _on(first, recording), _on(second, recording)
        if min(len(one), len(other)) > 1:
            common = one.keys() & other.keys()
            one, other = ({seed: runs[seed] for seed in common} for runs in (one, other))
        if one and other:
            differences[recording] = statistics.fmean(one.values()) - statistics.fmean(
                other.values()
            )
    return differences


def _on(runs: Mapping[RunKey, float], recording: str) -> dict[int, float]:
    return {key.seed: value for key, value in runs.items() if key.recording == recording}


ALPHA = 0.05
FEWEST_RECORDINGS = 6
"""Fewest differences that are tested: a clean sweep of 5 has p = 2 / 2^5, above `ALPHA`."""


@dataclass(frozen=True, slots=True)
class PairedTest:
    """Comparison of two systems.

    Attributes
    ----------
    first, second : str
        Labels of the systems.
    difference : Summary or None
        Difference of first minus second, over the recordings that both have runs on.
    p_value, adjusted_p : float or None
        Two-sided Wilcoxon signed-rank test, alone and among all pairs; None where fewer
        than `FEWEST_RECORDINGS` recordings show a difference.
    """

    first: str
    second: str
    difference: Summary | None
    p_value: float | None
    adjusted_p: float | None = None

    @property
    def significant(self) -> bool:
        """True if the two differ at the level `ALPHA` among all pairs."""
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

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

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.evaluation.statistics import (
    RunKey,
    compare_pairs,
    holm,
    paired_differences,
    smallest_adjusted_p,
)


def runs_of(*by_recording):
    """Values of one system: a sequence of seeds' values for each recording."""
    return {
        RunKey(f"r{i}", seed): float(value)
        for i, values in enumerate(by_recording)
        for seed, value in enumerate(values)
    }


def test_differences_are_taken_between_the_same_seeds():
    first, second = runs_of([5, 8, 90], [1]), runs_of([1, 2], [1], [7])
    assert paired_differences(first, second) == {"r0": 5, "r1": 0}


def test_a_single_run_stands_against_all_seeds_of_the_other():
    single, several = runs_of([5], [1]), runs_of([1, 2, 6], [1])
    assert paired_differences(single, several) == {"r0": 2, "r1": 0}
    assert paired_differences(several, single) == {"r0": -2, "r1": 0}


def test_seeds_that_only_one_has_are_left_out():
    first = {RunKey("r", 0): 4.0, RunKey("r", 1): 8.0}
    second = {RunKey("r", 1): 1.0, RunKey("r", 2): 50.0}
    assert paired_differences(first, second) == {"r": 7}
    assert paired_differences(first, {RunKey("r", 2): 1.0, RunKey("r", 3): 1.0}) == {}


def test_holm_by_hand():
    assert holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert holm([0.5, 0.6]) == [1, 1]
    assert holm([]) == []


@given(st.lists(st.floats(0, 1), min_size=1, max_size=9))
def test_holm_lies_between_no_correction_and_bonferronis(p_values):
    adjusted = holm(p_values)
    for p, a in zip(p_values, adjusted, strict=True):
        assert p <= a <= min(1, len(p_values) * p) + 1e-12
    assert [a for _, a in sorted(zip(p_values, adjusted, strict=True))] == sorted(adjusted)


def test_a_clean_sweep_by_hand():
    # Better on all six recordings: two of 2^6 sign patterns are as extreme.
    better, worse = runs_of(*([i] for i in range(6))), runs_of(*([2 * i + 1] for i in range(6)))
    (test,) = compare_pairs({"a": better, "b": worse})
    assert (test.first, test.second) == ("a", "b")
    assert test.difference.mean == pytest.approx(-3.5)
    assert test.p_value == test.adjusted_p == pytest.approx(2 / 64)
    assert test.significant
    assert test.p_value == smallest_adjusted_p(6, 1)


def test_many_seeds_on_few_recordings_are_few_samples():
    first, second = runs_of(*[range(50)] * 5), runs_of(*[range(1, 51)] * 5)
    (test,) = compare_pairs({"a": first, "b": second})
    assert (test.difference.count, test.difference.mean) == (5, -1)
    assert test.p_value is test.adjusted_p is None
    assert not test.significant


def test_pairs_are_adjusted_for_their_number():
    rng = np.random.default_rng(2)
    base = rng.normal(size=10)
    runs = {
        name: runs_of(*([v] for v in base + shift))
        for name, shift in {"a": 0.0, "b": rng.normal(0.5, 1, 10), "c": 9.0}.items()
    }
    tests = compare_pairs(runs)
    assert [(t.first, t.second) for t in tests] == [("a", "b"), ("a", "c"), ("b", "c")]
    assert [t.adjusted_p for t in tests] == holm([t.p_value for t in tests])
    assert smallest_adjusted_p(10, 3) == 3 * 2 / 1024

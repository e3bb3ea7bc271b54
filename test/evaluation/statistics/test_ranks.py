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

from vehicle_pf_tracker.evaluation.statistics import rank_systems


def table(**systems):
    return {
        name: {f"r{i}": float(v) for i, v in enumerate(values) if v is not None}
        for name, values in systems.items()
    }


def ranked(values, **options):
    ranking = rank_systems(values, **{"higher_is_better": False, **options})
    return ranking, {rank.system: rank for rank in ranking.ranks}


def test_mean_ranks_by_hand():
    ranking, by_system = ranked(table(a=[1, 2, 5], b=[2, 1, 5], c=[3, 9, 1]))
    assert ranking.recordings == 3
    assert by_system["a"].mean_rank == pytest.approx((1 + 2 + 2.5) / 3)
    assert by_system["c"].mean_rank == pytest.approx((3 + 3 + 1) / 3)
    assert [rank.system for rank in ranking.ranks] == ["a", "b", "c"]


def test_too_few_recordings_leave_everything_tied():
    ranking, by_system = ranked(table(a=[1] * 5, b=[2] * 5, c=[3] * 5))
    assert ranking.friedman_p is ranking.critical_difference is None
    assert [rank.place for rank in ranking.ranks] == [1, 1, 1]
    assert by_system["a"].tied == ("b", "c")


def test_the_critical_difference_agrees_with_demsars_table():
    # Demsar 2006, table 5a: q for four systems at 0.05 is 2.569.
    ranking, _ = ranked(table(a=[1] * 14, b=[2] * 14, c=[3] * 14, d=[4] * 14))
    assert ranking.critical_difference == pytest.approx(2.569 * np.sqrt(4 * 5 / (6 * 14)), abs=1e-3)


def test_places_count_those_that_are_significantly_better():
    # A critical difference of 1.25 ranks: neighbours are tied, the ends are not.
    ranking, by_system = ranked(table(a=[1] * 14, b=[2] * 14, c=[3] * 14, d=[4] * 14))
    assert ranking.friedman_p < 1e-6
    assert [rank.place for rank in ranking.ranks] == [1, 1, 2, 3]
    assert by_system["b"].tied == ("a", "c")
    assert by_system["d"].tied == ("c",)


def test_without_friedmans_consent_nothing_differs():
    rng = np.random.default_rng(1)
    ranking, _ = ranked(table(**{name: rng.normal(size=9) for name in "abcde"}))
    assert ranking.friedman_p > 0.05
    assert {rank.place for rank in ranking.ranks} == {1}


def test_equal_systems_are_tied():
    ranking, _ = ranked(table(a=[1] * 9, b=[1] * 9, c=[1] * 9))
    assert ranking.friedman_p == 1
    assert {(rank.mean_rank, rank.place) for rank in ranking.ranks} == {(2, 1)}


def test_a_system_is_last_where_it_has_no_value():
    for higher in (False, True):
        _, by_system = ranked(table(a=[5, None], b=[6, 6], c=[7, 7]), higher_is_better=higher)
        assert by_system["a"].mean_rank == (2 if not higher else 3)


def test_what_has_no_value_at_all_is_left_out():
    ranking, by_system = ranked(table(a=[1, None], b=[]))
    assert (list(by_system), ranking.recordings) == (["a"], 1)
    assert rank_systems({"a": {}}, higher_is_better=True) is None


def test_two_systems_need_no_friedman():
    ranking, _ = ranked(table(a=[1] * 9, b=[2] * 9))
    assert ranking.friedman_p is None
    assert [rank.place for rank in ranking.ranks] == [1, 2]

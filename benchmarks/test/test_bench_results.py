# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""How rounds become a ratio, and what the file holds."""

import itertools
import json

import pytest
from bench_samples import results

from benchmarks.bench import interleaving
from benchmarks.bench.case import Case, interquartile_range
from benchmarks.bench.interleaving import compare
from benchmarks.bench.results import Results


def test_a_case_has_medians_their_ratio_and_its_interquartile_range():
    ours = [0.001, 0.001, 0.001, 0.002, 0.001]
    baseline = [0.004, 0.006, 0.008, 0.010, 0.010]
    case = Case.of("a/b", ours, baseline)
    assert case == Case("a/b", pytest.approx(1.0), pytest.approx(8.0), 8.0, pytest.approx(3.0))
    # ratios 4, 6, 8, 5, 10: quartiles 5 and 8


@pytest.mark.parametrize(("values", "expected"), [([3.0], 0.0), ([1, 2, 3, 4, 5], 2.0)])
def test_interquartile_range(values, expected):
    assert interquartile_range(values) == expected


def test_the_file_has_what_was_agreed_and_is_read_back(tmp_path):
    path = tmp_path / "new" / "bench.json"
    results().save(path)
    content = json.loads(path.read_text())
    assert {"environment", "commands", "cases"} <= content.keys()
    for case in content["cases"]:
        assert list(case) == ["name", "ours_ms", "baseline_ms", "ratio", "spread"]
    assert Results.load(path) == results()


def test_both_works_take_turns_and_both_are_asked_first_equally_often(monkeypatch):
    monkeypatch.setattr(interleaving, "_CALLS_FOR", 0.0)  # one call a round
    order = []

    def work(name):
        def do(number):
            order.append(name)

        return do

    case = compare("x", work("ours"), work("baseline"), seconds=0.0)
    rounds = order[-18:]
    pairs = [tuple(rounds[index : index + 2]) for index in range(0, 18, 2)]
    assert set(pairs) == {("ours", "baseline"), ("baseline", "ours")}
    assert all(one != other for one, other in itertools.pairwise(pairs))
    assert 0.2 < case.ratio < 5

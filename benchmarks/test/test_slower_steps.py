# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Steps are compared with the last page's figures by ratios, not by times."""

from dataclasses import replace

import pytest
from bench_samples import results

from benchmarks.bench.performance_page import page
from benchmarks.bench.slower_steps import last_ratios, slower_steps


def rerun(machine=1.0, **slower):
    """Results on a machine this many times as slow, with a baseline's ratios divided."""
    found = results()
    found.cases = [
        replace(
            case,
            ours_ms=case.ours_ms * machine * slower.get(case.name.split("/")[2], 1.0),
            baseline_ms=case.baseline_ms * machine,
            ratio=case.ratio / slower.get(case.name.split("/")[2], 1.0),
        )
        if case.name.startswith("step/")
        else case
        for case in found.cases
    ]
    return found


def test_the_page_gives_back_its_ratios():
    assert last_ratios(page(results())) == {"step/apf/csrt": 50.0, "step/apf/kcf": 3.0}


@pytest.mark.parametrize("last", ["", "# Performance\n"])
def test_without_figures_there_is_nothing_to_compare_with(last):
    assert slower_steps(rerun(csrt=2.0, kcf=2.0), last) == {}


@pytest.mark.parametrize("machine", [0.3, 1.0, 5.0])
def test_a_slower_machine_is_no_slower_step(machine):
    assert slower_steps(rerun(machine, csrt=1.09, kcf=1.09), page(results())) == {}


@pytest.mark.parametrize("machine", [0.3, 1.0, 5.0])
def test_a_step_slower_by_more_than_a_tenth_is_named(machine):
    slower = slower_steps(rerun(machine, csrt=1.2, kcf=1.3), page(results()))
    assert slower == {"apf": pytest.approx(1.25)}


def test_what_this_run_did_not_measure_is_not_compared():
    found = rerun(csrt=2.0, kcf=2.0)
    found.cases = [case for case in found.cases if not case.name.startswith("step/")]
    assert slower_steps(found, page(results())) == {}

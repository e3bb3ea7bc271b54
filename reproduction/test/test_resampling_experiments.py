# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The third paper's experiments: phases, counts, and what is judged from made-up results."""

import pytest

from reproduction.catalogue import EXPERIMENTS
from reproduction.experiment import Holds, Size
from reproduction.resampling import systems as resampling

SIZE = Size(range(100, 102), quick=True)


def result(cell, error, passes, count):
    truths = cell.scene.truths()
    frames = len(truths)
    return {
        "metrics": {},
        "trace": {
            "x": [truth.box.centre[0] + error for truth in truths],
            "y": [truth.box.centre[1] for truth in truths],
            "width": [40.0] * frames,
            "height": [24.0] * frames,
            "mode": ["tracking"] * frames,
            "regime": ["regular"] * frames,
            "n_eff": [150.0] * frames,
            "resampling_passes": [0] + [passes] * (frames - 1),
            "resampled_particles": [0] + [count] * (frames - 1),
        },
    }


@pytest.fixture(scope="module")
def results():
    """Let conventional be 30 px off with 20 passes of 200, adaptive 4 px with one of 50."""
    return {
        cell: result(cell, 30.0, 20, 4000)
        if cell.system.variant == "conventional"
        else result(cell, 4.0, 1, 50)
        for cell in resampling.cells(SIZE)
    }


def findings(report, claim):
    return {f.interpretation: f for f in report.verdict.claims[claim].findings}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["the paper's rule", "the paper's rule, hidden wholly"])
def test_phases_follow_each_other_and_leave_nothing_out(results, name):
    view = resampling.VIEWS[name]
    scored = resampling.run_scores(results, view, view.adaptive, 100)
    found = resampling.phases(scored)
    assert list(found) == ["before", "partial", "full", "after"]
    # The first frame is where the filters are started.
    assert sorted(index for of in found.values() for index in of) == list(
        range(1, len(scored.frames))
    )
    assert max(found["before"]) < min(found["partial"]) < min(found["full"])
    assert max(found["full"]) < min(found["after"])
    assert resampling.rms(scored, found["full"]) == pytest.approx(4.0)


@pytest.mark.parametrize("seed", range(4))
def test_the_paper_s_timing_leaves_a_remnant(seed):
    truths = resampling.SCENE.seeded(seed).truths()
    visible = [truth.visible_fraction for truth in truths]
    assert min(visible[:10]) == 1.0
    assert 0.1 < min(visible) < 0.25
    hidden = [n for n, share in enumerate(visible, start=1) if share < resampling.REMNANT_BELOW]
    assert hidden in ([16, 17, 18], [16, 17, 18, 19])
    assert min(visible[26:]) == 1.0


@pytest.mark.slow
def test_figure_4_sees_who_is_lost(results):
    report = EXPERIMENTS["resampling-fig4"].report(results, SIZE)
    interpretations = list(findings(report, 0))
    assert interpretations[:3] == ["the paper's rule", "our interpretation", "as printed"]
    assert interpretations[-3:] == [f"{name}, hidden wholly" for name in interpretations[:3]]
    assert (
        findings(report, 0)["the paper's rule"].holds is Holds.PARTLY
    )  # conventional is 30 px off
    assert findings(report, 2)["the paper's rule"].holds is Holds.YES
    after = findings(report, 3)["the paper's rule"]
    assert after.holds is Holds.YES
    assert "in 2 of 2 runs of adaptive and 0 of conventional" in after.numbers
    assert findings(report, 4)["the paper's rule"].numbers.endswith("0.13 times")


@pytest.mark.slow
def test_figure_5_counts_particles(results):
    report = EXPERIMENTS["resampling-fig5"].report(results, SIZE)
    assert findings(report, 0)["the paper's rule"].holds is Holds.YES
    assert findings(report, 3)["the paper's rule"].holds is Holds.NO  # as many in each frame
    saving = findings(report, 4)["the paper's rule"]
    assert saving.holds is Holds.YES
    assert "0.013 (0.013 to 0.013) times" in saving.numbers
    (table,) = report.tables.values()
    assert table.rows[0][1:] == ("20.0 / 4000",) * 4


@pytest.mark.slow
def test_frames_are_judged_in_the_middle_of_each_phase(results):
    report = EXPERIMENTS["resampling-frames"].report(results, SIZE)
    assert findings(report, 0)["the paper's rule"].holds is Holds.YES
    assert findings(report, 1)["the paper's rule"].numbers.endswith(
        "before 0, partial 0, full 0, after 0"
    )


def test_cost_compares_mean_times():
    experiment = EXPERIMENTS["resampling-cost"]
    (cell,) = experiment.cells(SIZE)
    assert cell.alone
    times = {s.label: [2.0 if s.variant == "conventional" else 1.0] * 3 for s in cell.systems}
    report = experiment.report({cell: {"step_ms": times}}, SIZE)
    (table,) = report.tables.values()
    assert table.rows[0][3] == "0.50 (0.50 to 0.50)"
    assert report.verdict.holds is Holds.YES


def test_both_filters_differ_in_nothing_but_how_they_resample():
    for view in resampling.VIEWS.values():
        conventional, adaptive = (system.parameters(7) for system in view.pair)
        shared = ("num_particles", "sigma", "criterion", "most_passes", "likelihood", "resampling")
        for name in shared:
            assert getattr(conventional, name) == getattr(adaptive, name)
        assert conventional.most_passes == 20

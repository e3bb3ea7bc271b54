# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every experiment in its smallest size: it runs, draws and judges."""

import math

import pytest

from laboratory.result_store import ResultStore
from reproduction.apf import systems as apf_systems
from reproduction.catalogue import EXPERIMENTS, find_experiments
from reproduction.experiment import Holds, Size
from reproduction.pages.output import write_report
from reproduction.runs.cells import SceneChoice
from reproduction.runs.running import complete
from reproduction.scenes.paper_scenes import VIDEO_SCENES
from vehicle_pf_tracker.core.errors import InputError

SIZE = Size(range(100, 101), quick=True)


@pytest.fixture(scope="module")
def reports(tmp_path_factory):
    """Make each report once; what they share is run once too."""
    store = ResultStore(tmp_path_factory.mktemp("reports") / "cells.jsonl")
    made = {}

    def report(name):
        if name not in made:
            experiment = EXPERIMENTS[name]
            results = complete(experiment.cells(SIZE), store, 1, lambda done, total: None)
            made[name] = experiment.report(results, SIZE)
        return made[name]

    return report


def test_figures_are_the_same_every_time(tmp_path):
    experiment = EXPERIMENTS["apf-fig2"]
    for name in ("once", "again"):
        write_report(tmp_path / name, experiment, experiment.report({}, SIZE), SIZE)
    for file in ("figure.svg", "figure.png", "verdict.md"):
        assert (tmp_path / "once" / file).read_bytes() == (tmp_path / "again" / file).read_bytes()


def findings(report, claim):
    return {f.interpretation: f for f in report.verdict.claims[claim].findings}


def test_figure_3_judges_every_reading(reports):
    tracked = findings(reports("apf-fig3"), 0)
    assert list(tracked) == ["the paper's rule", "our interpretation", "as printed"]
    assert tracked["the paper's rule"].holds is Holds.YES
    assert tracked["as printed"].holds is Holds.NO
    assert tracked["the paper's rule"].numbers.startswith("4 of 4 runs")


def test_figure_2_has_a_bar_that_hides_all_of_the_vehicle(reports):
    occlusions = [row[3] for row in reports("apf-fig2").data.rows]
    assert {"none", "partial", "total"} == set(occlusions)


def test_figure_6_and_7_have_every_frame_of_every_tracker(reports):
    data = reports("apf-fig6").data
    frames = len(SceneChoice.of("video03").seeded(100).truths())
    assert len(data.rows) == 8 * frames
    assert {row[0] for row in data.rows} >= {"APF", "PF", "SAPF", "HPFMS", "PFCL", "MS"}
    errors = [math.dist(row[3:5], row[7:9]) for row in data.rows]
    assert errors == pytest.approx([row[6] for row in data.rows])
    assert reports("apf-fig7").data == data


def test_timing_gives_ratios_to_apf(reports):
    (table,) = reports("apf-timing").tables.values()
    assert table.rows[0][2] == "1.00 (1.00 to 1.00)"
    assert [row[4] for row in table.rows] == ["1.00", "1.01", "1.02", "1.05", "1.02", "0.88"]


def test_table_2_has_an_average_row_and_the_total_occlusions_apart():
    experiment = EXPERIMENTS["apf-table2"]
    results = {
        cell: {
            "metrics": {
                "rmse_px": {"apf": 10.0}.get(cell.system.variant, 40.0) * (1 + cell.seed - 100),
                "rmse_visible_px": 1.0,
                "on_target": 1.0,
                "occlusions": [{"recovered": cell.system.variant == "apf"}],
            }
        }
        for cell in experiment.cells(Size(range(100, 102), quick=True))
    }
    report = experiment.report(results, Size(range(100, 102), quick=True))
    table = next(iter(report.tables.values()))
    rows = {row[0]: dict(zip(table.columns, row, strict=True)) for row in table.rows}
    # The paper's in brackets: videos 6, 15 and 19, and 6 alone.
    assert rows["**average**"]["APF"] == "15.0 ± 7.1 (17.01)"
    assert rows["**total occlusion**"]["PF"] == "60.0 ± 28.3 (132.53)"
    assert rows["video19"]["HPFMS"] == "60.0 ± 28.3 (3.67)"
    assert rows["rank correlation with the paper"]["MS"] == "0.00"  # ours are all alike
    ratios = list(report.tables.values())[1]
    assert ratios.rows[-1] == ("video19", "none", "0.25", "0.25", "1.12")
    assert {f.holds for f in report.verdict.claims[4].findings} == {Holds.NO}
    average = findings(report, 0)["the paper's rule"]
    assert average.holds is Holds.YES
    assert "0.25 times" in average.numbers
    assert report.verdict.claims[3].findings[0].holds is Holds.YES


def test_table_2_has_all_videos_all_trackers_and_a_fresh_scene_for_each_seed():
    cells = EXPERIMENTS["apf-table2"].cells(Size(range(3)))
    assert {cell.scene.name for cell in cells} == set(VIDEO_SCENES)
    assert len(cells) == 20 * 3 * 15
    assert all(cell.scene.seed == cell.seed for cell in cells)


def test_all_six_have_one_likelihood_and_the_others_are_beside_them():
    likelihoods = {
        system.parameters(0).likelihood
        for system in apf_systems.SIX_SYSTEMS
        if system.variant != "ms"
    }
    assert len(likelihoods) == 1
    windows = dict(apf_systems.LIBERTIES[0].settings)["num_particles"] * 4
    assert windows == apf_systems.SIX_SYSTEMS[0].parameters(0).num_particles == 200
    for one in apf_systems.COMPARISONS:
        assert [r.variant for r in one.rivals] == ["pf", "sapf", "hpfms", "pfcl", "ms"]


def test_a_system_with_a_sigma_of_its_own_keeps_it():
    own = apf_systems.LIBERTIES[2]
    assert apf_systems.with_sigma(own, 7.5) == own
    assert apf_systems.with_sigma(apf_systems.APF, 7.5).parameters(0).motion.sigma_w == 7.5


def test_table_1_of_the_paper_is_that_of_the_scenes():
    report = EXPERIMENTS["apf-table1"].report({}, SIZE)
    (table,) = report.tables.values()
    assert table.rows[11][:4] == ("video12", "car", "partial", "768x576")
    assert report.verdict.holds is Holds.YES
    assert report.verdict.claims[0].findings[0].numbers.startswith("20 of 20 scenes")


def test_resampling_draws_each_event_as_often_as_it_weighs():
    report = EXPERIMENTS["mfpf-fig2"].report({}, SIZE)
    assert {f.holds for f in report.verdict.claims[0].findings} == {Holds.YES}
    for scheme in ("multinomial", "residual", "systematic", "stratified"):
        rows = [row for row in report.data.rows if row[0] == scheme]
        assert sum(row[2] for row in rows) == pytest.approx(1.0)
        assert sum(row[3] for row in rows) == pytest.approx(1.0)


@pytest.mark.parametrize(("speed", "sigma"), [(2.0, 5.0), (5.0, 7.5), (15.0, 10.0)])
def test_one_rule_sets_sigma(speed, sigma):
    scene = SceneChoice.of("clear", {"speed": speed})
    for system in apf_systems.SIX_SYSTEMS:
        ruled = apf_systems.ruled(scene, system, 7).system
        assert apf_systems.sigma_of(ruled) == (None if system.variant == "ms" else sigma)
        parameters = ruled.parameters(7)
        if system.variant == "apf":
            assert parameters.motion.sigma_w == sigma
        elif system.variant != "ms":
            assert parameters.sigma == sigma
        assert parameters.seed == 7


def test_experiments_are_found_by_name():
    assert [e.name for e in find_experiments(["apf-fig4", "apf-fig1"])] == ["apf-fig1", "apf-fig4"]
    assert len(find_experiments(["all"])) == len(EXPERIMENTS)
    with pytest.raises(InputError, match=r"'apf-fig99'.*apf-fig1"):
        find_experiments(["apf-fig99"])

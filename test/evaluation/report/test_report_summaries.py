# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import csv
import io
import json
import statistics
from dataclasses import astuple

import pytest
from evaluation_samples import ALONE, HIDDEN, SEEDS, VARIANTS

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation.columns import METRIC_COLUMNS
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    EvaluationFolder,
    cell_folder,
    read_document,
)
from vehicle_pf_tracker.evaluation.report import writing
from vehicle_pf_tracker.evaluation.report.aggregates import aggregate
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.evaluation.statistics import summarise
from vehicle_pf_tracker.evaluation.tables import behind_table, overall_table, pairs_table
from vehicle_pf_tracker.results.output_files import write_json


@pytest.fixture(scope="module")
def evaluation(made_evaluation):
    return score_folder(EvaluationFolder(made_evaluation))


@pytest.fixture(scope="module")
def aggregates(evaluation):
    return aggregate(evaluation)


def stored(made_evaluation, recording, system, key):
    folders = (
        cell_folder(made_evaluation, recording, system, seed) for seed in ALONE.get(system, SEEDS)
    )
    return [read_document(folder / "metrics.json")[key] for folder in folders]


def test_runs_score_as_the_cells_did(evaluation, made_evaluation):
    for recording in HIDDEN:
        for system in VARIANTS:
            runs = evaluation.of(recording, system)
            for key in ("rmse_px", "success_auc", "occluded_recall", "failures"):
                values = [getattr(run.metrics, key) for run in runs]
                assert values == stored(made_evaluation, recording, system, key)


def test_means_are_taken_over_seeds_and_then_over_recordings(aggregates, made_evaluation):
    means = {}
    for recording in HIDDEN:
        values = stored(made_evaluation, recording, "pf", "rmse_px")
        found = aggregates.recordings[recording]["pf"]["rmse_px"]
        assert found.mean == pytest.approx(statistics.fmean(values))
        assert found.spread == pytest.approx(statistics.stdev(values))
        means[recording] = found.mean
    assert aggregates.overall["pf"]["rmse_px"].mean == pytest.approx(
        statistics.fmean(means.values())
    )


def test_the_best_comes_first_and_the_others_are_compared_with_it_by_recording(
    aggregates, made_evaluation
):
    assert set(aggregates.order) == set(VARIANTS)  # the baseline has no result
    means = [aggregates.overall[label]["success_auc"].mean for label in aggregates.order]
    assert means == sorted(means, reverse=True)
    first, *others = aggregates.order
    for label in others:
        pairs = [
            [statistics.fmean(stored(made_evaluation, name, one, "rmse_px")) for name in HIDDEN]
            for one in (label, first)
        ]
        expected = summarise([value - best for value, best in zip(*pairs, strict=True)])
        found = aggregates.behind[label]["rmse_px"]
        assert astuple(found) == pytest.approx(astuple(expected))
        mean, behind = behind_table(aggregates).rows[label][-2:]
        assert behind.text == f"{found.mean:+.1f} ({found.low:.1f} to {found.high:.1f})"
        own = aggregates.overall[label]["rmse_px"]
        assert mean.text == f"{own.mean:.1f} ({own.low:.1f} to {own.high:.1f})"


def test_every_system_is_compared_with_every_other(aggregates, made_evaluation):
    first, second, third = aggregates.order
    means = {
        one: [
            statistics.fmean(stored(made_evaluation, name, one, "success_auc")) for name in HIDDEN
        ]
        for one in aggregates.order
    }
    expected = summarise([a - b for a, b in zip(means[second], means[third], strict=True)])
    assert astuple(aggregates.pairs[second][third]) == pytest.approx(astuple(expected))
    table = pairs_table(aggregates)
    assert [header.text for header in table.headers] == [f"to {one}" for one in aggregates.order]
    cell = table.rows[second][2].text
    assert cell == f"{expected.mean:+.3f} ({expected.low:.3f} to {expected.high:.3f})"
    assert table.rows[second][1].text == ""
    assert aggregates.pairs[second][first] == aggregates.behind[second]["success_auc"]


def test_recoveries_are_counted_over_all_runs(aggregates, evaluation):
    judged = [r for run in evaluation.of(system="pf") for r in run.metrics.recovered]
    judged = [r for r in judged if r is not None]
    assert aggregates.recoveries["pf"] == (sum(judged), len(judged))
    assert len(judged) == len(SEEDS)  # one occlusion in one of the recordings
    cells = overall_table(aggregates).rows["pf"]
    assert f"{sum(judged)} of {len(judged)}" in [cell.text for cell in cells]


def test_csv_has_a_line_for_each_mean(evaluation, aggregates):
    rows = list(csv.DictReader(io.StringIO(writing.summary_csv(aggregates))))
    (one,) = [r for r in rows if (r["recording"], r["system"], r["metric"]) ==
              ("free", "pf", "rmse_px")]  # fmt: skip
    found = aggregates.recordings["free"]["pf"]["rmse_px"]
    assert float(one["mean"]) == found.mean
    assert (one["unit"], one["count"]) == ("px", str(len(SEEDS)))
    overall = [r for r in rows if r["recording"] == writing.ALL_RECORDINGS]
    assert {r["system"] for r in overall} == set(VARIANTS)
    assert {r["metric"] for r in overall} <= {column.key for column in METRIC_COLUMNS}


def test_results_of_different_versions_are_told(evaluation_copy, capsys):
    folder = cell_folder(evaluation_copy, "free", "pf", 1)
    run = read_document(folder / "run.json")
    write_json(folder / "run.json", {**run, "versions": {**run["versions"], "opencv": "0.9.0"}})
    assert main(["report", str(evaluation_copy)]) == 0
    said = f"different versions are compared: opencv 0.9.0 and {run['versions']['opencv']}; "
    assert capsys.readouterr().err.count(said) == 1
    assert said in (evaluation_copy / "report.html").read_text()


def test_json_is_json_and_has_everything(evaluation, aggregates):
    document = writing.summary_json(evaluation, aggregates)
    document = json.loads(json.dumps(document, allow_nan=False))
    assert document["overall"]["pf"]["rmse_px"]["count"] == len(HIDDEN)
    assert set(document["recordings"]) == set(HIDDEN)
    assert document["behind"][aggregates.order[1]]["rmse_px"]["count"] == len(HIDDEN)
    assert len(document["failed"]) == len(HIDDEN)
    assert not any("versions" in sentence for sentence in document["notes"])


def test_markdown_has_a_table_for_each_recording_and_every_failed_cell(evaluation, aggregates):
    text = writing.summary_markdown(evaluation, aggregates)
    assert text.startswith("# Trackers compared: evaluation\n")
    assert [line[3:] for line in text.splitlines() if line.startswith("## ")] == [
        "Means over recordings", "Differences to the first",
        "Differences of all pairs, success AUC", *HIDDEN, "Failed cells",
    ]  # fmt: skip
    tables = [line for line in text.splitlines() if line.startswith("| pf |")]
    assert len(tables) == 3 + len(HIDDEN)  # means, differences, all pairs
    assert text.count("| baseline:csrt |") == len(HIDDEN)


def test_latex_escapes_what_it_must_and_marks_the_best(aggregates):
    text = writing.summary_tex(aggregates)
    assert text.count(r"\\") == 1 + len(VARIANTS)
    assert r"\begin{tabular}{lrrrrr}" in text
    assert "_" not in text.replace(r"\_", "") and "–" not in text
    lines = {line.split(" & ")[0]: line for line in text.splitlines()}
    for label, cells in overall_table(aggregates, ["success_auc"]).rows.items():
        (best,) = [cell.best for cell in cells]
        assert (rf"& \textbf{{{cells[0].text}}} &" in lines[label]) == best

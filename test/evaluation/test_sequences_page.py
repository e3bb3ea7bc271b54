# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page of real sequences (`reproduction.sequences`), of an evaluation folder made for tests."""

import statistics

from reproduction.sequences import page
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder, read_document


def cells_of(text, heading, system):
    """The cells of a system's row in the table below a heading."""
    table = text[text.index(heading) :].split("\n\n")[1]
    (row,) = [line for line in table.splitlines() if line.startswith(f"| `{system}` |")]
    return [cell.strip() for cell in row.strip("|").split("|")][1:]


def test_means_over_seeds_and_then_sequences(made_evaluation):
    text = page(EvaluationFolder(made_evaluation))
    folders = ([made_evaluation / f"cells/{name}/pf/seed-{seed}" for seed in (0, 1)]
               for name in ("bridge", "free"))  # fmt: skip
    means = [
        statistics.fmean(read_document(f / "metrics.json")["rmse_visible_px"] for f in some)
        for some in folders
    ]
    cells = cells_of(text, "RMSE of the centre", "pf")
    assert [float(cell.split()[0]) for cell in cells[:2]] == [round(mean, 1) for mean in means]
    assert cells[2] == f"**{statistics.fmean(means):.1f}**"


def test_baselines_that_did_not_run_and_occlusions_that_are_judged(made_evaluation):
    text = page(EvaluationFolder(made_evaluation))
    assert cells_of(text, "RMSE of the centre", "baseline:csrt") == ["–", "–", "–"]
    assert "- free, baseline:csrt: the environment of the baselines is not there" in text
    (recovered,) = cells_of(text, "Total occlusions recovered from", "ms")  # of one sequence
    assert recovered.endswith(" of 1")

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from scoring_samples import NONE, TOTAL, row, run_of

from vehicle_pf_tracker.cli.console import print_rows
from vehicle_pf_tracker.cli.run import run_rows
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames


def rows_of(*stretches):
    return dict(run_rows(measure(run_of(*stretches))))


def test_metrics_of_a_run_with_an_occlusion():
    rows = rows_of((10, 1, NONE), (5, 30, TOTAL), (30, 200, NONE))
    assert rows["RMSE visible, px"] == "173.2"
    assert rows["on target"] == "0.250"
    assert rows["recovered"] == "0.00"
    found = rows_of((10, 1, NONE), (5, 1 / 3, TOTAL), (30, 2, NONE))
    assert found["recovered"] == "1.00"


def test_metrics_that_a_run_does_not_have_are_left_out():
    rows = rows_of((2, 1, NONE), (5, 1, TOTAL), (16, 1, NONE))
    assert "recovered" not in rows and "RMSE, px" in rows  # too few frames to judge
    rows = dict(run_rows(measure(score_frames([row(1, 5.0)], []))))
    assert "RMSE, px" not in rows and "step, ms" in rows


def test_on_a_terminal_brackets_are_no_styles(capsys):
    print_rows(["", "[bold]"], [["[red]label, px", "1.3"]])
    text = capsys.readouterr().out
    assert "[bold]" in text
    assert "[red]label, px" in text
    assert "1.3" in text

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

import csv
import io

from scoring_samples import NONE, TOTAL, row, run_of

from vehicle_pf_tracker.cli.console import show
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.evaluation.tables import Comparison, MetricRow, comparison

RUNS = {
    "good": measure(run_of((10, 1, NONE), (5, 1 / 3, TOTAL), (30, 2, NONE))),
    "bad": measure(run_of((10, 1, NONE), (5, 30, TOTAL), (30, 200, NONE))),
}


def lines_of(text):
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]
    return {row[0]: row[1:] for row in rows}


def test_runs_stand_side_by_side():
    table = lines_of(comparison(RUNS).to_markdown())
    assert table[""] == ["good", "bad"]
    assert table["hidden 11-15: mean error inside, px"] == ["0.3", "30.0"]
    assert table["hidden 11-15: mean error after, px"] == ["2.0", "200.0"]
    assert table["hidden 11-15: recovered"] == ["yes", "no"]
    assert table["on target while visible"] == ["1.000", "0.250"]
    assert table["frames"] == ["45", "45"]


def test_what_is_not_judged_says_so_and_what_was_not_seen_is_empty():
    runs = {
        "short": measure(run_of((2, 1, NONE), (5, 1, TOTAL), (16, 1, NONE))),
        "clear": measure(run_of((25, 1, NONE))),
    }
    table = lines_of(comparison(runs).to_markdown())
    assert table["hidden 3-7: recovered"] == ["not judged", "-"]
    assert table["not TRACKING while hidden"] == ["0.000", "-"]


def test_metrics_that_no_run_has_are_left_out():
    table = comparison({"run": measure(score_frames([row(1, 5.0)], []))})
    assert [line.label for line in table.lines] == [
        "frames", "frames scored", "time per step, median", "time per step, 95 %",
    ]  # fmt: skip


def test_csv_keeps_every_digit():
    rows = list(csv.reader(io.StringIO(comparison(RUNS).to_csv())))
    assert rows[0] == ["metric", "unit", "good", "bad"]
    digits = [repr(metrics.rmse_px) for metrics in RUNS.values()]
    assert len(digits[0]) > 10
    assert ["error, RMSE", "px", *digits] in rows
    assert ["hidden 11-15: recovered", "", "True", "False"] in rows


def test_on_a_terminal_brackets_are_no_styles(capsys):
    show(Comparison(("[bold]",), (MetricRow("[red]label", "px", (1.26,)),)))
    text = capsys.readouterr().out
    assert "[bold]" in text
    assert "[red]label, px" in text
    assert "1.3" in text

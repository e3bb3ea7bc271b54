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

from scoring_samples import NONE, TOTAL, row, run_of

from vehicle_pf_tracker.cli.console import print_rows
from vehicle_pf_tracker.cli.run import run_rows
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames


def rows_of(*stretches):
    return dict(run_rows(measure(run_of(*stretches))))


def test_metrics_of_a_run_with_an_occlusion():
    rows = rows_of((10, 1, NONE), (5, 30, TOTAL), (30, 200, NONE))
    assert rows["hidden 11-15: mean error inside, px"] == "30.0"
    assert rows["hidden 11-15: mean error after, px"] == "200.0"
    assert rows["hidden 11-15: recovered"] == "no"
    assert rows["on target while visible"] == "0.250"
    assert rows["frames"] == "45"
    assert list(rows).index("hidden 11-15: recovered") + 1 == list(rows).index(
        "TRACKING while visible"
    )
    found = rows_of((10, 1, NONE), (5, 1 / 3, TOTAL), (30, 2, NONE))
    assert found["hidden 11-15: recovered"] == "yes"


def test_what_is_not_judged_says_so():
    rows = rows_of((2, 1, NONE), (5, 1, TOTAL), (16, 1, NONE))
    assert rows["hidden 3-7: recovered"] == "not judged"
    assert rows["not TRACKING while hidden"] == "0.000"


def test_metrics_that_a_run_does_not_have_are_left_out():
    rows = run_rows(measure(score_frames([row(1, 5.0)], [])))
    assert [label for label, _ in rows] == [
        "frames", "frames scored", "time per step, median, ms", "time per step, 95 %, ms",
    ]  # fmt: skip


def test_on_a_terminal_brackets_are_no_styles(capsys):
    print_rows(["", "[bold]"], [["[red]label, px", "1.3"]])
    text = capsys.readouterr().out
    assert "[bold]" in text
    assert "[red]label, px" in text
    assert "1.3" in text

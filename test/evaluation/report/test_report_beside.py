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

"""Robustness and speed, which stand beside the grid."""

import json
import shutil

import pytest

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.page_tables import (
    robustness_tables,
    speed_table,
)
from vehicle_pf_tracker.offline.output_files import make_folder, write_json
from vehicle_pf_tracker.offline.run_folder import seal

ORDER = ("pf", "ms")


@pytest.fixture
def folder(made_evaluation, tmp_path):
    """An evaluation of which all was asked; only pf has results on some recordings."""
    copy = tmp_path / "evaluation"
    shutil.copytree(made_evaluation, copy)
    plan = json.loads((copy / "evaluation.json").read_text())
    plan["options"] |= {"shifted_starts": True, "start_frames": 2, "restarts": True}
    (copy / "evaluation.json").write_text(json.dumps(plan))
    for recording, values in {"free": (0.5, 0.7), "under_a_bridge": (0.1,)}.items():
        for number, success in enumerate(values):
            for kind in ("shifted_starts", "start_frames"):
                place = copy / "robustness" / kind / recording / "pf" / "seed-0" / f"s{number}"
                metrics = {"success_auc": success, "precision_20px": None, "rmse_px": 8.0}
                on_target = success + 0.1
                write_cell(place, {"metrics.json": {**metrics, "on_target": on_target}})
    place = make_folder(copy / "robustness" / "restarts" / "free" / "pf" / "seed-1")
    write_cell(place, {"restarts.json": {"failures": 3, "accuracy": None, "robustness": 0.25}})
    return copy


def write_cell(place, documents):
    for name in ("estimates.csv", "metrics.json", "run.json"):
        (make_folder(place) / name).write_text("")
    for name, document in documents.items():
        write_json(place / name, document)
    seal(place)


def texts(table):
    return {label: [cell.text for cell in cells] for label, cells in table.rows.items()}


def test_other_starts_by_hand(folder):
    evaluation = EvaluationFolder(folder)
    shifted, frames, restarts = robustness_tables(evaluation, ORDER).values()
    usual = [
        json.loads((folder / "cells" / name / "pf" / "seed-0" / "metrics.json").read_text())
        for name in ("free", "under_a_bridge")
    ]
    mean = sum(metrics["success_auc"] for metrics in usual) / 2
    # 0.6 on one recording, 0.1 on the other; two of two runs were on target, and none of one.
    expected = [f"{mean:.3f}", "0.350", f"{0.35 - mean:+.3f}", "0.100", "0.50", "3"]
    assert texts(shifted) == {"pf": expected}
    assert texts(frames) == {"pf": ["0.350", "–", "8.0", "3"]}
    assert texts(restarts) == {"pf": ["3.00", "–", "0.250", "1"]}


def test_what_was_not_asked_for_is_not_shown(folder):
    plan = json.loads((folder / "evaluation.json").read_text())
    plan["options"] = {"shifted_starts": False, "start_frames": 0}
    (folder / "evaluation.json").write_text(json.dumps(plan))
    assert robustness_tables(EvaluationFolder(folder), ORDER) == {}


def test_what_was_changed_is_passed_over(folder):
    path = next(folder.glob("robustness/restarts/**/restarts.json"))
    path.write_text(path.read_text().replace("3", "2"))
    found = robustness_tables(EvaluationFolder(folder), ORDER)
    assert list(found) == ["shifted_starts", "start_frames"]


def test_speed_by_hand():
    cells = [
        {"recording": "a", "system": "pf", "step_ms_p50": 1.0, "step_ms_p95": 3.0},
        {"recording": "b", "system": "pf", "step_ms_p50": 3.0, "step_ms_p95": None},
        {"recording": "a", "system": "ms", "step_ms_p50": None},
    ]
    assert texts(speed_table({"cells": cells}, ORDER)) == {"pf": ["2.00", "3.00", "3.00", "500"]}
    assert speed_table(None, ORDER) is None

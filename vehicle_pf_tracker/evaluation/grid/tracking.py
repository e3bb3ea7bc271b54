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

"""Tracking through a recording for a cell of the grid, in the process that is asked to."""

from __future__ import annotations

from dataclasses import astuple, dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.baselines import Baseline, baseline_rows
from vehicle_pf_tracker.evaluation.grid.cells import BaselineSystem, GridCell, VariantSystem
from vehicle_pf_tracker.evaluation.grid.sources import Footage, footage
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.offline.driver import OfflineTracker
from vehicle_pf_tracker.offline.estimates import REJECTED, WAITING, EstimateRow
from vehicle_pf_tracker.offline.run_folder import RunInfo, describe_run, versions
from vehicle_pf_tracker.trackers.registry import find_variant


@dataclass(frozen=True, slots=True)
class CellResult:
    """The result of a cell.

    Attributes
    ----------
    rows : sequence of EstimateRow
        Estimates, one per frame.
    run : dict
        Content of `run.json`.
    metrics : Metrics or None
        Metrics of the run; None where it could not run.
    reason : str
        Reason why it could not run, a sentence; empty if it did.
    """

    rows: list[EstimateRow] = field(default_factory=list)
    run: dict[str, Any] = field(default_factory=dict)
    metrics: Metrics | None = None
    reason: str = ""


def run_cell(cell: GridCell) -> CellResult:
    """Run a cell; a failure is reported in the outcome, so that the others go on."""
    cv2.setNumThreads(1)
    try:
        recording = footage(cell.source)
        if isinstance(cell.system, VariantSystem):
            rows, run = _run_variant(cell, cell.system, recording)
        else:
            rows, run = _run_baseline(cell, cell.system, recording)
        metrics = measure(score_frames(rows, recording.truth, cell.max_diff))
        return CellResult(rows, run, metrics)
    except InputError as error:
        return CellResult(reason=str(error))
    except Exception as error:  # a fault of ours must not cost the rest of a long evaluation
        return CellResult(reason=f"it ended with an internal error: {error!r}")


def _run_variant(
    cell: GridCell, system: VariantSystem, recording: Footage
) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Return the rows of a variant and its `run.json`."""
    tracker = OfflineTracker(
        find_variant(system.variant),
        system.tracker_parameters(cell.seed),
        system.session_parameters(),
        first_truth=recording.truth[0],
        max_diff=cell.max_diff,
    )
    rows = list(tracker.rows(recording.frames()))
    notices = [*recording.notices, *tracker.notices]
    source = cell.source
    info = RunInfo([], source.path, source.topic, tracker.start_frame, notices)
    return rows, describe_run(info, tracker.session)


def _run_baseline(
    cell: GridCell, system: BaselineSystem, recording: Footage
) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Return the rows of a baseline and its `run.json`."""
    first = recording.truth[0]
    python = Path(system.python) if system.python else None
    with Baseline(system.baseline, python, system.model_files()) as baseline:
        rows = list(baseline_rows(baseline, recording.frames(), first))
        opencv = baseline.versions["opencv"]
    started = (row.frame for row in rows if row.mode not in {WAITING, REJECTED})
    return rows, {
        "command": [],
        "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "recording": cell.source.path,
        "image_topic": cell.source.topic,
        "baseline": system.baseline,
        "seed": cell.seed,
        "target": list(astuple(first.box)),
        "start_frame": next(started, None),
        "parameters": dict(system.models),
        "versions": {**versions(), "opencv": opencv},
        "notices": recording.notices,
    }

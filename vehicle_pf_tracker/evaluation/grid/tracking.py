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

"""Run a cell of the grid."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Protocol

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.baselines.client import Baseline, baseline_rows
from vehicle_pf_tracker.evaluation.estimates import REJECTED, WAITING, EstimateRow
from vehicle_pf_tracker.evaluation.failures import follow_restarted
from vehicle_pf_tracker.evaluation.grid.cells import RESTARTS, GridCell
from vehicle_pf_tracker.evaluation.grid.sources import Footage, footage
from vehicle_pf_tracker.evaluation.grid.systems import BaselineSystem, VariantSystem
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.run_folder import RunInfo, describe_run, versions
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.trackers.registry import find_variant


@dataclass(frozen=True, slots=True)
class CellResult:
    """The result of a cell.

    Attributes
    ----------
    rows : tuple of EstimateRow
        Estimates, one per frame.
    run : dict
        Content of `run.json`.
    metrics : Metrics or None
        Metrics of the run; None where it could not run.
    reason : str
        Reason why it could not run, a sentence; empty if it did.
    restarts : dict or None
        Content of `restarts.json` where it was re-started after failures.
    """

    rows: tuple[EstimateRow, ...] = ()
    run: dict[str, Any] = field(default_factory=dict)
    metrics: Metrics | None = None
    reason: str = ""
    restarts: dict[str, Any] | None = None


def run_cell(cell: GridCell) -> CellResult:
    """Run a cell; a failure is reported in the outcome, so that the others go on."""
    cv2.setNumThreads(1)
    try:
        return _run(cell, footage(cell.source))
    except InputError as error:
        return CellResult(reason=str(error))
    except Exception as error:  # a fault of ours must not cost the rest of a long evaluation
        return CellResult(reason=f"it ended with an internal error: {error!r}")


def _run(cell: GridCell, recording: Footage) -> CellResult:
    made: list[Follower] = []

    def make(start: Truth) -> Follower:
        made.append(_follower(cell, start))
        return made[-1]

    restarts = None
    if cell.start.kind == RESTARTS:
        rows, restarts = follow_restarted(recording, make, cell.max_diff)
    else:
        rows = list(make(cell.start.on(recording.truth)).rows(recording.frames()))
    metrics = measure(score_frames(rows, recording.truth, cell.max_diff))
    return CellResult(tuple(rows), made[0].describe(recording.notices), metrics, "", restarts)


class Follower(Protocol):
    """A system that tracks through one recording, from one start on."""

    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]:
        """Track through (stamp in ns, frame) pairs, a row for each."""
        ...

    def describe(self, notices: list[str]) -> dict[str, Any]:
        """Make the content of `run.json`; `notices` are about the recording."""
        ...


def _follower(cell: GridCell, start: Truth) -> Follower:
    if isinstance(cell.system, VariantSystem):
        return _VariantFollower(cell, cell.system, start)
    return _BaselineFollower(cell, cell.system, start)


class _VariantFollower:
    def __init__(self, cell: GridCell, system: VariantSystem, start: Truth) -> None:
        self._cell = cell
        self._tracker = OfflineTracker(
            find_variant(system.variant),
            system.tracker_parameters(cell.seed),
            system.session_parameters(),
            first_truth=start,
            max_diff=cell.max_diff,
        )

    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]:
        return self._tracker.rows(frames)

    def describe(self, notices: list[str]) -> dict[str, Any]:
        source = self._cell.source
        all_notices = [*notices, *self._tracker.notices]
        info = RunInfo([], source.path, source.topic, self._tracker.start_frame, all_notices)
        return describe_run(info, self._tracker.session)


class _BaselineFollower:
    def __init__(self, cell: GridCell, system: BaselineSystem, start: Truth) -> None:
        self._cell = cell
        self._system = system
        self._start = start
        self._start_frame: int | None = None
        self._opencv = ""

    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]:
        python = Path(self._system.python) if self._system.python else None
        with Baseline(self._system.baseline, python, self._system.model_files()) as baseline:
            self._opencv = baseline.opencv
            for row in baseline_rows(baseline, frames, self._start):
                if self._start_frame is None and row.mode not in {WAITING, REJECTED}:
                    self._start_frame = row.frame
                yield row

    def describe(self, notices: list[str]) -> dict[str, Any]:
        source, box = self._cell.source, self._start.box
        return {
            "command": [],
            "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
            "recording": source.path,
            "image_topic": source.topic,
            "baseline": self._system.baseline,
            "seed": self._cell.seed,
            "target": [box.x, box.y, box.width, box.height],
            "start_frame": self._start_frame,
            "parameters": dict(self._system.models),
            "versions": {**versions(), "opencv": self._opencv},
            "notices": notices,
        }

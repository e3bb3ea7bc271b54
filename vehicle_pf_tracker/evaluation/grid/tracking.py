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

"""Run a cell of the grid, and measure the speed of all systems in a serial pass of its own.

The serial pass gives each frame to all systems before the next one, so that a slow moment of the
machine slows all of them alike. It measures the processor time of the tracking thread, without
decoding and the transfer to a baseline's process.
"""

from __future__ import annotations

import itertools
import os
import platform
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Protocol

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import max_diff_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.baselines import Baseline, baseline_rows
from vehicle_pf_tracker.evaluation.evaluation_folder import TIMINGS, Source
from vehicle_pf_tracker.evaluation.grid.cells import (
    RESTARTS,
    BaselineSystem,
    GridCell,
    System,
    VariantSystem,
)
from vehicle_pf_tracker.evaluation.grid.plan import Plan
from vehicle_pf_tracker.evaluation.grid.sources import Footage, footage
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.occlusions import follow_restarted
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.offline.driver import OfflineTracker, with_target
from vehicle_pf_tracker.offline.estimates import REJECTED, WAITING, EstimateRow
from vehicle_pf_tracker.offline.output_files import write_json
from vehicle_pf_tracker.offline.processes import OnProgress, Progress
from vehicle_pf_tracker.offline.run_folder import RunInfo, describe_run, versions
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.trackers.session import Session


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


def _baseline(system: BaselineSystem) -> Baseline:
    python = Path(system.python) if system.python else None
    return Baseline(system.baseline, python, system.model_files())


class _BaselineFollower:
    def __init__(self, cell: GridCell, system: BaselineSystem, start: Truth) -> None:
        self._cell = cell
        self._system = system
        self._start = start
        self._start_frame: int | None = None
        self._opencv = ""

    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]:
        with _baseline(self._system) as baseline:
            self._opencv = baseline.versions["opencv"]
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


WARM_UP = 2
"""First steps left out: the start, and a step that still finds caches cold."""


def time_systems(plan: Plan, folder: Path, frames: int, on_progress: OnProgress) -> None:
    """Measure every step of the first seed's run, and write `timings.json`.

    Parameters
    ----------
    plan : Plan
        The recordings and systems to measure.
    folder : Path
        Folder of the evaluation.
    frames : int
        Largest number of frames of each recording, from the first true box on.
    on_progress : callable
        Called before every recording.

    Raises
    ------
    InputError
        If a recording cannot be read, or the file not be written.
    """
    cv2.setNumThreads(1)
    cells: list[dict[str, Any]] = []
    for done, source in enumerate(plan.recordings):
        on_progress(Progress(done, len(plan.recordings), (source.name,)))
        times = _time_on(source, plan, frames)
        cells += [_cell(source, system, times.get(system.label, [])) for system in plan.systems]
    write_json(
        folder / TIMINGS,
        {
            "clock": "processor time of the tracking thread, ms per step",
            "frames": frames,
            "cells": cells,
            "versions": versions(),
            "processor": [platform.processor() or platform.machine(), os.cpu_count()],
        },
    )


def _cell(source: Source, system: System, steps: Sequence[float]) -> dict[str, Any]:
    kept = steps[WARM_UP:]
    median, late = map(float, np.quantile(kept, (0.5, 0.95))) if kept else (None, None)
    return {
        "recording": source.name,
        "system": system.label,
        "steps": len(kept),
        "step_ms_p50": median,
        "step_ms_p95": late,
    }


def _time_on(source: Source, plan: Plan, count: int) -> dict[str, list[float]]:
    """Return the times (ms) of the steps of all systems that can run."""
    recording = footage(source)
    stamped = _frames(recording, plan.max_diff)
    first = next(stamped)
    box = recording.truth[0].box
    with ExitStack() as stack:
        running: dict[str, _Step] = {}
        for system in plan.systems:
            with suppress(InputError):  # the grid says why it cannot run
                running[system.label] = _start(system, plan.seeds[0], box, first, stack)
        times: dict[str, list[float]] = {label: [] for label in running}
        for shown in itertools.islice(stamped, count - 1):
            for label, step in running.items():
                with suppress(InputError):  # a frame that is refused takes no time
                    times[label].append(1e3 * step(*shown))
    return times


def _frames(recording: Footage, max_diff: float) -> Iterator[tuple[int, Frame]]:
    """Give the frames that can be read, from that of the first truth on."""
    limit = max_diff_ns(max_diff)
    first = recording.truth[0].stamp_ns
    for stamp, frame in recording.frames():
        if frame is not None and stamp >= first - limit:
            yield stamp, frame


_Step = Callable[[int, Frame], float]
"""Takes the stamp (ns) and the frame; returns the processor time of the step in s."""


def _start(
    system: System, seed: int, box: Box, first: tuple[int, Frame], stack: ExitStack
) -> _Step:
    if isinstance(system, BaselineSystem):
        baseline = stack.enter_context(_baseline(system))
        baseline.start(first[1], box)
        return lambda _, frame: baseline.step(frame).seconds
    settings = with_target(system.session_parameters(), box)
    session = Session(find_variant(system.variant), system.tracker_parameters(seed), settings)

    def step(stamp_ns: int, frame: Frame) -> float:
        began = time.thread_time()
        session.feed(frame, stamp_ns)
        return time.thread_time() - began

    step(*first)
    return step

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Run the cells that an evaluation lacks, and keep each as soon as its result is there."""

from __future__ import annotations

import functools
import itertools
import shutil
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import astuple, dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors, whole_folder
from vehicle_pf_tracker.core.progress import ShowCount
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.baselines import Baseline, baseline_rows
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    FAILED_FILE,
    RESTART_KEY,
    RESTARTED_FILE,
    read_document,
)
from vehicle_pf_tracker.evaluation.grid.cells import GridCell, Plan
from vehicle_pf_tracker.evaluation.grid.sources import SourceFootage, footage
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.restarts import measure_restarts, with_restarts
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.evaluation.systems import BASELINE_PREFIX, System
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.results import run_folder
from vehicle_pf_tracker.results.estimates import (
    REJECTED_MODE,
    WAITING_MODE,
    EstimateRow,
    write_estimates,
)
from vehicle_pf_tracker.results.output_files import flush, make_folder, write_json
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.workers.cluster import run_on_cluster
from vehicle_pf_tracker.workers.processes import run_in_processes


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
    restarted : list of EstimateRow
        Estimates with restarts after failure, one per frame; empty if there were to be none.
    """

    rows: list[EstimateRow] = field(default_factory=list)
    run: dict[str, Any] = field(default_factory=dict)
    metrics: Metrics | None = None
    reason: str = ""
    restarted: list[EstimateRow] = field(default_factory=list)


def run_cell(cell: GridCell) -> CellResult:
    """Run a cell; a failure is reported in the outcome, so that the others go on."""
    try:
        # In the try: a recording that cannot be read fails its cells, and not the evaluation.
        seen = footage(cell.source)
        run_it = _run_baseline if cell.system.is_baseline else _run_variant
        rows, run = run_it(cell, seen)
        metrics = measure(score_frames(rows, seen.truth, cell.max_diff))
        if cell.restart is None:
            return CellResult(rows, run, metrics)
        restarted = _restarted(cell, seen, rows, cell.restart)
        scores = measure_restarts(score_frames(restarted, seen.truth, cell.max_diff))
        run = {**run, RESTART_KEY: cell.restart}
        return CellResult(rows, run, replace(metrics, restarts=scores), restarted=restarted)
    except InputError as error:
        return CellResult(reason=str(error))
    except Exception as error:  # a fault of ours must not cost the rest of a long evaluation
        return CellResult(reason=f"it ended with an internal error: {error!r}")


def _run_variant(cell: GridCell, seen: SourceFootage) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Return the rows of a variant and its `run.json`."""
    tracker = _tracker(cell, first_truth=seen.truth[0])
    rows = list(tracker.rows(seen.frames()))
    notices = [*seen.recording.notices, *tracker.notices]
    description = run_folder.describe_target_run(
        tracker.session, tracker.start_frame, [], cell.source.path, cell.source.topic, notices
    )
    return rows, description


def _tracker(cell: GridCell, **target: Any) -> OfflineTracker:
    system = cell.system
    return OfflineTracker(
        find_variant(system.kind),
        system.tracker_parameters(cell.seed),
        system.session_parameters(),
        max_diff=cell.max_diff,
        **target,
    )


def _run_baseline(cell: GridCell, seen: SourceFootage) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Return the rows of a baseline and its `run.json`."""
    system = cell.system
    with _baseline(system) as baseline:
        rows = list(baseline_rows(baseline, seen.frames(), seen.truth[0]))
        opencv = baseline.versions["opencv"]
    started = (row.frame for row in rows if row.mode not in {WAITING_MODE, REJECTED_MODE})
    description = run_folder.describe_run(
        [],
        cell.source.path,
        cell.source.topic,
        seen.recording.notices,
        baseline=baseline.name,
        seed=cell.seed,
        target=list(astuple(seen.truth[0].box)),
        start_frame=next(started, None),
        parameters=dict(system.overrides),
    )
    description["versions"]["opencv"] = opencv
    return rows, description


def _baseline(system: System) -> Baseline:
    python = Path(system.python) if system.python else None
    return Baseline(system.kind.removeprefix(BASELINE_PREFIX), python, system.model_files())


def _restarted(
    cell: GridCell, seen: SourceFootage, rows: Sequence[EstimateRow], wait: int
) -> list[EstimateRow]:
    """Return the rows of a cell with restarts `wait` frames after a failure."""

    def start(index: int, box: Box) -> Generator[EstimateRow, None, None]:
        # A system of its own for each start, which has seen nothing of what was before.
        frames = itertools.islice(seen.frames(), index, None)
        number = index + 1
        if not cell.system.is_baseline:
            yield from _tracker(cell, targets={number: box}).rows(frames, number)
            return
        truth = Truth(rows[index].stamp_ns, box, Occlusion.NONE)
        with _baseline(cell.system) as baseline:
            yield from baseline_rows(baseline, frames, truth, number)

    size = cell.source.width, cell.source.height
    return with_restarts(rows, seen.truth, cell.max_diff, wait, size, start)


Runner: TypeAlias = Callable[[Sequence[GridCell]], Iterable[tuple[GridCell, CellResult]]]
"""Runs cells, in any order, and yields each with its result."""


def on_this_machine(workers: int) -> Runner:
    """Return what runs cells in `workers` processes; results do not depend on how many."""
    return functools.partial(run_in_processes, run_cell, workers=workers, lost=_lost)


def _lost(sentence: str) -> CellResult:
    return CellResult(reason=sentence)


def on_cluster(address: str, on_notice: Callable[[str], object] = lambda _: None) -> Runner:
    """Return what runs cells on the workers of the Dask scheduler at `address`."""
    return functools.partial(
        run_on_cluster, run_cell, address=address, key=_key_on_cluster, on_notice=on_notice
    )


def _key_on_cluster(cell: GridCell) -> str:
    # The names are for the dashboard, where a digest says nothing.
    return f"{cell.source.name}-{cell.system.label}-{cell.seed}-{cell.key()}".replace(" ", "-")


def complete(plan: Plan, folder: Path, runner: Runner, on_progress: ShowCount) -> int:
    """Run the cells of `plan` that `folder` does not have, and return how many those were.

    Parameters
    ----------
    plan : Plan
        The plan; it is written into the folder first.
    folder : Path
        Folder of the evaluation.
    runner : callable
        Runs the missing cells.
    on_progress : callable
        Called with the number of runs done, and of all.

    Raises
    ------
    InputError
        If the folder cannot be written, or a process is ended from outside.
    """
    with output_errors(folder):
        for left in make_folder(folder).glob("**/.seed-*"):  # half written by a run that was killed
            # A folder that is begun is hidden until it is whole: the name shows which are not.
            shutil.rmtree(left, ignore_errors=True)
    plan.write(folder)
    # After the plan: a folder without results is still one that can be gone on with.
    missing = [cell for cell in plan.cells() if not _is_stored(cell, cell.folder(folder))]
    on_progress(0, len(missing))
    for done, (cell, outcome) in enumerate(runner(missing), start=1):
        # Each as soon as it is there: what is interrupted loses the runs under way only.
        _store(cell, outcome, cell.folder(folder), plan.command)
        on_progress(done, len(missing))
    return len(missing)


def _is_stored(cell: GridCell, folder: Path) -> bool:
    """Return whether the folder has the result of the cell; one that failed is tried again."""
    try:
        # By the key, not the name: a result of other code or parameters is none.
        return bool(read_document(folder / run_folder.RUN_FILE).get("key") == cell.key())
    except InputError:  # it is not there, or nothing that can be read
        return False


def _store(cell: GridCell, outcome: CellResult, folder: Path, command: list[str]) -> None:
    """Store the outcome of a cell, replacing that of an earlier run."""
    with output_errors(folder), whole_folder(folder) as partial:
        if outcome.metrics is None:
            write_json(partial / FAILED_FILE, {"reason": outcome.reason})
        else:
            keys = {"command": command, "key": cell.key()}
            run_folder.write_run(partial, outcome.rows, {**outcome.run, **keys})
            write_json(partial / run_folder.METRICS_FILE, outcome.metrics.to_json())
            if outcome.restarted:
                write_estimates(partial / RESTARTED_FILE, outcome.restarted)
    # The rename, too, has to reach the disk.
    flush(folder.parent)

"""Runs the cells that an evaluation lacks, and keeps each as soon as it is there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.grid.cells import GridCell
from vehicle_pf_tracker.evaluation.grid.plan import Plan
from vehicle_pf_tracker.evaluation.grid.store import CellStore
from vehicle_pf_tracker.evaluation.grid.tracking import Outcome, run_cell
from vehicle_pf_tracker.evaluation.output_files import make_folder
from vehicle_pf_tracker.evaluation.output_lock import alone_in
from vehicle_pf_tracker.evaluation.processes import Turn, run_in_processes
from vehicle_pf_tracker.evaluation.progress import OnProgress, Progress

Runner: TypeAlias = Callable[[Sequence[GridCell]], Iterable[Turn[GridCell, Outcome]]]
"""Runs cells, in any order, and tells what happens."""


def on_this_machine(workers: int) -> Runner:
    """Return what runs cells in `workers` processes; results do not depend on how many."""
    return partial(run_in_processes, run_cell, workers=workers)


def complete(plan: Plan, folder: Path, runner: Runner, on_progress: OnProgress) -> int:
    """Run the cells of `plan` that `folder` does not have, and return how many those were.

    Parameters
    ----------
    plan : Plan
        Is written into the folder first.
    folder : Path
        Of the evaluation.
    runner : callable
        Runs them.
    on_progress : callable
        Is told whenever a run begins or ends.

    Raises
    ------
    InputError
        If the folder cannot be written, another command is at work there, or a process is ended
        from outside.
    """
    with alone_in(make_folder(folder)):
        store = CellStore(folder)
        plan.write(folder)
        cells = plan.cells()
        store.drop_others(cells)
        missing = [cell for cell in cells if not store.has(cell)]
        done = 0
        for turn in runner(missing):
            if turn.ended is not None:
                store.add(*turn.ended, plan.command)
                done += 1
            on_progress(Progress(done, len(missing), tuple(cell.label for cell in turn.running)))
    return len(missing)

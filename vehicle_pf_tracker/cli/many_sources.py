# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many sources under one command: a folder of results each, and one table over all.

Each source is a job for the verb itself, in a process here or on a worker of a cluster. What is
done is kept under a key, so that a second run continues; a source that fails costs itself only.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.cli import console
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.source_job import Follow, Job, Outcome, follow_job, is_done, store
from vehicle_pf_tracker.cli.source_key import key_of
from vehicle_pf_tracker.cli.source_lists import SeveralSources, requests_by_name
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed, output_errors
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.results.output_files import make_folder, write_csv
from vehicle_pf_tracker.results.source_table import Cell, SourceTable, read_table
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.workers.cluster import run_on_cluster
from vehicle_pf_tracker.workers.processes import run_in_processes

_TABLE = "sources.csv"
"""File of the table over all sources."""
_MOST_PRINTED = 40
"""Rows of the table on a terminal, what a screen holds; the file has all."""


def follow_each(
    request: SeveralSources,
    variant: Variant,
    follow: Follow,
    configure: Callable[[Any], Configuration],
    advise: Callable[[Sequence[str], Path, Sequence[Path]], list[str]] = lambda *_: [],
) -> int:
    """Follow each source of a request, and print the table over all; return the exit status.

    Parameters
    ----------
    request : SeveralSources
        The request, whose output is the folder over all.
    variant : Variant
        Tracker of the verb.
    follow : callable
        Follows one source.
    configure : callable
        Gives the parameters of a request, so that their mistakes end the command at its start.
    advise : callable
        Function of the command's words, the folder over all and those in it: sentences to print at
        the end.

    Raises
    ------
    InputError
        If an option or a list cannot be used, or two sources have one name.
    """
    folder = request.output
    if folder is None:
        raise UsageError("several sources need a folder for all results: give it with -o DIR")
    if request.serve is not None:
        raise UsageError("--serve shows one source; leave it out, or give one source")
    jobs = [
        Job(name, own, follow, key_of(own, variant, configure(own)))
        for name, own in requests_by_name(request).items()
    ]
    with claimed([Products(folder)], [job.request.source for job in jobs], overwrite=True):
        status = _complete(jobs, request, make_folder(folder))
    for sentence in advise(request.command, folder, [folder / job.name for job in jobs]):
        print(sentence)
    return status


def _complete(jobs: Sequence[Job], request: SeveralSources, folder: Path) -> int:
    """Run the jobs that the folder has no results of, and report on all."""
    with output_errors(folder):
        for left in folder.glob(".*.partial"):  # half written by a command that was killed
            shutil.rmtree(left, ignore_errors=True)
    missing = [job for job in jobs if request.overwrite or not is_done(job, folder / job.name)]
    if len(missing) < len(jobs):
        console.tell_notice(f"{len(jobs) - len(missing)} of {len(jobs)} sources were done before")
    lost = ""
    with console.counting("followed", "sources") as progress:
        try:
            for done, (job, outcome) in enumerate(_run(missing, request), start=1):
                store(job, outcome, folder / job.name)
                progress(done, len(missing))
        except InputError as error:  # workers are gone; what the others did is kept
            lost = str(error)
    table = read_table(folder, [job.name for job in jobs])
    write_csv(folder / _TABLE, table.header, table.rows)
    _print(table)
    for name, reason in table.failures.items():
        console.tell_error(f"{name}: {reason}")
    if lost:
        console.tell_error(lost)
    print(f"results are in {folder}, a folder for each source; {_TABLE} is the table")
    return int(bool(table.failures or lost))


def _print(table: SourceTable) -> None:
    rows = [list(map(_shown, row)) for row in table.rows]
    if len(rows) > _MOST_PRINTED:
        console.tell_notice(f"the first {_MOST_PRINTED} of {len(rows)} sources, and all together")
    console.print_rows(table.header, [*rows[:_MOST_PRINTED], list(map(_shown, table.totals))])


def _shown(cell: Cell) -> str:
    """Return a cell for people; the file has all digits."""
    return "" if cell is None else f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def _run(jobs: Sequence[Job], request: SeveralSources) -> Iterator[tuple[Job, Outcome]]:
    if request.scheduler is None:
        return run_in_processes(follow_job, jobs, request.workers, _lost)
    return run_on_cluster(
        follow_job,
        jobs,
        address=request.scheduler,
        key=lambda job: f"{job.name}-{job.key}".replace(" ", "-"),
        on_notice=console.tell_notice,
    )


def _lost(sentence: str) -> Outcome:
    return Outcome({}, sentence)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many sources under one command: a folder of results each, and one table over all.

Each source is followed by the verb itself, in a process here or on a worker of a cluster. What is
done is kept under a key, so that a second run continues; a source that fails costs itself only.
"""

from __future__ import annotations

import contextlib
import functools
import io
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.cli import console
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.source_lists import (
    NOT_DECISIVE,
    OUTPUT_OPTIONS,
    SeveralSources,
    requests_by_name,
)
from vehicle_pf_tracker.core.addresses import shown
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed, output_errors, whole_folder
from vehicle_pf_tracker.evaluation.cache_key import result_key, variant_modules
from vehicle_pf_tracker.evaluation.evaluation_folder import read_document
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.recordings.url_copies import fetched
from vehicle_pf_tracker.results.output_files import make_folder, write_csv, write_json
from vehicle_pf_tracker.results.run_folder import RUN_FILE
from vehicle_pf_tracker.results.source_table import SOURCE_FILE, SourceTable, read_table
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.workers.cluster import fingerprint, run_on_cluster
from vehicle_pf_tracker.workers.processes import run_in_processes

_TABLE = "sources.csv"
"""File of the table over all sources."""
_MOST_PRINTED = 40
"""Rows of the table on a terminal, what a screen holds; the file has all."""
Follow: TypeAlias = Callable[[Any], int]
"""Function that follows what is in the one source of a request, and returns the exit status: one
at the top of a verb's module, which a process can import."""


@dataclass(frozen=True, slots=True)
class Job:
    """One source to follow.

    Attributes
    ----------
    name : str
        Name of its folder.
    request : SeveralSources
        Request of this source alone.
    follow : callable
        The verb.
    key : str
        Digest of all that decides the results.
    """

    name: str
    request: SeveralSources
    follow: Follow
    key: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """Results of a source.

    Attributes
    ----------
    files : dict of str to bytes
        Files by their path in its folder.
    reason : str
        Sentences about why they are not whole; empty if they are.
    """

    files: dict[str, bytes]
    reason: str


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
        Job(name, one, follow, _key(one, variant, configure(one)))
        for name, one in requests_by_name(request).items()
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
    missing = [one for one in jobs if request.overwrite or not _is_done(one, folder / one.name)]
    if len(missing) < len(jobs):
        console.tell_notice(f"{len(jobs) - len(missing)} of {len(jobs)} sources were done before")
    lost = ""
    with console.counting("followed", "sources") as progress:
        try:
            for done, (job, outcome) in enumerate(_run(missing, request), start=1):
                _store(job, outcome, folder / job.name)
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
    rows = [["" if cell is None else str(cell) for cell in row] for row in table.rows]
    if len(rows) > _MOST_PRINTED:
        console.tell_notice(f"the first {_MOST_PRINTED} of {len(rows)} sources, and all together")
    console.print_rows(table.header, [*rows[:_MOST_PRINTED], list(map(str, table.totals))])


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


def follow_job(job: Job) -> Outcome:
    """Follow one source into a scratch folder, and return what was written there."""
    with tempfile.TemporaryDirectory(prefix="vehicle-pf-tracker-") as scratch:
        folder = Path(scratch, "results")
        places = {
            name: folder / Path(place).name
            for name in OUTPUT_OPTIONS
            if (place := getattr(job.request, name, None)) is not None
        }
        request = _with(job.request, output=folder, **places)
        told = io.StringIO()
        # Many of them would write over each other's lines.
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(told):
            status = exit_status(lambda: _followed(job.follow, request, Path(scratch)))
        # Errors and notes of the verb, without the words before them (`console.tell_error`).
        sentences = [
            line.partition(": ")[2].partition(": ")[2]
            for line in told.getvalue().splitlines()
            if line.startswith(f"{console.PROGRAM_NAME}: ")
        ]
        files = {
            path.relative_to(folder).as_posix(): path.read_bytes()
            for path in sorted(folder.rglob("*"))
            if path.is_file()
        }
    return Outcome(files, "; ".join(sentences) or f"status {status}" if status else "")


def _with(request: SeveralSources, **changed: Any) -> SeveralSources:
    """Replace fields, some of which only the requests of one verb have."""
    return replace(request, **changed)


def _followed(follow: Follow, request: SeveralSources, scratch: Path) -> int:
    """Follow the source, copied to this machine before if it is at a URL."""
    source = request.source
    try:
        if not is_url(source):
            return follow(request)
        copy = fetched(source, scratch)
        status = follow(replace(request, source=str(copy)))
    except (InputError, UsageError, OSError, ModuleNotFoundError, MemoryError):
        raise
    except Exception as error:  # a fault of ours must not cost the other sources
        raise InputError(f"it ended with an internal error: {error!r}") from error
    assert request.output is not None
    for path in request.output.rglob(RUN_FILE):  # not the copy, which is gone
        write_json(path, {**json.loads(path.read_text()), "recording": shown(source)})
    return status


def _store(job: Job, outcome: Outcome, folder: Path) -> None:
    """Put the results of a source into its folder, in place of those of an earlier run."""
    with output_errors(folder), whole_folder(folder) as partial:
        for name, content in outcome.files.items():
            (partial / name).parent.mkdir(parents=True, exist_ok=True)
            (partial / name).write_bytes(content)
        facts = {"source": shown(job.request.source), "key": job.key, "reason": outcome.reason}
        write_json(partial / SOURCE_FILE, facts)


def _is_done(job: Job, folder: Path) -> bool:
    """Tell whether the folder has whole results of the job; a failed one is tried again."""
    try:
        stored = read_document(folder / SOURCE_FILE)
    except InputError:  # it is not there, or nothing that can be read
        return False
    return bool(stored.get("key") == job.key and not stored.get("reason"))


def _key(request: SeveralSources, variant: Variant, configuration: Configuration) -> str:
    """Digest all that decides the results: source, options, code and versions."""
    options = {one.name: getattr(request, one.name) for one in fields(request)}
    decisive = {name: value for name, value in options.items() if name not in NOT_DECISIVE}
    values = {**configuration.to_mapping(), **decisive}
    facts = {
        "source": _stamp(request.source),
        "options": {name: repr(_content(value)) for name, value in sorted(values.items())},
        "made on": _own_fingerprint(),
    }
    return result_key(facts, variant_modules(variant))


_own_fingerprint = functools.cache(fingerprint)


def _stamp(source: str) -> Any:
    """Name the content of a source by names, sizes and times: reading it would take hours."""
    path = Path(source)
    if is_url(source) or not path.exists():
        return source
    files: Iterable[Path] = sorted(path.rglob("*")) if path.is_dir() else [path]
    states = [(file.name, file.stat()) for file in files if file.is_file()]
    return [[name, state.st_size, state.st_mtime_ns] for name, state in states]


def _content(value: Any) -> Any:
    """Return a value, or the text of the file that it names."""
    if isinstance(value, Path | str) and os.path.isfile(value):  # noqa: PTH113 - any text
        return Path(value).read_bytes()
    return value

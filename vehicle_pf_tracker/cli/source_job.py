# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One of many sources: followed by its verb in a scratch folder, and its results kept whole."""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.cli import console
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.source_lists import OUTPUT_OPTIONS, SeveralSources
from vehicle_pf_tracker.core.addresses import shown
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors, whole_folder
from vehicle_pf_tracker.evaluation.evaluation_folder import read_document
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.recordings.url_copies import fetched
from vehicle_pf_tracker.results.output_files import write_json
from vehicle_pf_tracker.results.run_folder import RUN_FILE
from vehicle_pf_tracker.results.source_table import SOURCE_FILE

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


def store(job: Job, outcome: Outcome, folder: Path) -> None:
    """Put the results of a source into its folder, in place of those of an earlier run."""
    with output_errors(folder), whole_folder(folder) as partial:
        for name, content in outcome.files.items():
            (partial / name).parent.mkdir(parents=True, exist_ok=True)
            (partial / name).write_bytes(content)
        facts = {"source": shown(job.request.source), "key": job.key, "reason": outcome.reason}
        write_json(partial / SOURCE_FILE, facts)


def is_done(job: Job, folder: Path) -> bool:
    """Test whether the folder has whole results of the job; a failed one is tried again."""
    try:
        stored = read_document(folder / SOURCE_FILE)
    except InputError:  # it is not there, or nothing that can be read
        return False
    return bool(stored.get("key") == job.key and not stored.get("reason"))

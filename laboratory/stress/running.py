# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Runs trackers over cases, in several processes, and keeps every score."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, NamedTuple

from laboratory.result_store import ResultStore
from laboratory.stress.cases import Case
from laboratory.stress.scoring import Score, score_case
from laboratory.stress.systems import Follower, StressSystem
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.progress import ShowCount
from vehicle_pf_tracker.evaluation.cache_key import result_key
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.workers.processes import run_in_processes

WORKERS = 2
"""Processes of a battery unless it is told otherwise: a laptop stays usable."""
# Read by OpenMP, OpenBLAS and MKL.
_THREADS = "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"


class Result(NamedTuple):
    """The score of a system in a case, with a seed."""

    case: Case
    system: str
    seed: int
    score: Score


class _Task(NamedTuple):
    case: Case
    system: StressSystem
    seed: int

    @property
    def label(self) -> str:
        return f"{self.case.name} {self.system.label} {self.seed}"

    def key(self) -> str:
        # The digest and not the path: a sequence that was moved is still the same.
        facts = {
            "sequence": self.case.origin.source.digest,
            "case": repr([(name, value) for name, value in _fields(self.case) if name != "origin"]),
            "system": self.system.identity(),
            "seed": self.seed,
        }
        return result_key(facts, {__name__, *self.system.modules})


def run_case(case: Case, system: StressSystem, seed: int = 0) -> Score:
    """Run a new tracker through a case, and score it."""
    estimates: list[Estimate | EstimateRow] = []
    fault = ""
    try:
        tracker = system.make(seed)
        with contextlib.ExitStack() as stack:
            # A baseline has a process, which must not outlive the case.
            if hasattr(tracker, "close"):
                stack.callback(tracker.close)
            estimates.extend(follow(case, tracker))
    except InputError as error:
        fault = str(error)
    except Exception as error:  # a fault of one tracker must not cost the rest of a long battery
        fault = f"it ended with a fault of the program: {error!r}"
    return score_case(case, estimates, fault)


def follow(case: Case, tracker: Follower) -> Iterator[Estimate | EstimateRow]:
    """Run a tracker through a case: one estimate per frame."""
    # Trackers of the package reckon in frame periods; others may know no time.
    if hasattr(tracker, "frame_period"):
        tracker.frame_period = 1.0 / case.fps
    box = case.start_box()
    for number, (frame, elapsed, _) in enumerate(case.play()):
        yield tracker.step(frame, elapsed) if number else tracker.start(frame, box)


def run_battery(
    cases: Sequence[Case],
    systems: Sequence[StressSystem],
    *,
    seeds: Sequence[int] = (0,),
    workers: int = WORKERS,
    store: Path | None = None,
    on_progress: ShowCount | None = None,
) -> list[Result]:
    """Run systems over cases; the results do not depend on the number of workers.

    Parameters
    ----------
    cases : sequence of Case
        Cases to run; see `battery`.
    systems : sequence of StressSystem
        Systems under test, each with its own label.
    seeds : sequence of int
        A deterministic system runs with the first.
    workers : int
        Processes, each with one thread; 0 runs in this one, without limiting its threads.
    store : Path or None
        File that keeps each score as soon as it is there. Scores that it has under the same case,
        footage, system, code and versions are not computed again.
    on_progress : callable or None
        Called with the number of runs done, and of all.

    Returns
    -------
    list of Result
        System by system, each in the order of the cases.

    Raises
    ------
    InputError
        If the store cannot be written, or a process is ended from outside.
    """
    tasks = _tasks(cases, systems, seeds)
    kept = ResultStore(store) if store is not None else None
    scores = {key: kept[key] for _, key in tasks if kept is not None and key in kept}
    # Sequence by sequence, so that a recording is decoded once.
    missing = sorted(
        (pair for pair in tasks if pair[1] not in scores), key=lambda pair: pair[0].case.sequence
    )
    if on_progress is not None:
        on_progress(len(scores), len(tasks))
    for (task, key), score in _run(missing, workers):
        scores[key] = score
        if kept is not None:
            kept.add(key, task.label, score)
        if on_progress is not None:
            on_progress(len(scores), len(tasks))
    return [
        # From plain values also where it was computed now: kept and new results are the same.
        Result(task.case, task.system.label, task.seed, Score.from_json(scores[key]))
        for task, key in tasks
    ]


def _tasks(
    cases: Sequence[Case], systems: Sequence[StressSystem], seeds: Sequence[int]
) -> list[_Keyed]:
    tasks = [
        _Task(case, system, seed)
        for system in systems
        for case in cases
        for seed in (seeds[:1] if system.is_deterministic else seeds)
    ]
    return [(task, task.key()) for task in tasks]


_Keyed = tuple[_Task, str]


def _run(tasks: Sequence[_Keyed], workers: int) -> Iterator[tuple[_Keyed, dict[str, Any]]]:
    """Run tasks; yield each with its score."""
    if workers == 0:
        for task in tasks:
            yield task, _score(task)
        return
    with _single_threaded():
        yield from run_in_processes(_score, tasks, workers)


def _score(task: _Keyed) -> dict[str, Any]:
    case, system, seed = task[0]
    return run_case(case, system, seed).to_json()


@contextlib.contextmanager
def _single_threaded() -> Iterator[None]:
    """Let processes that begin now compute on one thread each."""
    # Before they begin: the libraries read these variables when they are loaded.
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _fields(case: Case) -> list[tuple[str, object]]:
    return [(each.name, getattr(case, each.name)) for each in fields(case)]

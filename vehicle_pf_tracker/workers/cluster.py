# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Work on the machines of a Dask scheduler: each task once, whichever worker dies.

Every worker has to have this package at the same version and on the same libraries: they are
compared before the first task, and again by each task, as workers may join on the way.
"""

from __future__ import annotations

import importlib
import logging
import socket
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.code_digest import CODE, code_digest
from vehicle_pf_tracker.results.run_folder import versions

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")

SCHEDULER_SECONDS = 10.0
"""Time to wait for a scheduler, s: one that runs answers within one, over a slow network too."""

_PACKAGE = Path(__file__).parents[1]
"""Folder of our code, all of which counts for the fingerprint."""
_ONE_TASK = threading.Lock()
"""Held by the task of this worker process: with several threads its frames would be kept twice in
memory, and its steps timed beside each other."""


def fingerprint() -> dict[str, str]:
    """Return versions and a digest of our code, which decide the numbers on this machine."""
    # With its place: a module that is moved is other code.
    code = code_digest(
        (path.relative_to(_PACKAGE).as_posix(), path)
        for kind in CODE
        for path in _PACKAGE.rglob(kind)
    )
    # Not the platform's whole name, which has the kernel's build in it.
    decisive = {name: str(value) for name, value in versions().items() if name != "platform"}
    return {**decisive, "code": code[:12]}


def run_on_cluster(
    function: Callable[[TaskT], ResultT],
    tasks: Sequence[TaskT],
    *,
    address: str,
    key: Callable[[TaskT], str],
    on_notice: Callable[[str], object] = lambda _: None,
    seconds: float = SCHEDULER_SECONDS,
) -> Iterator[tuple[TaskT, ResultT]]:
    """Call `function` with each task on a cluster; yield every task with its result.

    A task whose worker dies is run again on another one. Each result is given once.

    Parameters
    ----------
    function : callable
        Top-level function of a module of this package, pure in its task.
    tasks : sequence
        Tasks that can be pickled; their files have to be where a worker finds them.
    address : str
        Address of the scheduler, as ``tcp://host:8786``.
    key : callable
        Gives the key of a task; tasks of one key are one.
    on_notice : callable
        Takes a sentence about the cluster: its workers, and where its dashboard is.
    seconds : float
        Time to wait for the scheduler, s.

    Raises
    ------
    InputError
        If the scheduler cannot be reached, has no worker or one of another version, or is lost on
        the way; after all other tasks, if one was given up, as its workers died each time.
    """
    if not tasks:
        return
    with _connected(address, seconds) as client:
        own = fingerprint()
        # Before the first task, so that a wrong version costs no time.
        _compare(own, _fingerprints(client))
        on_notice(f"{_workers_words(client)}; the dashboard is {client.dashboard_link}")
        yield from _results(client, function, tasks, key, own)


def _results(
    client: Any,
    function: Callable[[TaskT], ResultT],
    tasks: Sequence[TaskT],
    key: Callable[[TaskT], str],
    own: Mapping[str, str],
) -> Iterator[tuple[TaskT, ResultT]]:
    """Submit all tasks, and yield each with its result as it is done."""
    distributed = _distributed()
    # Two tasks of one key are one: Dask would run the second under the name of the first.
    by_key = {key(task): task for task in tasks}
    # Not pure for Dask: a worker of this run, not a result of an earlier one, has to answer.
    submitted = [
        client.submit(call_if_alike, function, task, own, key=name, pure=False)
        for name, task in by_key.items()
    ]
    waiting = distributed.as_completed(submitted, loop=client.loop)
    submitted.clear()  # so that the scheduler can drop each result once it is here
    given_up = []
    for future in waiting:
        error = future.exception()
        if isinstance(error, InputError):  # of a worker that joined on the way: so will the others
            raise error
        if error is None:
            yield by_key[future.key], future.result()
        else:
            # Its workers died each time, as of too little memory: the others go on meanwhile.
            given_up.append(f"{future.key}: {' '.join(str(error).split())}")
    if given_up:
        raise InputError(f"the cluster gave up {len(given_up)} of {len(by_key)}, {given_up[0]}")


def call_if_alike(
    function: Callable[[TaskT], ResultT], task: TaskT, own: Mapping[str, str]
) -> ResultT:
    """Call `function` on a worker, once its fingerprint is found to be `own`.

    Raises
    ------
    InputError
        If it would give other numbers.
    """
    with _ONE_TASK:
        # On the worker itself, each time: one that joined on the way was not asked at the start.
        _compare(own, {socket.gethostname(): fingerprint()})
        cv2.setNumThreads(1)
        return function(task)


def _compare(own: Mapping[str, str], workers: Mapping[str, Mapping[str, str]]) -> None:
    """Refuse workers whose numbers could differ, in one sentence that names what differs."""
    for worker, theirs in workers.items():
        differing = [
            f"{name} {theirs.get(name)} instead of {value}"
            for name, value in own.items()
            if theirs.get(name) != value
        ]
        if differing:
            raise InputError(
                f"the worker {worker} would give other numbers, it has {', '.join(differing)}; "
                "install the same everywhere"
            )


def _distributed() -> Any:
    """Import Dask's client; it is an extra, and without types."""
    try:
        return importlib.import_module("distributed")
    except ModuleNotFoundError:
        raise InputError(
            "a Dask scheduler needs the extra [cluster]: pip install 'vehicle_pf_tracker[cluster]'"
        ) from None


@contextmanager
def _connected(address: str, seconds: float) -> Iterator[Any]:
    """Connect to a scheduler that has workers, and disconnect at the end of the block."""
    import asyncio  # noqa: PLC0415 - 40 ms that only a cluster costs

    distributed = _distributed()
    # Its log would print a traceback beside our sentence when the scheduler is lost.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(address, timeout=seconds, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # a TimeoutError is an OSError
        raise InputError(
            f"no Dask scheduler answers at {address}; `dask scheduler` starts one"
        ) from error
    try:
        if not client.scheduler_info(n_workers=-1)["workers"]:
            raise InputError(
                f"the Dask scheduler at {address} has no workers: start `dask worker {address} "
                "--nworkers auto --nthreads 1` on each machine"
            )
        yield client
    except (OSError, CancelledError, asyncio.CancelledError) as error:
        raise InputError(
            f"the Dask scheduler at {address} was lost on the way; start it and its workers again, "
            "and run the same command: results so far are kept"
        ) from error
    finally:
        client.close()


def _fingerprints(client: Any) -> Mapping[str, Mapping[str, str]]:
    """Ask every worker what decides its numbers."""
    try:
        answers: Mapping[str, Mapping[str, str]] = client.run(fingerprint)
    except ModuleNotFoundError as error:
        raise InputError(
            f"a worker has no Python module {error.name}: install this package on each machine, "
            "pip install 'vehicle_pf_tracker[evaluation,cluster]'"
        ) from error
    return answers


def _workers_words(client: Any) -> str:
    workers = client.scheduler_info(n_workers=-1)["workers"].values()
    hosts = {worker["host"] for worker in workers}
    return f"{len(workers)} workers on {len(hosts)} machine{'s' if len(hosts) > 1 else ''}"

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Processes of this machine that work for this one, and end with it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

import cv2

from vehicle_pf_tracker.core.errors import InputError

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")

PATIENCE = 10.0
"""Seconds that a child gets to end by itself: a node on a busy machine needs a few to clean up."""
_LOOK = 0.01
"""Interval of looks for the status of a child, s: short beside the time in which one ends."""


def run_in_processes(
    function: Callable[[TaskT], ResultT],
    tasks: Sequence[TaskT],
    workers: int,
    lost: Callable[[str], ResultT] | None = None,
) -> Iterator[tuple[TaskT, ResultT]]:
    """Call `function` with each task; yield every task with its result as soon as it is there.

    That a process was ended may be noticed only when a task of another one has its result.

    Parameters
    ----------
    function : callable
        Top-level function of a module, so that a process can import it.
    tasks : sequence
        Tasks in the order of their start.
    workers : int
        Number of processes.
    lost : callable or None
        Function that makes the result of a task whose process is ended from outside, as by a fault
        of a library in C, from a sentence that says how; all other tasks are still done.

    Raises
    ------
    InputError
        If a process is ended from outside, and there is no `lost`.
    """
    waiting = dict(enumerate(tasks))
    while waiting:
        ended: list[str] = []
        for index, result in _in_pool(function, waiting, workers, ended.append):
            yield waiting.pop(index), result
        if ended and lost is None:
            raise InputError(
                "a worker process was ended from outside, perhaps out of memory; "
                "run the command again to go on, with fewer --workers"
            )
        # The pool does not say which task it was. Tasks are begun in order, so that it is among the
        # first: each of them alone.
        suspects = {index: waiting.pop(index) for index in list(waiting)[: workers + 1]}
        for index, task in suspects.items():
            ended = []
            for _, result in _in_pool(function, {index: task}, 1, ended.append):
                yield task, result
            if ended and lost is not None:
                yield task, lost(f"its process was ended {ended[0]}")


def _in_pool(
    function: Callable[[TaskT], ResultT],
    tasks: Mapping[int, TaskT],
    workers: int,
    on_end: Callable[[str], object],
) -> Iterator[tuple[int, ResultT]]:
    """Yield the results of tasks by their keys, without those that are missing where it breaks.

    `on_end` takes how a process ended then: of a pool of one, the one that broke it.
    """
    # Fresh processes: forked ones would inherit locks of OpenCV's threads.
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _prepare)
    # Those of before are not ours to end.
    others = multiprocessing.active_children()
    own: list[multiprocessing.process.BaseProcess] = []
    has_broken = False
    try:
        futures = {pool.submit(function, task): key for key, task in tasks.items()}
        own = [child for child in multiprocessing.active_children() if child not in others]
        for future in as_completed(futures):
            # Taken out: a result that was given is not kept until the end.
            key = futures.pop(future)
            # Of a pool that broke, some may still have a result.
            if isinstance(future.exception(), BrokenProcessPool):
                has_broken = True
            else:
                yield key, future.result()
        if has_broken:
            on_end(_how_it_ended(own))
    except BrokenProcessPool:  # while tasks were handed over
        on_end(_how_it_ended(own))
    finally:
        for process in multiprocessing.active_children():
            if process not in others:
                # `run` takes SIGTERM for a wish to end well: it would then wait for good to hand
                # over a result that nobody reads.
                process.kill()
        # Waited for, as without its processes it ends at once: a program that ends meanwhile may
        # wake the pool's thread by a pipe that this one is closing, and would print a traceback.
        pool.shutdown(cancel_futures=True)


def _how_it_ended(processes: Sequence[multiprocessing.process.BaseProcess]) -> str:
    """Say how the first of some processes ended, in words that follow "was ended"."""
    status = status_of(processes[0]) if processes else None
    if status is None or status >= 0:
        return f"with status {status}"
    if -status == signal.SIGKILL:
        return "by SIGKILL, perhaps out of memory: fewer --workers may help"
    return f"by {signal.Signals(-status).name}, perhaps by a library that its file is too much for"


def status_of(process: multiprocessing.process.BaseProcess) -> int | None:
    """Wait for the status of a process; None where it goes on for longer than `PATIENCE`.

    Joining it is not enough: a thread of the pool waits for it too, and where that is first, the
    status is not known here until it has noted it.
    """
    end = time.monotonic() + PATIENCE
    while process.exitcode is None and time.monotonic() < end:
        time.sleep(_LOOK)
    return process.exitcode


def _prepare() -> None:
    """Compute on one thread, and end at once with Ctrl-C or when the parent is gone."""
    cv2.setNumThreads(1)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    # Returns when the parent is gone, however it ended.
    parent.join()
    os._exit(1)


def wait_or_kill(process: subprocess.Popen[bytes] | subprocess.Popen[str]) -> int:
    """Wait for a process that was asked to end, and kill it after 10 s; returns its status."""
    try:
        return process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Processes of this machine that work for this one, and end with it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import TypeAlias, TypeVar

import cv2

from vehicle_pf_tracker.core.errors import InputError

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")


PATIENCE = 10.0
"""Seconds that a child gets to end by itself: a node on a busy machine needs a few to clean up."""


def run_in_processes(
    function: Callable[[TaskT], ResultT], tasks: Sequence[TaskT], workers: int
) -> Iterator[tuple[TaskT, ResultT]]:
    """Call `function` with each task; yield every task with its result as soon as it is there.

    Parameters
    ----------
    function : callable
        Top-level function of a module, so that a process can import it.
    tasks : sequence
        Tasks in the order of their start.
    workers : int
        Number of processes.

    Raises
    ------
    InputError
        If a process is ended from outside.
    """
    # Fresh processes: forked ones would inherit locks of OpenCV's threads.
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _prepare)
    # Those of before are not ours to end.
    others = multiprocessing.active_children()
    try:
        futures = {pool.submit(function, task): task for task in tasks}
        for future in as_completed(futures):
            # Taken out: a result that was given is not kept until the end.
            yield futures.pop(future), future.result()
    except BrokenProcessPool as error:
        raise InputError(
            "a worker process was ended from outside, perhaps out of memory; "
            "run the command again to go on, with fewer --workers"
        ) from error
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in multiprocessing.active_children():
            if process not in others:
                process.terminate()


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


OnProgress: TypeAlias = Callable[[int, int | None], None]
"""Takes the numbers of runs or frames done and of all, None if unknown."""

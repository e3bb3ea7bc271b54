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

"""Work in several processes of this machine: running tasks, reporting progress, ending children."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import subprocess
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

import cv2

from vehicle_pf_tracker.core.errors import InputError

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")


@dataclass(frozen=True, slots=True)
class Turn(Generic[TaskT, ResultT]):
    """An event: a task that ended, or None where new ones began; and the tasks running now."""

    ended: tuple[TaskT, ResultT] | None
    running: tuple[TaskT, ...]


def run_in_processes(
    function: Callable[[TaskT], ResultT], tasks: Sequence[TaskT], workers: int
) -> Iterator[Turn[TaskT, ResultT]]:
    """Call `function` with each task, and give every result as soon as it is there.

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
    waiting = iter(tasks)
    # Fresh processes: forked ones would inherit locks of OpenCV's threads.
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _prepare)
    others = multiprocessing.active_children()
    running: dict[Future[ResultT], TaskT] = {}
    try:
        while True:
            for task in itertools.islice(waiting, workers - len(running)):
                running[pool.submit(function, task)] = task
            if not running:
                return
            yield Turn(None, tuple(running.values()))
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                task = running.pop(future)
                yield Turn((task, future.result()), tuple(running.values()))
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
    parent.join()
    os._exit(1)


PATIENCE = 10.0


def wait_or_kill(process: subprocess.Popen[bytes] | subprocess.Popen[str]) -> int:
    """Wait for a process that was asked to end, and kill it after 10 s; returns its status."""
    try:
        return process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


@dataclass(frozen=True, slots=True)
class Progress:
    """Runs done in this call, runs that were to be done, and what is running now."""

    done: int
    total: int
    running: tuple[str, ...]


OnProgress: TypeAlias = Callable[[Progress], None]

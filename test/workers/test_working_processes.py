# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.workers import processes
from vehicle_pf_tracker.workers.processes import run_in_processes, wait_or_kill


def answer(task):
    """Answer, or end the process as a decoder does that writes where it may not."""
    if task in (2, 7):
        os.kill(os.getpid(), signal.SIGSEGV if task == 2 else signal.SIGKILL)
    if task == 3:
        os._exit(5)
    return str(task)


def test_a_process_that_is_ended_costs_its_task_only():
    found = dict(run_in_processes(answer, range(9), 2, lambda sentence: sentence))
    assert {task: result for task, result in found.items() if task not in (2, 3, 7)} == {
        task: str(task) for task in (0, 1, 4, 5, 6, 8)
    }
    assert found[2].startswith("its process was ended by SIGSEGV, perhaps by a library")
    assert found[3] == "its process was ended with status 5"
    assert found[7] == (
        "its process was ended by SIGKILL, perhaps out of memory: fewer --workers may help"
    )


def test_of_a_pool_that_is_left_early_no_thread_goes_on():
    """Python's end would wake a thread of the pool that is closing its pipe."""
    before = threading.enumerate()
    results = run_in_processes(answer, [0, 1, 4, 5, 6, 8], 2)
    next(results)
    results.close()
    assert set(threading.enumerate()) <= set(before)


def deaf_or_dying(task):
    """Take no SIGTERM the first time, or end the process once another one does so."""
    name, deaf = task
    if name == "dying":
        while not deaf.exists():
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGKILL)
    if name == "deaf" and not deaf.exists():
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        deaf.touch()
        time.sleep(60)
    return name


def test_one_beside_it_that_takes_no_sigterm_is_not_waited_for(tmp_path, monkeypatch):
    monkeypatch.setattr(processes, "PATIENCE", 1.0)
    before = multiprocessing.active_children()
    # The pool looks anew at all its processes after a result: one of those begun later could die
    # unseen until then.
    names = ("deaf", "quick", "dying")
    tasks = [(name, tmp_path / "deaf") for name in names]
    found = dict(run_in_processes(deaf_or_dying, tasks, 3, lambda sentence: sentence))
    deaf, quick, dying = (found[task] for task in tasks)
    assert (deaf, quick) == ("deaf", "quick")
    assert "ended by SIGKILL" in dying
    left = [one for one in multiprocessing.active_children() if one not in before]
    for one in left:
        one.join(10)
    assert not any(one.is_alive() for one in left)


class ReapedElsewhere:
    """A process whose status another thread has taken, and notes after some looks."""

    def __init__(self):
        self._statuses = iter([None, None, -signal.SIGKILL, -signal.SIGKILL])

    @property
    def exitcode(self):
        return next(self._statuses)


def test_a_status_that_the_pool_took_first_is_waited_for():
    assert processes.status_of(ReapedElsewhere()) == -signal.SIGKILL


def test_without_a_result_for_it_the_end_of_a_process_is_an_error():
    with pytest.raises(InputError, match="a worker process was ended from outside"):
        list(run_in_processes(answer, [2], 1))


def test_one_that_ends_gives_its_status():
    process = subprocess.Popen([sys.executable, "-c", "raise SystemExit(3)"])
    assert wait_or_kill(process) == 3


def test_one_that_will_not_end_is_killed(monkeypatch):
    monkeypatch.setattr(processes, "PATIENCE", 0.1)
    deaf = (
        "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN);"
        "print('deaf', flush=True); signal.pause()"
    )
    with subprocess.Popen([sys.executable, "-c", deaf], stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"deaf\n"
        process.terminate()
        assert wait_or_kill(process) == -signal.SIGKILL

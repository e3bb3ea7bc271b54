# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A real Dask scheduler, and real workers in folders of their own."""

import atexit
import os
import sys
import time
from contextlib import ExitStack, contextmanager
from functools import cache

import pytest
from loaded_python import LoadedPython

distributed = pytest.importorskip("distributed")

WAIT = 60
"""Seconds until a test gives up on processes that start on a busy machine."""
LOADED = (
    "distributed.cli.dask_scheduler",
    "distributed.cli.dask_worker",
    "vehicle_pf_tracker.cli.run",
    "vehicle_pf_tracker.evaluation.grid.running",
)
"""Modules that the processes are forked with."""


def environment():
    """Return the environment of Dask's processes."""
    return {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(sys.path),
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "3",
    }


@cache
def dask_python():
    """The process that they are forked from, which ends with the tests."""
    python = LoadedPython(LOADED, environment())
    atexit.register(python.close)
    return python


@contextmanager
def process(module, folder, *words):
    """Give a process of Dask's in a folder of its own, ended with the block, and what it prints."""
    folder.mkdir(parents=True)
    code = f"from distributed.cli.{module} import main; main()"
    read, write = os.pipe()
    with os.fdopen(read, "rb") as printed:
        with os.fdopen(write, "wb") as output:
            child = dask_python().run(
                code, ["--no-dashboard", *words], environment(), output, output, folder
            )
        try:
            yield child, printed
        finally:
            child.kill()
            child.wait()


@contextmanager
def scheduler(folder):
    """Give the address of a scheduler, and its process."""
    words = ("--port", "0", "--host", "127.0.0.1")
    with process("dask_scheduler", folder, *words) as (child, printed):
        for line in printed:
            if b"Scheduler at:" in line:
                break
        yield line.split()[-1].decode(), child


@contextmanager
def workers(address, folder, count):
    """Give the processes of workers that the scheduler knows."""
    with ExitStack() as stack:
        words = (address, "--nthreads", "1", "--no-nanny")
        children = [
            stack.enter_context(process("dask_worker", folder / f"worker_{number}", *words))[0]
            for number in range(count)
        ]
        with distributed.Client(address, timeout=WAIT, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=WAIT)
        yield children


def wait_until_missed(address):
    """Wait until the scheduler knows of no worker."""
    deadline = time.monotonic() + WAIT
    with distributed.Client(address, timeout=WAIT, set_as_default=False) as client:
        while client.nthreads():
            assert time.monotonic() < deadline, "the scheduler still has workers"
            time.sleep(0.02)

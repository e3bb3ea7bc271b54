# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A real Dask scheduler, and real workers in folders of their own."""

import os
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest

distributed = pytest.importorskip("distributed")

WAIT = 60
"""Seconds until a test gives up on processes that start on a busy machine."""


@contextmanager
def process(module, folder, *words):
    """A process of Dask's in a folder of its own, ended with the block."""
    folder.mkdir(parents=True)
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(sys.path),
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "3",
    }
    command = [sys.executable, "-m", f"distributed.cli.{module}", "--no-dashboard", *words]
    child = subprocess.Popen(command, cwd=folder, env=environment, stderr=subprocess.PIPE)
    try:
        yield child
    finally:
        child.kill()
        child.communicate()


@contextmanager
def scheduler(folder):
    """Give the address of a scheduler, and its process."""
    words = ("--port", "0", "--host", "127.0.0.1")
    with process("dask_scheduler", folder, *words) as child:
        for line in child.stderr:
            if b"Scheduler at:" in line:
                break
        yield line.split()[-1].decode(), child


@contextmanager
def workers(address, folder, count):
    """Give the processes of workers that the scheduler knows."""
    with ExitStack() as stack:
        words = (address, "--nthreads", "1", "--no-nanny")
        children = [
            stack.enter_context(process("dask_worker", folder / f"worker_{number}", *words))
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

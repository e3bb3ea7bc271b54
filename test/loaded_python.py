# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A Python that has loaded some modules, and runs each `-c CODE` in a fork of its own.

To load the package, ROS or Dask takes more of a processor than most of what the tests then ask of
a process. Nothing is shared but code: each fork has its own ROS context, threads, signals,
environment, output and exit status. Run as a program, this module is that Python.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import types
import warnings
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import IO, Any

LARGEST = 1 << 17
"""Bytes of a request: code, arguments and environment."""


class Forked:
    """A fork, with what `subprocess.Popen` offers of a process."""

    def __init__(self, reports: int) -> None:
        self._reports = os.fdopen(reports, "rb", buffering=0)
        self.pid = int(self._reports.read(12))
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """Return the exit status, None while it runs."""
        return self._status(0.0)

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the exit status."""
        status = self._status(timeout)
        if status is None:
            raise subprocess.TimeoutExpired("fork", timeout or 0.0)
        return status

    def send_signal(self, number: int) -> None:
        """Send it a signal, if it runs."""
        if self.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def terminate(self) -> None:
        """Ask it to end, if it runs."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """End it, if it runs."""
        self.send_signal(signal.SIGKILL)

    def _status(self, timeout: float | None) -> int | None:
        if self.returncode is None and select.select([self._reports], [], [], timeout)[0]:
            self.returncode = int(self._reports.read(12))
            self._reports.close()
        return self.returncode


class LoadedPython:
    """The process that forks, from the side of the tests.

    Parameters
    ----------
    modules : sequence of str
        What it loads; none of them may start a thread.
    environment : dict
        Its own environment, in which they are loaded.
    """

    def __init__(self, modules: Sequence[str], environment: dict[str, str]) -> None:
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with other:
            command = [sys.executable, __file__, str(other.fileno()), *modules]
            self._process = subprocess.Popen(command, env=environment, pass_fds=[other.fileno()])

    def run(
        self,
        code: str,
        arguments: Sequence[str],
        environment: dict[str, str],
        output: IO[Any],
        errors: IO[Any],
        folder: Path | None = None,
    ) -> Forked:
        """Run `python -c CODE ARGUMENTS` in `folder`, printing to two open files."""
        reports, write = os.pipe()
        request = [code, [*arguments], environment, str(folder or Path.cwd())]
        files = [output.fileno(), errors.fileno(), write]
        socket.send_fds(self._socket, [json.dumps(request).encode()], files)
        os.close(write)
        return Forked(reports)

    def close(self) -> None:
        """Let it end, so that the time of its forks counts as the tests' own."""
        self._socket.close()
        self._process.wait()


def _next_in_a_fork(requests: socket.socket) -> tuple[str, list[str]] | None:
    """Fork for each request; return its code and arguments in the fork, None at the end."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        data, files, _, _ = socket.recv_fds(requests, LARGEST, 3)
        if not data:
            with contextlib.suppress(ChildProcessError):
                while True:
                    os.wait()
            return None
        output, errors, reports = files
        if os.fork() == 0:
            requests.close()
            _report(reports)
            signal.signal(signal.SIGINT, before)
            os.dup2(output, 1)
            os.dup2(errors, 2)
            os.close(output)
            os.close(errors)
            code, arguments, environment, folder = json.loads(data)
            os.environ.clear()
            os.environ.update(environment)
            os.chdir(folder)
            return code, arguments
        for file in files:
            os.close(file)


def _report(reports: int) -> None:
    """Fork again, tell the fork's number and then its exit status; return in the fork only."""
    child = os.fork()
    if child == 0:
        os.close(reports)
        return
    os.write(reports, b"%12d" % child)
    _, status = os.waitpid(child, 0)
    os.write(reports, b"%12d" % os.waitstatus_to_exitcode(status))
    os._exit(0)


def _main() -> None:
    requests = socket.socket(fileno=int(sys.argv[1]))
    for name in sys.argv[2:]:
        import_module(name)
    with warnings.catch_warnings():
        # Python 3.12 warns of a fork beside threads: here those of BLAS, which it ends for a fork.
        warnings.simplefilter("ignore", DeprecationWarning)
        request = _next_in_a_fork(requests)
    if request is not None:
        code, arguments = request
        sys.argv = ["-c", *arguments]
        sys.path[0] = ""
        module = types.ModuleType("__main__")
        sys.modules["__main__"] = module
        exec(compile(code, "<string>", "exec"), module.__dict__)


if __name__ == "__main__":
    _main()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Process of a `baseline_worker`, in an environment that has the trackers to compare with."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.workers.processes import wait_or_kill

BASELINES_VARIABLE = "VEHICLE_PF_TRACKER_BASELINES"
"""Environment variable that names the interpreter."""

DEFAULT_INTERPRETER = Path(".venv-baselines/bin/python")
"""Interpreter that `make baselines` builds in a clone, below the working directory."""

BASELINES_LOCK = Path(__file__).with_name("baselines.txt")
"""Lock file of their environment: exact versions, with hashes."""

WORKER = Path(__file__).with_name("baseline_worker.py")
"""Program that runs in their environment, as a file: this package is not installed there."""
Self = TypeVar("Self", bound="Worker")


def baseline_python(chosen: Path | None = None) -> Path:
    """Find the interpreter that has the trackers to compare with.

    Parameters
    ----------
    chosen : Path or None
        The user's choice; None takes what `BASELINES_VARIABLE` names, else
        `DEFAULT_INTERPRETER`, else the one in the user's cache, which the command in the error
        builds.

    Raises
    ------
    InputError
        If there is no such file.
    """
    named = chosen or os.environ.get(BASELINES_VARIABLE)
    cached = _cache() / "bin" / "python"
    for python in [Path(named)] if named else [DEFAULT_INTERPRETER, cached]:
        if python.is_file():
            return python.absolute()  # not resolved: a link is what makes it the environment's
    raise InputError(
        f"there is no interpreter {named or cached} to run the baselines with; build it once with "
        f"`{install_command()}`, or name one in the environment variable {BASELINES_VARIABLE}"
    )


def install_command() -> str:
    """Return the one command that builds the environment of the baselines in the user's cache."""
    folder, lock = (shlex.quote(str(path)) for path in (_cache(), BASELINES_LOCK))
    pip = f"{folder}/bin/python -m pip install --no-deps --requirement {lock}"
    return f"python3 -m venv {folder} && {pip}"


def _cache() -> Path:
    root = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(root, "vehicle_pf_tracker", "baselines")


class Worker:
    """A process of `baseline_worker`; a context manager.

    Parameters
    ----------
    subject : str
        Name of what the worker runs, for errors, such as ``the baseline csrt``.
    python : Path or None
        Interpreter of the environment; None looks where `baseline_python` says.
    words : sequence of str
        Arguments of the worker.

    Attributes
    ----------
    versions : dict of str to str
        Versions of the libraries, by name.

    Raises
    ------
    InputError
        If it cannot be run, ends, or begins with an error.
    """

    def __init__(self, subject: str, python: Path | None, words: Sequence[str]) -> None:
        self._subject = subject
        self._python = str(baseline_python(python))
        # A file, as nobody reads it while it works: a full pipe would stop the worker.
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process
        try:
            # Isolated (-I): this process's PYTHONPATH must not bring its OpenCV into that
            # environment.
            command = [self._python, "-I", str(WORKER), *words]
            pipe = subprocess.PIPE
            self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=self._log)
        except OSError as error:
            self._log.close()
            raise InputError(f"cannot run {self._python}: {error.strerror}") from error
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._requests = self._process.stdin
        self._answers = self._process.stdout
        try:
            self.versions: dict[str, str] = self._answer()
        # Also where a user interrupts: no process is left behind.
        except BaseException:
            self.close()
            raise

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *failure: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process."""
        with contextlib.suppress(BrokenPipeError):  # it died; what was under way is lost
            self._requests.close()
        wait_or_kill(self._process)
        self._answers.close()
        self._log.close()

    def _ask(self, request: Mapping[str, object], pixels: Frame | None = None) -> Any:
        """Send a request, and `pixels` after it; return the answer."""
        try:
            self._requests.write(json.dumps(request).encode() + b"\n")
            if pixels is not None:
                self._requests.write(pixels.data)
            self._requests.flush()
        except BrokenPipeError:
            raise self._death() from None
        return self._answer()

    def _answer(self) -> Any:
        line = self._answers.readline()
        if not line:
            raise self._death()
        answer = json.loads(line)
        if "error" in answer:
            raise InputError(f"{self._subject} cannot go on: {answer['error']}")
        return answer

    def _death(self) -> InputError:
        # The last line of a traceback is its reason.
        status = self._process.wait()
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").strip().splitlines()
        reason = lines[-1] if lines else f"status {status}"
        return InputError(
            f"{self._subject}, run by {self._python}, ended: {reason}; "
            "`make baselines` builds an environment that has what is needed"
        )

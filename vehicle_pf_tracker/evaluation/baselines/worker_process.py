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

"""A worker in a process and an environment of its own, which answers a line of JSON with one."""

from __future__ import annotations

import contextlib
import json
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.processes import wait_or_kill


class WorkerProcess:
    """Process of a worker, and the conversation with it.

    Parameters
    ----------
    subject : str
        Name of what the worker runs, for errors, such as ``the baseline csrt``.
    python : Path
        Interpreter of the environment.
    script : Path
        The worker's file.
    words : sequence of str
        Its arguments.

    Attributes
    ----------
    greeting : dict
        The answer that it begins with.

    Raises
    ------
    InputError
        If it cannot be run, ends, or begins with an error.
    """

    def __init__(self, subject: str, python: Path, script: Path, words: Sequence[str] = ()) -> None:
        self._subject, self._python = subject, str(python)
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process
        try:
            self._process = subprocess.Popen(
                [self._python, "-I", str(script), *words],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._log,
            )
        except OSError as error:
            self._log.close()
            raise InputError(f"cannot run {self._python}: {error.strerror}") from error
        try:
            self.greeting = self._answer()
        except BaseException:
            self.close()
            raise

    def ask(self, request: Mapping[str, object], pixels: Frame | Array | None = None) -> Any:
        """Send a request, and `pixels` after it; return the answer.

        Raises
        ------
        InputError
            If the answer is an error, or the worker has ended.
        """
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(request).encode() + b"\n")
            if pixels is not None:
                self._process.stdin.write(pixels.data)
            self._process.stdin.flush()
        except BrokenPipeError:
            raise self._death() from None
        return self._answer()

    def close(self) -> None:
        """End the process."""
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # it died; what was under way is lost
            self._process.stdin.close()
        wait_or_kill(self._process)
        if self._process.stdout is not None:
            self._process.stdout.close()
        self._log.close()

    def _answer(self) -> Any:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise self._death()
        answer = json.loads(line)
        if "error" in answer:
            raise InputError(f"{self._subject} cannot go on: {answer['error']}")
        return answer

    def _death(self) -> InputError:
        status = self._process.wait()
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").strip().splitlines()
        reason = lines[-1] if lines else f"status {status}"
        return InputError(
            f"{self._subject}, run by {self._python}, ended: {reason}; "
            "`make baselines` builds an environment that has what is needed"
        )

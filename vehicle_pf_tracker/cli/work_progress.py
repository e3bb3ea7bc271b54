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

"""Progress of many runs: the runs done, those running, and the time left."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as Bar

from vehicle_pf_tracker.cli.console import LineClock
from vehicle_pf_tracker.offline.processes import OnProgress, Progress

_SHOWN = 4


@contextmanager
def telling(
    name: str, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
) -> Iterator[OnProgress]:
    """Return a function that reports the progress of the work `name`.

    Parameters
    ----------
    name : str
        What is run.
    stream : text stream or None
        Where to show it; None is standard error.
    clock : callable
        The monotonic clock in s.
    """
    stream = stream or sys.stderr
    began = clock()
    if not stream.isatty():
        yield _WorkLines(name, stream, clock)
        return
    columns = (
        TextColumn(name),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[more]}"),
    )
    with Bar(*columns, console=Console(file=stream), transient=True) as bar:
        task = bar.add_task(name, total=None, more="")

        def show(progress: Progress) -> None:
            more = f"{_left(progress, clock() - began)}  {_running(progress)}"
            bar.update(task, completed=progress.done, total=progress.total, more=more)

        yield show


@contextmanager
def stages(
    name: str, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
) -> Iterator[Callable[[str], None]]:
    """Return a function that shows the present stage of the work `name`, a few words."""
    stream = stream or sys.stderr
    if stream.isatty():
        with Console(file=stream).status(name) as status:
            yield lambda words: status.update(f"{name}: {words}")
        return
    due = LineClock(clock())

    def show(words: str) -> None:
        if due.is_due(clock()):
            print(f"{name}: {words}", file=stream, flush=True)

    yield show


class _WorkLines:
    def __init__(self, name: str, stream: TextIO, clock: Callable[[], float]) -> None:
        self._name = name
        self._stream = stream
        self._clock = clock
        self._began = clock()
        self._due = LineClock(self._began)

    def __call__(self, progress: Progress) -> None:
        now = self._clock()
        if not self._due.is_due(now):
            return
        running = f"; running {_running(progress)}" if progress.running else ""
        left = _left(progress, now - self._began)
        print(
            f"{self._name}: {progress.done} of {progress.total} runs done, {left}{running}",
            file=self._stream, flush=True,
        )  # fmt: skip


def _running(progress: Progress) -> str:
    beyond = len(progress.running) - _SHOWN
    more = [f"{beyond} more"] if beyond > 0 else []
    return ", ".join([*progress.running[:_SHOWN], *more])


def _left(progress: Progress, seconds: float) -> str:
    if progress.done == 0:
        return "time left unknown"
    left = seconds * (progress.total - progress.done) / progress.done
    return f"about {left:.0f} s left" if left < 100 else f"about {left / 60:.0f} min left"

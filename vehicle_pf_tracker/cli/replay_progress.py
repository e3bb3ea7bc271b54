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

"""Progress of a replay: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, TextIO

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from vehicle_pf_tracker.cli.progress import LineClock

if TYPE_CHECKING:
    from vehicle_pf_tracker.ros.replay.replay_options import Progress as ReplayProgress


@contextmanager
def progress_view(
    stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
) -> Iterator[Callable[[ReplayProgress], None]]:
    """Return a function that reports the progress of the replay.

    Parameters
    ----------
    stream : text stream or None
        Where to show it; None is standard error.
    clock : callable
        The monotonic clock in s.
    """
    stream = stream or sys.stderr
    if not stream.isatty():
        yield _Lines(stream, clock)
        return
    columns = (
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %  {task.fields[frames]} frames  {task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(file=stream)) as bar:
        yield _Bar(bar, clock)


class _Bar:
    """A bar that appears with the first image."""

    def __init__(self, bar: Progress, clock: Callable[[], float]) -> None:
        self._bar = bar
        self._clock = clock
        self._began = clock()
        self._task = bar.add_task("replay", total=None, frames=0, rate="")

    def __call__(self, progress: ReplayProgress) -> None:
        if progress.frames == 1:
            self._began = self._clock()
        self._bar.update(
            self._task,
            completed=progress.position,
            total=progress.length,
            frames=progress.frames,
            rate=_rate(progress, self._clock() - self._began),
        )


class _Lines:
    def __init__(self, stream: TextIO, clock: Callable[[], float]) -> None:
        self._stream = stream
        self._clock = clock
        self._began = self._pass_began = clock()
        self._due = LineClock(self._began)
        self._position = 0.0

    def __call__(self, progress: ReplayProgress) -> None:
        now = self._clock()
        if progress.frames == 1:
            self._began = self._pass_began = now
            self._due = LineClock(now)
        if progress.position < self._position:  # a loop begins again
            self._pass_began = now
        self._position = progress.position
        if self._due.is_due(now):
            print(self._line(progress, now), file=self._stream, flush=True)

    def _line(self, progress: ReplayProgress, now: float) -> str:
        line = f"{progress.frames} frames, {_rate(progress, now - self._began)}"
        if not progress.position:
            return line
        share = progress.position / progress.length
        left = (now - self._pass_began) * (1 / share - 1)
        return f"{share:4.0%}, {line}, {left:.0f} s left"


def _rate(progress: ReplayProgress, elapsed: float) -> str:
    return f"{(progress.frames - 1) / elapsed:.1f} frames/s" if elapsed > 0 else ""

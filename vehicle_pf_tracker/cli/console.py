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

"""Output of the verbs: results on stdout, everything else on stderr.

Progress of work that is counted: a bar on a terminal, plain lines elsewhere.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, TextIO, TypeAlias

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from vehicle_pf_tracker.evaluation.tables import Comparison

PROGRAM = "vehicle-pf-tracker"
FAILED, USAGE, INTERRUPTED, PIPE_CLOSED = 1, 2, 130, 141
"""Exit statuses; the last two are those of a program that a signal ended."""
_WIDE = 200
"""Columns of a table that is written to a file or a pipe, where lines may be long."""


class UsageError(Exception):
    """Error in the command line itself; the program ends with status 2."""


def tell_error(sentence: str, program: str = PROGRAM) -> None:
    """Print an error as one line on stderr."""
    print(f"{program}: error: {' '.join(sentence.split())}", file=sys.stderr, flush=True)


def tell_notices(sentences: Iterable[str]) -> None:
    """Print notices on stderr, one per line."""
    for sentence in sentences:
        print(f"{PROGRAM}: note: {sentence}", file=sys.stderr, flush=True)


def show(table: Comparison) -> None:
    """Print a table on stdout."""
    print_rows(*table.texts())


def print_rows(headings: Iterable[str], rows: Iterable[Iterable[str]], title: str = "") -> None:
    """Print cells as a table on stdout; nothing in them is markup."""
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title or None)
    for number, heading in enumerate(headings):
        table.add_column(Text(heading), justify="right" if number else "left")
    for row in rows:
        table.add_row(*map(Text, row))
    print_table(table)


def print_table(table: RichTable) -> None:
    """Print a table on stdout; not wrapped where that is not a terminal."""
    from rich.console import Console

    console = Console()
    if not console.is_terminal:
        console = Console(width=_WIDE)
    console.print(table)


def megabytes(count: int) -> str:
    """Return a number of bytes for people: two digits, and more above 100 MB."""
    size = count / 1e6
    return f"{size:.0f} MB" if size >= 100 else f"{float(f'{size:.2g}'):g} MB"


OnProgress: TypeAlias = Callable[[int, int | None], None]
_FIRST_SECONDS, _LINE_SECONDS = 2.0, 5.0
"""Seconds before the first plain line and between two: quick work prints none, and long work does
not fill a log."""


class LineClock:
    """Tells when a plain line of progress is due.

    Parameters
    ----------
    now : float
        Time at which the work begins, s.
    """

    def __init__(self, now: float) -> None:
        self._next = now + _FIRST_SECONDS

    def is_due(self, now: float) -> bool:
        """Return whether a line is due; the next one is later then."""
        if now < self._next:
            return False
        self._next = now + _LINE_SECONDS
        return True


@contextmanager
def counting(
    verb: str, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic
) -> Iterator[OnProgress]:
    """Return a function that takes the numbers of frames done and of all (None if unknown).

    Parameters
    ----------
    verb : str
        What is done to them, as in ``tracked``.
    stream : text stream or None
        Where to show it; None is standard error.
    clock : callable
        The monotonic clock in s.
    """
    stream = stream or sys.stderr
    if not stream.isatty():
        yield _Lines(verb, stream, clock)
        return
    columns = (TextColumn(verb), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(file=stream), transient=True) as bar:
        task = bar.add_task(verb, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


class _Lines:
    def __init__(self, verb: str, stream: TextIO, clock: Callable[[], float]) -> None:
        self._verb = verb
        self._stream = stream
        self._clock = clock
        self._due = LineClock(clock())

    def __call__(self, done: int, total: int | None) -> None:
        if not self._due.is_due(self._clock()):
            return
        of_all = "" if total is None else f" of {total}"
        print(f"{self._verb} {done}{of_all} frames", file=self._stream, flush=True)

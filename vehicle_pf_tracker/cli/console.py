# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Output of the verbs: results on stdout, everything else on stderr."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from vehicle_pf_tracker.core.addresses import without_passwords
from vehicle_pf_tracker.core.progress import ShowCount, ShowShare

PROGRAM_NAME = "vehicle-pf-tracker"
"""Name of the program, as it is typed."""
# Exit statuses: the first two by custom; the last two as shells have them for a program that
# SIGINT (2) or SIGPIPE (13) ended, 128 more than the signal's number.
FAILED = 1
USAGE_STATUS = 2
INTERRUPTED = 130
PIPE_CLOSED = 141
_WIDE = 200
"""Columns of a table that is written to a file or a pipe, where lines may be long."""
_FIRST_SECONDS = 2.0
"""Seconds before the first plain line of progress: quick work prints none."""
_LINE_SECONDS = 5.0
"""Seconds between two lines of progress: a log of an hour has 720 of them."""


class UsageError(Exception):
    """Error in the command line itself; the program ends with status 2."""


def tell_error(sentence: str, program: str = PROGRAM_NAME) -> None:
    """Print an error as one line on stderr."""
    words = " ".join(without_passwords(sentence).split())
    print(f"{program}: error: {words}", file=sys.stderr, flush=True)


def tell_notice(sentence: str) -> None:
    """Print a notice as one line on stderr."""
    print(f"{PROGRAM_NAME}: note: {without_passwords(sentence)}", file=sys.stderr, flush=True)


def tell_notices(sentences: Iterable[str]) -> None:
    """Print notices on stderr, one per line."""
    for sentence in sentences:
        tell_notice(sentence)


def print_rows(headings: Iterable[str], rows: Iterable[Iterable[str]], title: str = "") -> None:
    """Print cells as a table on stdout; nothing in them is markup.

    Where stdout is no terminal, its lines are not wrapped.
    """
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title or None)
    for number, heading in enumerate(headings):
        table.add_column(Text(heading), justify="right" if number else "left")
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console()
    if not console.is_terminal:
        console = Console(width=_WIDE)
    console.print(table)


@contextmanager
def shown_progress() -> Iterator[ShowShare]:
    """Return a function that shows progress: as a bar on a terminal, as plain lines elsewhere."""
    if not sys.stderr.isatty():
        next_line = time.monotonic() + _FIRST_SECONDS

        def print_line(words: str, share: float | None) -> None:
            nonlocal next_line
            if time.monotonic() >= next_line:
                next_line = time.monotonic() + _LINE_SECONDS
                print(words, file=sys.stderr, flush=True)

        yield print_line
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    words_column = TextColumn("{task.description}", markup=False)
    columns = BarColumn(), words_column, TimeRemainingColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)

        def move_bar(words: str, share: float | None) -> None:
            total = None if share is None else 1.0
            bar.update(task, completed=share, total=total, description=words)

        yield move_bar


@contextmanager
def counting(verb: str, noun: str = "frames") -> Iterator[ShowCount]:
    """Return a function that shows how many frames or runs are done; `verb` is a participle."""
    with shown_progress() as show:

        def count(done: int, total: int | None) -> None:
            if total:
                show(f"{verb} {done} of {total} {noun}", done / total)
            else:
                show(f"{verb} {done} {noun}", None)

        yield count


@contextmanager
def stages(name: str) -> Iterator[Callable[[str], None]]:
    """Return a function that shows the present stage of a work."""
    with shown_progress() as show:
        yield lambda stage: show(f"{name}: {stage}", None)

"""What the verbs say to people, and where: results on stdout, everything else on stderr."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from vehicle_pf_tracker.evaluation.tables import Comparison

PROGRAM = "vehicle-pf-tracker"
_WIDE = 200
"""Columns of a table that is written to a file or a pipe, where lines may be long."""


class UsageError(Exception):
    """The command line lacks something that no file could give; ends with status 2."""


def tell_error(sentence: str, program: str = PROGRAM) -> None:
    """Say why nothing came of it, in one line."""
    print(f"{program}: error: {' '.join(sentence.split())}", file=sys.stderr, flush=True)


def tell_notices(sentences: Iterable[str]) -> None:
    """Say what was not as it should be, a line each."""
    for sentence in sentences:
        print(f"{PROGRAM}: note: {sentence}", file=sys.stderr, flush=True)


def show(table: Comparison) -> None:
    """Print a table on stdout."""
    print_table(table.to_rich())


def print_table(table: RichTable) -> None:
    """Print a table on stdout; as wide as it is where that is no terminal."""
    from rich.console import Console

    console = Console()
    if not console.is_terminal:
        console = Console(width=_WIDE)
    console.print(table)

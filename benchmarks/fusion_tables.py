"""Cells and lines of the tables of docs/fusion.md."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Sequence

from benchmarks.fusion_runs import Run

NOTHING = "–"


def header(first: str, others: Sequence[str]) -> str:
    """Two lines: the titles, of which the others stand over numbers, and the rule."""
    return f"{line([first, *others])}\n{line(['---', *['---:'] * len(others)])}"


def line(cells: Sequence[str]) -> str:
    """One line of a table."""
    return f"| {' | '.join(cells)} |"


def spread(
    values: Iterable[float | None],
    digits: int,
    middle: Callable[[Sequence[float]], float] = statistics.fmean,
) -> str:
    """Middle of the values, the least and the most behind it where they differ to the eye."""
    known = [value for value in values if value is not None]
    if not known:
        return NOTHING
    low, high = (f"{one:.{digits}f}" for one in (min(known), max(known)))
    text = f"{middle(known):.{digits}f}"
    return text if low == high else f"{text} ({low}-{high})"


def hits(verdicts: Iterable[bool | None]) -> str:
    """How many of the verdicts that could be given are true."""
    known = [one for one in verdicts if one is not None]
    return f"{sum(known)} of {len(known)}" if known else NOTHING


def recoveries(runs: Sequence[Run]) -> list[str]:
    """Two cells: occlusions recovered from, and runs in which that was all of them."""
    return [
        hits(one for run in runs for one in run.recovered),
        hits(run.all_recovered for run in runs),
    ]


def claims(runs: Sequence[Run]) -> list[str]:
    """Three cells on how true the mode is: hidden, clear, longest false run."""
    return [
        spread((run.hidden for run in runs), 2),
        spread((run.clear for run in runs), 2),
        str(max(run.false_run for run in runs)),
    ]


CLAIMS = ("hidden", "clear", "false run")
RECOVERIES = ("recovered", "runs with all")

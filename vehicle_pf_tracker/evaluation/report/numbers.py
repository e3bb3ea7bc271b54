"""Numbers as people read them."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.evaluation.report.columns import Column
from vehicle_pf_tracker.evaluation.statistics.intervals import Summary

NOTHING = "–"


def number(value: float | None, decimals: int) -> str:
    """Return a number with so many decimals, a dash for None."""
    return NOTHING if value is None else f"{value:.{decimals}f}"


def mean(summary: Summary | None, column: Column) -> str:
    """Return the mean alone."""
    return number(summary.mean if summary else None, column.decimals)


def mean_and_spread(summary: Summary | None, column: Column) -> str:
    """Return the mean, and the standard deviation where there is one that shows."""
    text = mean(summary, column)
    if summary is None or not summary.spread:
        return text
    return f"{text} ± {number(summary.spread, column.decimals)}"


def interval(summary: Summary | None, column: Column) -> str:
    """Return the interval as ``low to high``; empty where there is none."""
    if summary is None or summary.low is None or summary.high is None:
        return ""
    return f"{number(summary.low, column.decimals)} to {number(summary.high, column.decimals)}"


def p_value(value: float | None) -> str:
    """Return a p value as it is usually printed."""
    if value is None:
        return NOTHING
    return "< 0.001" if value < 0.001 else f"{value:.3f}"


def listing(names: Sequence[str]) -> str:
    """Return ``a``, ``a and b``, or ``a, b and c``."""
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


def counted(count: int, noun: str) -> str:
    """Return ``1 frame``, ``2 frames``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"

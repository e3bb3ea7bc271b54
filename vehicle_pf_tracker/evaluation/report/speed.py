"""The speed that was measured in a serial pass of its own (`timings.json`)."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from typing import Any

from vehicle_pf_tracker.evaluation.report import numbers
from vehicle_pf_tracker.evaluation.report.page_tables import Header, PageTable, Row, TableCell


def speed_table(
    timings: Mapping[str, Any] | None, order: Sequence[str], slots: Mapping[str, int]
) -> PageTable | None:
    """Make a table of step times; None where they were not measured.

    Parameters
    ----------
    timings : mapping or None
        ``{"clock", "cells": [{"recording", "system", "step_ms_p50", "step_ms_p95"}, ...]}``.
    order : sequence of str
        The systems.
    slots : mapping of str to int
        Numbers of their styles.
    """
    cells = list((timings or {}).get("cells", []))
    rows = []
    for label in order:
        own = [cell for cell in cells if cell["system"] == label]
        medians = [cell["step_ms_p50"] for cell in own if cell.get("step_ms_p50") is not None]
        slow = [cell["step_ms_p95"] for cell in own if cell.get("step_ms_p95") is not None]
        if not medians:
            continue
        middle = statistics.fmean(medians)
        late = statistics.fmean(slow) if slow else None
        shown = (
            _cell(middle, 2),
            _cell(late, 2),
            _cell(max(medians), 2),
            _cell(1000.0 / middle if middle > 0 else None, 0),
        )
        rows.append(Row(label, slots.get(label), shown))
    headers = (
        Header("step, median", "ms", "Mean over the recordings of the median step."),
        Header(
            "step, 95 %", "ms", "Mean over the recordings of the time 95 % of steps stay below."
        ),
        Header("slowest recording", "ms", "The largest median of any recording."),
        Header("rate", "frames/s", "One second over the mean median step."),
    )
    return PageTable((), headers, tuple(rows)) if rows else None


def speed_note(timings: Mapping[str, Any] | None) -> str:
    """Say what was measured, and on what."""
    clock = (timings or {}).get("clock", "time of a step")
    processor = " with ".join(map(str, (timings or {}).get("processor", []) or ["unknown"]))
    return (
        f"Measured in a serial pass of its own: {clock}. Processor: {processor} cores. "
        "Compare systems by their ratios; other machines have other times."
    )


def _cell(value: float | None, decimals: int) -> TableCell:
    return TableCell(numbers.number(value, decimals), value)

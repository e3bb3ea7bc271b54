# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables of results: text for a terminal, Markdown and a page."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.columns import (
    BESIDE_RESTARTS,
    COMPARED_METRICS,
    METRIC_COLUMNS,
    NO_VALUE,
    RECOVERED,
    RESTARTS,
    Column,
    number_text,
)
from vehicle_pf_tracker.evaluation.occlusion_scores import OcclusionScore
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates, Summaries
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredRun
from vehicle_pf_tracker.evaluation.statistics import Summary

NO_SCORE = "-"
"""Sign of a value that does not exist, in tables that programs may read."""
Rows: TypeAlias = list[list[str]]
"""Words of the cells, row by row."""


def mean_text(summary: Summary | None, column: Column) -> str:
    """Return the mean alone."""
    return number_text(summary.mean if summary else None, column.decimals)


def mean_and_spread_text(summary: Summary | None, column: Column) -> str:
    """Return the mean, and the standard deviation where there is one that shows."""
    text = mean_text(summary, column)
    if summary is None or not summary.spread:
        return text
    return f"{text} ± {number_text(summary.spread, column.decimals)}"


def interval_text(summary: Summary | None, column: Column) -> str:
    """Return the interval as ``low to high``; empty where there is none."""
    if summary is None or summary.low is None or summary.high is None:
        return ""
    low, high = (number_text(end, column.decimals) for end in (summary.low, summary.high))
    return f"{low} to {high}"


def counted(count: int, noun: str) -> str:
    """Return ``1 frame``, ``2 frames``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Make a Markdown table: the first column to the left, numbers to the right."""
    ruled = [header, ["---", *("---:" for _ in header[1:])], *rows]
    return "".join(
        f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |\n" for row in ruled
    )


@dataclass(frozen=True, slots=True)
class Header:
    """A heading: its text, its unit, one sentence, and how many columns it spans."""

    text: str
    unit: str = ""
    note: str = ""
    span: int = 1


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell.

    Attributes
    ----------
    text : str
        Text of the cell.
    value : float or None
        Value it sorts by; None goes last.
    best : bool
        True if no other in its column is better.
    note : str
        Note shown on demand.
    """

    text: str
    value: float | None = None
    best: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of systems: its headings, and the cells of each system.

    `groups` spans the `headers`, and may be empty.
    """

    headers: Sequence[Header]
    rows: Mapping[str, Sequence[TableCell]]
    groups: Sequence[Header] = ()

    def texts(self) -> tuple[list[str], Rows]:
        """Return the headings with their units, and the text of all rows."""
        titles = [f"{h.text}, {h.unit}" if h.unit else h.text for h in self.headers]
        rows = [[label, *(cell.text for cell in cells)] for label, cells in self.rows.items()]
        return ["system", *titles], rows


def overall_table(aggregates: Aggregates, keys: Collection[str] | None = None) -> Table:
    """Show metrics, all if `keys` is None, as means over the recordings.

    Recoveries are counted over all runs.
    """

    def text(label: str, summary: Summary | None, column: Column) -> str:
        recovered, judged = aggregates.recoveries[label]
        is_count = column is RECOVERED and judged
        return f"{recovered} of {judged}" if is_count else mean_text(summary, column)

    # In the order of `METRIC_COLUMNS`, whatever that of the keys.
    columns = [column for column in METRIC_COLUMNS if keys is None or column.key in keys]
    return _metrics_table(aggregates.overall, columns, text)


def restarts_table(aggregates: Aggregates) -> Table | None:
    """Show the metrics of the runs with restarts beside two of those without; None without any."""
    if not any(found["restart_failures"] for found in aggregates.overall.values()):
        return None
    keys = {column.key for column in METRIC_COLUMNS if column.group == RESTARTS}
    return overall_table(aggregates, keys.union(BESIDE_RESTARTS))


def recording_table(aggregates: Aggregates, recording: str, columns: Sequence[Column]) -> Table:
    """Show metrics of one recording, as means and spreads over the seeds."""
    found = aggregates.recordings[recording]
    table = {label: found[label] for label in aggregates.order if label in found}
    return _metrics_table(
        table, columns, lambda _, summary, column: mean_and_spread_text(summary, column)
    )


def behind_table(aggregates: Aggregates) -> Table:
    """Show the means with their intervals, and how far each system is behind the first."""
    headers = [
        Header(words, column.unit)
        for column in COMPARED_METRICS
        for words in (column.label, f"{column.label}: difference")
    ]
    rows = {
        label: [
            _with_interval(found.get(column.key), column, sign)
            for column in COMPARED_METRICS
            for found, sign in ((means, ""), (aggregates.behind.get(label, {}), "+"))
        ]
        for label, means in aggregates.overall.items()
    }
    return Table(headers, rows)


def pairs_table(aggregates: Aggregates) -> Table:
    """Show how far each system is from each other one, with the interval, in the first metric."""
    column = COMPARED_METRICS[0]
    rows = {
        label: [
            TableCell("") if other == label else _with_interval(found[other], column, "+")
            for other in aggregates.order
        ]
        for label, found in aggregates.pairs.items()
    }
    return Table([Header(f"to {label}") for label in aggregates.order], rows)


def _with_interval(found: Summary | None, column: Column, sign: str) -> TableCell:
    if found is None:
        return TableCell(NO_VALUE)
    within = interval_text(found, column)
    text = f"{found.mean:{sign}.{column.decimals}f}" + (f" ({within})" if within else "")
    return TableCell(text, found.mean)


def occlusions_table(runs: Mapping[str, Sequence[ScoredRun]]) -> Table | None:
    """Show the recovery of each system from each total occlusion; None without any."""
    by_system = {
        label: [occlusion for run in some for occlusion in run.metrics.occlusions]
        for label, some in runs.items()
    }
    spans = sorted({(o.first_frame, o.last_frame) for some in by_system.values() for o in some})
    if not spans:
        return None
    rows = {
        label: [
            cell
            for span in spans
            for cell in _occlusion_cells([o for o in some if (o.first_frame, o.last_frame) == span])
        ]
        for label, some in by_system.items()
    }
    three = (
        Header("recovered", "seeds", "Seeds after which the track was on the vehicle again."),
        Header("error at exit", "px", "Mean error in the first frame after it."),
        Header("return", "frames", "Median frames until the track stays on the vehicle."),
    )
    groups = [Header(f"frames {first} to {last}", span=3) for first, last in spans]
    return Table(three * len(spans), rows, groups)


def _occlusion_cells(seeds: Sequence[OcclusionScore]) -> Iterator[TableCell]:
    """Summarise one occlusion over the seeds of one system."""
    verdicts = [o.recovered for o in seeds if o.recovered is not None]
    exits = [o.error_at_exit_px for o in seeds if o.error_at_exit_px is not None]
    frames = [o.frames_to_recover for o in seeds if o.frames_to_recover is not None]
    # The share sorts the column; what is read is the count, as seeds are few.
    share = statistics.fmean(verdicts) if verdicts else None
    text = f"{sum(verdicts)} of {len(verdicts)}" if verdicts else "not judged"
    yield TableCell(text, share, share == 1)
    yield number_cell(statistics.fmean(exits) if exits else None, ".1f")
    note = f"in {counted(len(frames), 'seed')}"
    yield number_cell(statistics.median(frames) if frames else None, ".0f", note)


def _metrics_table(
    table: Mapping[str, Summaries],
    columns: Sequence[Column],
    text: Callable[[str, Summary | None, Column], str],
) -> Table:
    # A metric that no system has, such as recoveries without occlusions, gets no column.
    kept = [column for column in columns if any(row.get(column.key) for row in table.values())]
    best = {column.key: _best(table, column) for column in kept}

    def cell(label: str, column: Column) -> TableCell:
        summary = table[label].get(column.key)
        value = summary.mean if summary else None
        # As it is shown: two that read alike are both best.
        is_best = value is not None and round(value, column.decimals) == best[column.key]
        within = interval_text(summary, column)
        note = f"95 % interval of the mean: {within}" if within else ""
        return TableCell(text(label, summary, column), value, is_best, note)

    # Columns of a group stand beside each other in `METRIC_COLUMNS`, which groupby needs.
    grouped = itertools.groupby(kept, lambda column: column.group)
    return Table(
        [Header(column.label, column.unit, column.help) for column in kept],
        {label: [cell(label, column) for column in kept] for label in table},
        [Header(name, span=len(list(group))) for name, group in grouped],
    )


def _best(table: Mapping[str, Summaries], column: Column) -> float | None:
    """Return the best value as it is shown; None where none is better than all others."""
    values = {round(s.mean, column.decimals) for row in table.values() if (s := row[column.key])}
    # Where all read alike, a mark would say nothing.
    if column.higher_is_better is None or len(values) < 2:
        return None
    return max(values) if column.higher_is_better else min(values)


def number_cell(value: float | None, form: str, note: str = "") -> TableCell:
    """Return the cell of a number, in a form such as ``.1f``; a dash for None."""
    return TableCell(NO_VALUE if value is None else f"{value:{form}}", value, note=note)

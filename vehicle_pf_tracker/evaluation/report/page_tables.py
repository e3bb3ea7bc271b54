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

"""Tables of the page: text, sorting value and the best cells."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.evaluation.occlusions import OcclusionScore
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates, Summaries
from vehicle_pf_tracker.evaluation.report.columns import (
    COLUMNS,
    NO_VALUE,
    RANKED,
    RECOVERED,
    Column,
    counted,
    interval_text,
    listing,
    mean_and_spread_text,
    mean_text,
    number_text,
    p_value_text,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredRun
from vehicle_pf_tracker.evaluation.statistics import ALPHA, Summary

Slots = Mapping[str, int]


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
    heat : float
        Tint, -1 to 1: its strength and direction.
    """

    text: str
    value: float | None = None
    best: bool = False
    note: str = ""
    heat: float = 0.0


@dataclass(frozen=True, slots=True)
class Row:
    """A system's row, with the number of its style where it has one."""

    label: str
    slot: int | None
    cells: tuple[TableCell, ...]


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table; `groups` spans the `headers`, and may be empty."""

    groups: tuple[Header, ...]
    headers: tuple[Header, ...]
    rows: tuple[Row, ...]


def overall_table(aggregates: Aggregates, slots: Slots) -> PageTable:
    """Show all metrics, as means over the recordings; recoveries with their number too."""

    def text(label: str, summary: Summary | None, column: Column) -> str:
        mean = mean_text(summary, column)
        recovered, judged = aggregates.recoveries[label]
        return f"{mean} ({recovered}/{judged})" if column is RECOVERED and judged else mean

    return _metrics_table(aggregates.overall, COLUMNS, slots, text)


def recording_table(aggregates: Aggregates, recording: str, slots: Slots) -> PageTable:
    """Show the metrics of one recording, as means and spreads over the seeds."""
    table = {
        label: summaries
        for label in aggregates.order
        if (summaries := aggregates.by_recording.get((recording, label))) is not None
    }
    columns = [column for column in COLUMNS if column.by_recording]
    return _metrics_table(
        table, columns, slots, lambda _, summary, column: mean_and_spread_text(summary, column)
    )


def ranks_table(aggregates: Aggregates, slots: Slots) -> PageTable:
    """Show places with their ties and mean ranks, by each ranked metric."""
    ranked = [column for column in RANKED if column.key in aggregates.rankings]
    cells: dict[str, list[TableCell]] = {label: [] for label in aggregates.order}
    for column in ranked:
        ranks = {rank.system: rank for rank in aggregates.rankings[column.key].ranks}
        differ = any(rank.place > 1 for rank in ranks.values())
        for label, row in cells.items():
            if label not in ranks:
                row += [TableCell(NO_VALUE), TableCell(NO_VALUE)]
                continue
            rank = ranks[label]
            note = f"tied with {listing(rank.tied)}" if rank.tied else ""
            place = f"{rank.place}{' =' if rank.tied else ''}"
            row.append(TableCell(place, rank.place, differ and rank.place == 1, note))
            row.append(TableCell(f"{rank.mean_rank:.2f}", rank.mean_rank))
    return PageTable(
        groups=tuple(Header(column.label, span=2) for column in ranked),
        headers=tuple(itertools.chain(*((Header("place"), Header("mean rank")) for _ in ranked))),
        rows=tuple(Row(label, slots.get(label), tuple(row)) for label, row in cells.items()),
    )


def pairs_table(aggregates: Aggregates, slots: Slots) -> PageTable:
    """Show the mean difference of each pair: the row's system less the column's."""
    column = RANKED[0]
    found: dict[tuple[str, str], TableCell] = {}
    known = [abs(test.difference.mean) for test in aggregates.pairs if test.difference]
    largest = max(known, default=0.0) or 1.0
    for test in aggregates.pairs:
        for pair, sign in (((test.first, test.second), 1), ((test.second, test.first), -1)):
            if test.difference is None:
                found[pair] = TableCell(NO_VALUE)
                continue
            value = sign * test.difference.mean
            alone = test.p_value is not None and test.p_value < ALPHA
            mark = "**" if test.significant else "*" if alone else ""
            p_values = f"p {p_value_text(test.p_value)}"
            p_values += f", adjusted {p_value_text(test.adjusted_p)}"
            text = f"{value:+.{column.decimals}f}{mark}"
            found[pair] = TableCell(text, value, test.significant, p_values, value / largest)
    itself = TableCell("")
    rows = (
        Row(label, slots.get(label), tuple(found.get((label, o), itself) for o in aggregates.order))
        for label in aggregates.order
    )
    return PageTable((), tuple(Header(label) for label in aggregates.order), tuple(rows))


def occlusions_table(runs: Mapping[str, Sequence[ScoredRun]], slots: Slots) -> PageTable | None:
    """Show the recovery of each system from each total occlusion; None without any."""
    occlusions = occlusions_of([run for some in runs.values() for run in some])
    if not occlusions:
        return None
    rows = []
    for label, some in runs.items():
        cells: list[TableCell] = []
        for occlusion in occlusions:
            cell = occlusion_cell(some, occlusion)
            share = cell.recovered / cell.judged if cell.judged else None
            text = f"{cell.recovered} of {cell.judged}" if cell.judged else "not judged"
            cells.append(TableCell(text, share, share == 1))
            cells.append(TableCell(number_text(cell.exit_px, 1), cell.exit_px))
            note = f"in {counted(cell.back, 'seed')}"
            cells.append(TableCell(number_text(cell.frames, 0), cell.frames, note=note))
        rows.append(Row(label, slots.get(label), tuple(cells)))
    three = (
        Header("recovered", "seeds", "Seeds after which the track was on the vehicle again."),
        Header("error at exit", "px", "Mean error in the first frame after it."),
        Header("return", "frames", "Median frames until the track stays on the vehicle."),
    )
    groups = tuple(Header(f"frames {first} to {last}", span=3) for first, last in occlusions)
    return PageTable(groups, three * len(occlusions), tuple(rows))


def _metrics_table(
    table: Mapping[str, Summaries],
    columns: Sequence[Column],
    slots: Slots,
    text: Callable[[str, Summary | None, Column], str],
) -> PageTable:
    kept = [column for column in columns if any(row.get(column.key) for row in table.values())]
    best = {column.key: _best(table, column) for column in kept}
    rows = []
    for label, summaries in table.items():
        cells = []
        for column in kept:
            summary = summaries.get(column.key)
            value = summary.mean if summary else None
            is_best = value is not None and round(value, column.decimals) == best[column.key]
            within = interval_text(summary, column)
            note = f"95 % interval of the mean: {within}" if within else ""
            cells.append(TableCell(text(label, summary, column), value, is_best, note))
        rows.append(Row(label, slots.get(label), tuple(cells)))
    grouped = itertools.groupby(kept, lambda column: column.group)
    return PageTable(
        groups=tuple(Header(name, span=len(list(group))) for name, group in grouped),
        headers=tuple(Header(column.label, column.unit, column.help) for column in kept),
        rows=tuple(rows),
    )


def _best(table: Mapping[str, Summaries], column: Column) -> float | None:
    """Return the best value as it is shown; None where none is better than all others."""
    values = {round(s.mean, column.decimals) for row in table.values() if (s := row[column.key])}
    if column.higher_is_better is None or len(values) < 2:
        return None
    return max(values) if column.higher_is_better else min(values)


@dataclass(frozen=True, slots=True)
class OcclusionCell:
    """One system in one total occlusion, over its seeds.

    Attributes
    ----------
    recovered, judged : int
        Seeds after which it recovered, and seeds that are judged.
    exit_px : float or None
        Mean error at the exit.
    back : int
        Seeds in which the track recovered for good.
    frames : float or None
        Median number of frames until then.
    """

    recovered: int
    judged: int
    exit_px: float | None
    back: int
    frames: float | None


def occlusions_of(runs: Sequence[ScoredRun]) -> list[tuple[int, int]]:
    """Return the first and last hidden frames of all total occlusions that the runs saw."""
    return sorted({_key(o) for run in runs for o in run.metrics.occlusions})


def occlusion_cell(runs: Sequence[ScoredRun], occlusion: tuple[int, int]) -> OcclusionCell:
    """Summarise the seeds of one system."""
    found = [o for run in runs for o in run.metrics.occlusions if _key(o) == occlusion]
    verdicts = [o.recovered for o in found if o.recovered is not None]
    exits = [o.error_at_exit_px for o in found if o.error_at_exit_px is not None]
    frames = [o.frames_to_recover for o in found if o.frames_to_recover is not None]
    return OcclusionCell(
        recovered=sum(verdicts),
        judged=len(verdicts),
        exit_px=statistics.fmean(exits) if exits else None,
        back=len(frames),
        frames=statistics.median(frames) if frames else None,
    )


def _key(occlusion: OcclusionScore) -> tuple[int, int]:
    return occlusion.first_frame, occlusion.last_frame


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
    """Describe the measurement and the machine."""
    clock = (timings or {}).get("clock", "time of a step")
    processor = " with ".join(map(str, (timings or {}).get("processor", []) or ["unknown"]))
    return (
        f"Measured in a serial pass of its own: {clock}. Processor: {processor} cores. "
        "Compare systems by their ratios; other machines have other times."
    )


def _cell(value: float | None, decimals: int) -> TableCell:
    return TableCell(number_text(value, decimals), value)

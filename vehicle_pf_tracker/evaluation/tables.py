"""Tables: on a terminal, as Markdown, as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from rich.table import Table as RichTable
from rich.text import Text

from vehicle_pf_tracker.evaluation.metrics import Metrics
from vehicle_pf_tracker.evaluation.occlusions import OcclusionScore

Cell: TypeAlias = float | int | bool | str | None
NOTHING = "-"


@dataclass(frozen=True, slots=True)
class Line:
    """A row: what it shows, its unit, its cells, and decimals for the eye."""

    label: str
    unit: str
    cells: tuple[Cell, ...]
    decimals: int = 1


@dataclass(frozen=True, slots=True)
class Table:
    """One line per metric, one column per run."""

    columns: tuple[str, ...]
    lines: tuple[Line, ...]

    def to_rich(self) -> RichTable:
        """For a terminal."""
        # As `Text`, since a name in brackets would be taken for a style otherwise.
        table = RichTable("")
        for name in self.columns:
            table.add_column(Text(name), justify="right")
        for line in self._rows():
            table.add_row(*map(Text, line))
        return table

    def to_markdown(self) -> str:
        """For documents."""
        return markdown(["", *self.columns], self._rows())

    def to_csv(self) -> str:
        """For programs: every digit, and nothing where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["metric", "unit", *self.columns])
        writer.writerows([line.label, line.unit, *line.cells] for line in self.lines)
        return text.getvalue()

    def _rows(self) -> Iterator[list[str]]:
        for line in self.lines:
            yield [_label(line), *(_text(cell, line.decimals) for cell in line.cells)]


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Make a Markdown table: the first column to the left, numbers to the right."""
    ruled = [header, ["---", *("---:" for _ in header[1:])], *rows]
    return "".join(f"| {' | '.join(row)} |\n" for row in ruled)


def comparison(runs: Mapping[str, Metrics]) -> Table:
    """Put runs on the same recording side by side, each under its name.

    Metrics that no run has are left out.
    """
    metrics = list(runs.values())

    def line(label: str, unit: str, value: Callable[[Metrics], Cell], decimals: int = 1) -> Line:
        return Line(label, unit, tuple(map(value, metrics)), decimals)

    lines = [
        line("error, RMSE", "px", lambda m: m.rmse_px),
        line("error, RMSE while visible", "px", lambda m: m.rmse_visible_px),
        line("error, median", "px", lambda m: m.median_px),
        line("error, largest", "px", lambda m: m.max_px),
        line("error below 15 px", "share", lambda m: m.p_error_lt_15px, 3),
        line("on target while visible", "share", lambda m: m.on_target, 3),
        *_occlusion_lines(metrics),
        line("TRACKING while visible", "share", lambda m: m.visible_tracking, 3),
        line("not TRACKING while hidden", "share", lambda m: m.hidden_not_tracking, 3),
        line("frames", "", lambda m: m.frames),
        line("frames scored", "", lambda m: m.frames_scored),
        line("time per step, median", "ms", lambda m: m.step_ms_p50, 2),
        line("time per step, 95 %", "ms", lambda m: m.step_ms_p95, 2),
    ]
    has_values = [any(cell is not None for cell in line.cells) for line in lines]
    kept = tuple(line for line, filled in zip(lines, has_values, strict=True) if filled)
    return Table(tuple(runs), kept)


def _occlusion_lines(metrics: list[Metrics]) -> list[Line]:
    # Runs that were started at different frames may not have seen the same occlusions.
    by_frames = [{(o.first_frame, o.last_frame): o for o in m.occlusions} for m in metrics]
    lines = []
    for first, last in sorted(set().union(*by_frames)):
        found = [table.get((first, last)) for table in by_frames]
        name = f"hidden {first}-{last}"
        inside = tuple(o.error_inside_px if o else None for o in found)
        after = tuple(o.error_after_px if o else None for o in found)
        lines += [
            Line(f"{name}: mean error inside", "px", inside),
            Line(f"{name}: mean error after", "px", after),
            Line(f"{name}: recovered", "", tuple(map(_verdict, found))),
        ]
    return lines


def _verdict(occlusion: OcclusionScore | None) -> Cell:
    if occlusion is None:
        return None
    return "not judged" if occlusion.recovered is None else occlusion.recovered


def _label(line: Line) -> str:
    return f"{line.label}, {line.unit}" if line.unit not in {"", "share"} else line.label


def _text(cell: Cell, decimals: int) -> str:
    if cell is None:
        return NOTHING
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return f"{cell:.{decimals}f}" if isinstance(cell, float) else str(cell)

"""The figures of a report, as SVG elements."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.columns import RANKED
from vehicle_pf_tracker.evaluation.report.panels import (
    Interval,
    Line,
    curve_panel,
    error_panel,
    intervals_panel,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.evaluation.report.svg import SvgMaker


@dataclass(frozen=True, slots=True)
class Panel:
    """An SVG element and the words under it."""

    svg: str
    caption: str


_CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}


def curve_panels(
    evaluation: ScoredEvaluation,
    order: Sequence[str],
    slots: Mapping[str, int],
    maker: SvgMaker,
) -> list[Panel]:
    """Draw the three curves: means over the seeds of a recording, and then over recordings."""
    panels = []
    for name, (title, xlabel, ylabel) in _CURVES.items():
        lines = [
            line
            for label in order
            if (line := _curve(evaluation, label, name, slots.get(label))) is not None
        ]
        if lines:
            areas = ", ".join(f"{line.label} {line.ys.mean():.3f}" for line in lines)
            svg = maker.make(curve_panel(lines, xlabel, ylabel), f"{title}; areas: {areas}")
            panels.append(Panel(svg, title))
    return panels


def main_panel(aggregates: Aggregates, maker: SvgMaker) -> Panel | None:
    """Draw the first ranked metric of all systems, with intervals; None without any."""
    column = RANKED[0]
    rows = []
    for label in aggregates.order:
        whole = aggregates.overall[label].get(column.key)
        if whole is None:
            continue
        known = [
            summary.mean
            for (_, system), found in aggregates.by_recording.items()
            if system == label and (summary := found.get(column.key)) is not None
        ]
        rows.append(Interval(label, known, whole.mean, whole.low, whole.high))
    if not rows:
        return None
    words = ", ".join(f"{row.label} {row.mean:.{column.decimals}f}" for row in rows)
    svg = maker.make(intervals_panel(rows, column.title), f"{column.label}: {words}")
    return Panel(svg, f"{column.label}: mean, 95 % interval, and each recording")


def error_panels(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth], maker: SvgMaker
) -> list[Panel]:
    """Draw the error over time on one recording, one panel for each system."""
    spans = {
        "partial": stretches(truths, Occlusion.PARTIAL),
        "total": stretches(truths, Occlusion.TOTAL),
    }
    found = {
        label: [run.errors for run in some if np.isfinite(run.errors).any()]
        for label, some in runs.items()
    }
    found = {label: errors for label, errors in found.items() if errors}
    highest = max((float(np.nanmax(e)) for errors in found.values() for e in errors), default=0)
    panels = []
    for label, errors in found.items():
        median = float(np.nanmedian(np.concatenate(errors)))
        figure = error_panel(_same_length(errors), spans, highest)
        svg = maker.make(figure, f"Error of {label} over time; median {median:.1f} px")
        panels.append(Panel(svg, label))
    return panels


def stretches(truths: Mapping[int, Truth], occlusion: Occlusion) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with this occlusion."""
    found = []
    grouped = itertools.groupby(sorted(truths), lambda n: truths[n].occlusion is occlusion)
    for matches, group in grouped:
        numbers = list(group)
        if matches:
            found.append((numbers[0], numbers[-1]))
    return found


def _curve(evaluation: ScoredEvaluation, label: str, name: str, slot: int | None) -> Line | None:
    by_recording: dict[str, list[Array]] = {}
    thresholds: Array | None = None
    for run in evaluation.of(system=label):
        if name in run.curves:
            by_recording.setdefault(run.recording, []).append(run.curves[name].shares)
            thresholds = run.curves[name].thresholds
    if thresholds is None:
        return None
    means = [np.mean(shares, axis=0) for shares in by_recording.values()]
    return Line(label, slot, thresholds, np.mean(means, axis=0))


def _same_length(errors: Sequence[Array]) -> list[Array]:
    longest = max(map(len, errors))
    return [np.pad(e, (0, longest - len(e)), constant_values=np.nan) for e in errors]

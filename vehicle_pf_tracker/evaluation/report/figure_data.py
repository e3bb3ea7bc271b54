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

"""Numbers of the figures of a report: curves, intervals, errors over time."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.columns import RANKED
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun

Spans = Mapping[str, Sequence[tuple[int, int]]]
"""First and last frames of the stretches with an occlusion, by ``partial`` and ``total``."""


CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}
"""Title and names of the axes of each curve."""


@dataclass(frozen=True, slots=True)
class CurveLine:
    """A line of a figure.

    Attributes
    ----------
    label : str
        Label of the line.
    slot : int or None
        Number of its style in `STYLES`; None is drawn grey, behind the others.
    xs, ys : (N,) array
        Points of the line.
    """

    label: str
    slot: int | None
    xs: Array
    ys: Array


def curve_lines(
    evaluation: ScoredEvaluation, order: Sequence[str], slots: Mapping[str, int], name: str
) -> list[CurveLine]:
    """Return a curve of `CURVES`: means over the seeds of a recording, then over recordings."""
    lines = [_curve(evaluation, label, name, slots.get(label)) for label in order]
    return [line for line in lines if line is not None]


def _curve(
    evaluation: ScoredEvaluation, label: str, name: str, slot: int | None
) -> CurveLine | None:
    by_recording: dict[str, list[Array]] = {}
    thresholds: Array | None = None
    for run in evaluation.of(system=label):
        if name in run.curves:
            by_recording.setdefault(run.recording, []).append(run.curves[name].shares)
            thresholds = run.curves[name].thresholds
    if thresholds is None:
        return None
    means = [np.mean(shares, axis=0) for shares in by_recording.values()]
    return CurveLine(label, slot, thresholds, np.mean(means, axis=0))


@dataclass(frozen=True, slots=True)
class Interval:
    """A row of a figure of intervals.

    Attributes
    ----------
    label : str
        Label of the system.
    values : sequence of float
        Means on the recordings.
    mean : float
        Mean over the recordings.
    low, high : float or None
        Interval of the mean; None where there is none.
    """

    label: str
    values: Sequence[float]
    mean: float
    low: float | None
    high: float | None


def interval_rows(aggregates: Aggregates) -> list[Interval]:
    """Return the first ranked metric of all systems that have it, with intervals."""
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
    return rows


@dataclass(frozen=True, slots=True)
class ErrorSeries:
    """Errors over time on one recording.

    Attributes
    ----------
    errors : mapping of str to sequence of (N,) array
        Errors in px by frame, by system and for each of its seeds; NaN where nothing is scored.
    spans : Spans
        The occlusions.
    highest : float
        Largest error of any system, px.
    """

    errors: Mapping[str, Sequence[Array]]
    spans: Spans
    highest: float


def error_series(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth]
) -> ErrorSeries:
    """Return the errors of the systems that have any."""
    spans = {
        "partial": stretches(truths, Occlusion.PARTIAL),
        "total": stretches(truths, Occlusion.TOTAL),
    }
    found = {
        label: [run.errors for run in some if np.isfinite(run.errors).any()]
        for label, some in runs.items()
    }
    errors = {label: _same_length(some) for label, some in found.items() if some}
    highest = max((float(np.nanmax(e)) for some in errors.values() for e in some), default=0.0)
    return ErrorSeries(errors, spans, highest)


def stretches(truths: Mapping[int, Truth], occlusion: Occlusion) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with this occlusion."""
    found = []
    grouped = itertools.groupby(sorted(truths), lambda n: truths[n].occlusion is occlusion)
    for matches, group in grouped:
        numbers = list(group)
        if matches:
            found.append((numbers[0], numbers[-1]))
    return found


def _same_length(errors: Sequence[Array]) -> list[Array]:
    longest = max(map(len, errors))
    return [np.pad(e, (0, longest - len(e)), constant_values=np.nan) for e in errors]

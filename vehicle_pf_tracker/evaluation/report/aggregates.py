# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The metrics of a report, and their summaries over seeds and recordings."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.columns import COMPARED_METRICS, METRIC_COLUMNS, Column
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.evaluation.statistics import Summary, summarise

Summaries = Mapping[str, Summary | None]
"""Summaries by the key of a column."""
_RANKED_BY = COMPARED_METRICS[0].key
"""Key of the metric that orders the systems."""


@dataclass(frozen=True, slots=True)
class Aggregates:
    """Numbers of the tables.

    Attributes
    ----------
    order : tuple of str
        Labels of the systems that have a run, the best first.
    recordings : mapping of str to mapping of str to Summaries
        Summaries over seeds, by recording and system.
    overall : mapping of system to Summaries
        Summaries over the means of the recordings, so that long ones do not outweigh short ones.
    behind : mapping of str to Summaries
        Differences to the first system over the recordings that both have, by system.
    pairs : mapping of str to mapping of str to Summary or None
        Differences of each system to each other one in the metric that orders them.
    recoveries : mapping of str to (int, int)
        Total occlusions recovered from and judged, of all runs of a system.
    """

    order: tuple[str, ...]
    recordings: Mapping[str, Mapping[str, Summaries]]
    overall: Mapping[str, Summaries]
    behind: Mapping[str, Summaries]
    pairs: Mapping[str, Summaries]
    recoveries: Mapping[str, tuple[int, int]]


Values = Mapping[str, Mapping[str, Sequence[float]]]
"""Values of the runs of one system, by the key of a column and by recording."""
Means = Mapping[str, Mapping[str, float]]
"""Their means over the seeds, likewise."""


def aggregate(evaluation: ScoredEvaluation) -> Aggregates:
    """Summarise all runs."""
    labels = [system.label for system in evaluation.folder.systems]
    runs = {label: some for label in labels if (some := evaluation.of(system=label))}
    values = {
        label: {column.key: _values(some, column) for column in METRIC_COLUMNS}
        for label, some in runs.items()
    }
    means = {label: _means(columns) for label, columns in values.items()}
    # The best first: it is what the others are compared with.
    order = _ranked(means)
    return Aggregates(
        order=order,
        recordings={
            entry.name: {
                label: _over_seeds(values[label], entry.name)
                for label in runs
                if evaluation.of(entry.name, label)
            }
            for entry in evaluation.folder.recordings
        },
        overall={label: _over_recordings(means[label]) for label in order},
        behind={label: _behind(means[label], means[order[0]]) for label in order[1:]},
        pairs={label: _against_others(label, order, means) for label in order},
        recoveries={label: _recoveries(runs[label]) for label in order},
    )


def _means(columns: Values) -> Means:
    return {
        key: {recording: statistics.fmean(some) for recording, some in found.items()}
        for key, found in columns.items()
    }


def _ranked(means: Mapping[str, Means]) -> tuple[str, ...]:
    """Order the systems by their mean over the recordings in the first of the compared metrics."""

    def mean(label: str) -> float:
        found = means[label][_RANKED_BY]
        # A system without a score goes last.
        return statistics.fmean(found.values()) if found else -math.inf

    return tuple(sorted(means, key=mean, reverse=True))


def _over_seeds(columns: Values, recording: str) -> Summaries:
    return {key: summarise(some.get(recording, [])) for key, some in columns.items()}


def _over_recordings(means: Means) -> Summaries:
    return {key: summarise(list(found.values())) for key, found in means.items()}


def _behind(means: Means, best: Means) -> Summaries:
    return {
        column.key: _differences(means[column.key], best[column.key]) for column in COMPARED_METRICS
    }


def _against_others(label: str, order: Sequence[str], means: Mapping[str, Means]) -> Summaries:
    own = means[label][_RANKED_BY]
    return {other: _differences(own, means[other][_RANKED_BY]) for other in order if other != label}


def _values(runs: Sequence[ScoredRun], column: Column) -> dict[str, list[float]]:
    """Return a metric of the runs that have it, by recording."""
    found: dict[str, list[float]] = {}
    for run in runs:
        if (value := column.value(run.metrics)) is not None:
            found.setdefault(run.recording, []).append(value)
    return found


def _recoveries(runs: Sequence[ScoredRun]) -> tuple[int, int]:
    judged = [verdict for run in runs for verdict in run.metrics.recovered if verdict is not None]
    return sum(judged), len(judged)


def _differences(values: Mapping[str, float], first: Mapping[str, float]) -> Summary | None:
    # Paired by recording: how hard a recording is cancels out.
    return summarise([value - first[name] for name, value in values.items() if name in first])

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

"""Summaries of runs: over seeds, and over recordings.

Findings of a report, in a few sentences.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.report.columns import (
    COLUMNS,
    PRECISION,
    RANKED,
    RECOVERED,
    RMSE,
    Column,
    counted,
    interval_text,
    listing,
    mean_text,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.evaluation.statistics import (
    FEWEST_RECORDINGS,
    PairedTest,
    Ranking,
    RunKey,
    Summary,
    compare_pairs,
    rank_systems,
    recording_means,
    smallest_adjusted_p,
    summarise,
)

Summaries = Mapping[str, Summary | None]
"""Summaries by the key of a column."""


@dataclass(frozen=True, slots=True)
class Aggregates:
    """Numbers of the tables.

    Attributes
    ----------
    order : tuple of str
        Labels of the systems that have a run, the best first.
    by_recording : mapping of (recording, system) to Summaries
        Summaries over seeds.
    overall : mapping of system to Summaries
        Summaries over the means of the recordings, so that long ones do not outweigh short ones.
    rankings : mapping of str to Ranking
        Rankings by the key of a ranked column.
    pairs : tuple of PairedTest
        Tests of all pairs, by the first ranked column.
    recoveries : mapping of str to (int, int)
        Total occlusions recovered from and judged, of all runs of a system.
    """

    order: tuple[str, ...]
    by_recording: Mapping[tuple[str, str], Summaries]
    overall: Mapping[str, Summaries]
    rankings: Mapping[str, Ranking]
    pairs: tuple[PairedTest, ...]
    recoveries: Mapping[str, tuple[int, int]]


def aggregate(evaluation: ScoredEvaluation) -> Aggregates:
    """Summarise all runs."""
    labels = [system.label for system in evaluation.systems if evaluation.of(system=system.label)]
    by_recording = {
        (recording.name, label): _over_seeds(runs)
        for recording in evaluation.recordings
        for label in labels
        if (runs := evaluation.of(recording.name, label))
    }
    rankings = _rankings(evaluation, labels)
    order = _order(labels, rankings)
    main = {label: run_values(evaluation, label, RANKED[0]) for label in order}
    return Aggregates(
        order=order,
        by_recording=by_recording,
        overall={label: _over_recordings(evaluation, label) for label in order},
        rankings=rankings,
        pairs=tuple(compare_pairs(main)),
        recoveries={label: _recoveries(evaluation.of(system=label)) for label in order},
    )


def run_values(evaluation: ScoredEvaluation, system: str, column: Column) -> dict[RunKey, float]:
    """Return a metric of a system's runs, where they have it."""
    values = {
        RunKey(run.recording, run.seed): column.value(run.metrics)
        for run in evaluation.of(system=system)
    }
    return {key: value for key, value in values.items() if value is not None}


def _recoveries(runs: Sequence[ScoredRun]) -> tuple[int, int]:
    judged = [verdict for run in runs for verdict in run.metrics.recovered if verdict is not None]
    return sum(judged), len(judged)


def _over_seeds(runs: Sequence[ScoredRun]) -> dict[str, Summary | None]:
    return {
        column.key: summarise([column.value(run.metrics) for run in runs]) for column in COLUMNS
    }


def _over_recordings(evaluation: ScoredEvaluation, system: str) -> dict[str, Summary | None]:
    return {
        column.key: summarise(
            list(recording_means(run_values(evaluation, system, column)).values())
        )
        for column in COLUMNS
    }


def _rankings(evaluation: ScoredEvaluation, labels: Sequence[str]) -> dict[str, Ranking]:
    rankings = {}
    for column in RANKED:
        values = {label: recording_means(run_values(evaluation, label, column)) for label in labels}
        ranking = rank_systems(values, higher_is_better=bool(column.higher_is_better))
        if ranking is not None:
            rankings[column.key] = ranking
    return rankings


def _order(labels: Sequence[str], rankings: Mapping[str, Ranking]) -> tuple[str, ...]:
    ranking = rankings.get(RANKED[0].key)
    ranked = [rank.system for rank in ranking.ranks] if ranking else []
    return (*ranked, *(label for label in labels if label not in ranked))


def findings(evaluation: ScoredEvaluation, aggregates: Aggregates) -> list[str]:
    """State the leader, the systems statistically tied with it, and missing results."""
    sentences = [*_leader(aggregates)]
    sentences += [_best(aggregates, column) for column in (PRECISION, RMSE, RECOVERED)]
    sentences.append(_failed(evaluation))
    return [sentence for sentence in sentences if sentence]


def power(aggregates: Aggregates) -> str:
    """Say what the paired tests can find at best."""
    tests = [test for test in aggregates.pairs if test.difference is not None]
    if not tests:
        return ""
    recordings = max(test.difference.count for test in tests if test.difference)
    if recordings < FEWEST_RECORDINGS:
        return (
            f"With {counted(recordings, 'recording')} there are too few samples for any test: "
            f"at least {FEWEST_RECORDINGS} are needed, whatever the number of seeds."
        )
    least = smallest_adjusted_p(recordings, len(tests))
    text = (
        f"With {counted(recordings, 'recording')} and {counted(len(tests), 'pair')} no adjusted "
        f"p value can be below {least:.2g}"
    )
    if least < 0.05:
        return f"{text}."
    return (
        f"{text}, so that too few recordings are there for any pair to differ significantly: "
        "add recordings, or compare fewer systems."
    )


def _leader(aggregates: Aggregates) -> list[str]:
    column = RANKED[0]
    ranking = aggregates.rankings.get(column.key)
    if ranking is None:
        return ["There is no truth to rank the systems by."]
    leader = ranking.ranks[0]
    summary = aggregates.overall[leader.system].get(column.key)
    within = interval_text(summary, column)
    text = (
        f"{leader.system} has the best mean rank by {column.label}, "
        f"whose mean is {mean_text(summary, column)}"
    )
    sentences = [f"{text} (95 % interval {within})." if within else f"{text}."]
    if ranking.critical_difference is None and len(ranking.ranks) > 1:
        sentences.append(
            f"{counted(ranking.recordings, 'recording')} cannot tell systems apart: "
            f"ranks need at least {FEWEST_RECORDINGS}."
        )
    elif leader.tied:
        sentences.append(
            f"{counted(ranking.recordings, 'recording')} cannot tell it apart from "
            f"{listing(leader.tied)}."
        )
    return sentences


def _best(aggregates: Aggregates, column: Column) -> str:
    known = {
        label: round(summary.mean, column.decimals)
        for label, summaries in aggregates.overall.items()
        if (summary := summaries.get(column.key)) is not None
    }
    if len(known) < 2:
        return ""
    best = max(known.values()) if column.higher_is_better else min(known.values())
    leaders = [label for label, value in known.items() if value == best]
    unit = f" {column.unit}" if column.unit else ""
    end = "Highest" if column.higher_is_better else "Lowest"
    return f"{end} mean of {column.label}: {listing(leaders)}, {best:.{column.decimals}f}{unit}."


def _failed(evaluation: ScoredEvaluation) -> str:
    cells = len(evaluation.runs) + len(evaluation.failed)
    if not evaluation.failed:
        return f"All {counted(cells, 'cell')} of the grid have a result."
    return f"{len(evaluation.failed)} of {counted(cells, 'cell')} have no result; see Failed cells."

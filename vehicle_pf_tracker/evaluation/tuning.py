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

"""Tuning: trials that Optuna proposes, and a comparison of the best with the initial parameters.

The sampler is seeded and every run is stored under the key of all that determines it, so that the
same search goes through the same trials again. An interrupted search continues without a database:
trials that were run before are reported to the sampler at once, and more trials than before
continue where the last one ended. Results do not depend on the number of workers, since a batch has
the same size for any.
"""

from __future__ import annotations

import itertools
import statistics
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import optuna

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import GridCell, VariantSystem, seeds_of
from vehicle_pf_tracker.evaluation.grid.running import Runner
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.evaluation.result_store import ResultStore
from vehicle_pf_tracker.evaluation.search_space import Dimension, Objective
from vehicle_pf_tracker.evaluation.statistics import mean_of_means
from vehicle_pf_tracker.evaluation.tables import NOTHING
from vehicle_pf_tracker.offline.output_files import csv_text
from vehicle_pf_tracker.offline.processes import OnProgress
from vehicle_pf_tracker.parameters.table import Value

BATCH = 6
"""Trials proposed before the first of them is known: enough to keep a few workers busy, few enough
for the sampler to learn (40 trials are 7 batches)."""


@dataclass(frozen=True, slots=True)
class SearchTask:
    """A search: the space, and the runs that score a point of it.

    Attributes
    ----------
    base : VariantSystem
        The first trial; parameters that are not searched keep its values.
    space : sequence of Dimension
        Dimensions of the space.
    sources : sequence of Source
        The recordings.
    seeds : sequence of int
        Seeds of the runs.
    objective : Objective
        The metric to optimise.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    sampler_seed : int
        Seed of the proposals.
    """

    base: VariantSystem
    space: Sequence[Dimension]
    sources: Sequence[Source]
    seeds: Sequence[int]
    objective: Objective
    max_diff: float
    sampler_seed: int = 0

    def cells(self, values: Mapping[str, Value]) -> list[GridCell] | None:
        """Return the runs of a candidate; None if its values do not go together."""
        try:
            system = self.base.changed("trial", values)
        except InputError:
            return None
        return [
            GridCell(source, system, seed, self.max_diff)
            for source in self.sources
            for seed in seeds_of(system, self.seeds)
        ]

    def key(self, cell: GridCell) -> str:
        """Return the key of a run's score."""
        return f"{self.objective.metric}-{cell.key()}"


class Trial(NamedTuple):
    """A tried point of the space and its score; None where it could not run."""

    number: int
    values: Mapping[str, Value]
    score: float | None


def search(
    what: SearchTask, count: int, store: ResultStore, runner: Runner, on_progress: OnProgress
) -> list[Trial]:
    """Make `count` trials.

    Parameters
    ----------
    what : SearchTask
        The search.
    count : int
        Number of trials.
    store : ResultStore
        Stores every run, and has those of earlier calls.
    runner : callable
        Runs cells, see `grid.running`.
    on_progress : callable
        Called with the number of runs done, and of all.
    """
    study = _study(what)
    space = {dimension.name: dimension.distribution() for dimension in what.space}
    fail = optuna.trial.TrialState.FAIL
    runs = len(what.sources) * len(seeds_of(what.base, what.seeds))
    trials: list[Trial] = []
    while len(trials) < count:
        asked = [study.ask(space) for _ in range(min(BATCH, count - len(trials)))]
        values = [{d.name: d.tidy(one.params[d.name]) for d in what.space} for one in asked]
        grids = [what.cells(tried) for tried in values]
        before = len(trials) * runs
        on_progress(before, count * runs)
        for done in _run_missing(what, grids, store, runner):
            on_progress(before + done, count * runs)
        for one, tried, cells in zip(asked, values, grids, strict=True):
            score = None if cells is None else _score(what, cells, store)
            study.tell(one, score, state=fail if score is None else None)
            trials.append(Trial(len(trials), tried, score))
    return trials


def best_of(trials: Sequence[Trial], objective: Objective) -> Trial:
    """Return the best trial, of equals the first.

    Raises
    ------
    InputError
        If none could run.
    """
    sign = 1 if objective.maximise else -1
    scored = [(sign * trial.score, trial) for trial in trials if trial.score is not None]
    if not scored:
        raise InputError(
            "no trial could be scored on all recordings; run `evaluate` on them to see why"
        )
    return max(scored, key=lambda pair: pair[0])[1]


def _run_missing(
    what: SearchTask, grids: Sequence[Sequence[GridCell] | None], store: ResultStore, runner: Runner
) -> Iterator[int]:
    """Run what the store lacks, for all candidates; yield the number done after each."""
    cells = {what.key(cell): cell for grid in grids for cell in grid or ()}
    missing = [cell for key, cell in cells.items() if key not in store]
    for done, (cell, outcome) in enumerate(runner(missing), start=1):
        metrics = outcome.metrics
        score = None if metrics is None else getattr(metrics, what.objective.metric)
        if not outcome.reason:
            store.add(what.key(cell), cell.label, {"score": score})
        yield done


def _score(what: SearchTask, cells: Sequence[GridCell], store: ResultStore) -> float | None:
    runs: dict[str, list[float | None]] = {}
    for cell in cells:
        key = what.key(cell)
        score = store[key]["score"] if key in store else None
        runs.setdefault(cell.source.name, []).append(score)
    return mean_of_means(runs)


def _study(what: SearchTask) -> optuna.Study:
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the options below count as experimental in some versions
        sampler = optuna.samplers.TPESampler(seed=what.sampler_seed, constant_liar=True)
    study = optuna.create_study(
        sampler=sampler, direction="maximize" if what.objective.maximise else "minimize"
    )
    base = dict(what.base.parameters)
    if all(dimension.covers(base[dimension.name]) for dimension in what.space):
        study.enqueue_trial({dimension.name: base[dimension.name] for dimension in what.space})
    return study


def to_csv(trials: Sequence[Trial], objective: Objective) -> str:
    """Write a line for each trial, in order; the first is what the search began with."""
    names = list(trials[0].values) if trials else []
    rows = ([one.number, one.score, *(one.values[name] for name in names)] for one in trials)
    return csv_text(["trial", objective.metric, *names], rows)


TUNED, HELD_OUT = "tuned on", "held out"


class ComparedMetric(NamedTuple):
    """A metric on one recording, or the mean over several.

    Attributes
    ----------
    part : str
        `TUNED` or `HELD_OUT`.
    recording : str
        Name of the recording; for a mean, the number of recordings.
    metric : str
        Name of the metric in `metrics.json`.
    base, best : float or None
        Mean over the seeds, and then over the recordings.
    base_spread, best_spread : float or None
        Standard deviation over the seeds; None for a mean over recordings.
    """

    part: str
    recording: str
    metric: str
    base: float | None
    best: float | None
    base_spread: float | None = None
    best_spread: float | None = None

    @property
    def change(self) -> float | None:
        """Difference of best minus base; None where either is unknown."""
        return None if self.base is None or self.best is None else self.best - self.base


def compare(
    evaluation: ScoredEvaluation, held_out: Sequence[str], metrics: Sequence[str]
) -> list[ComparedMetric]:
    """Compare the two systems of an evaluation, the base first.

    Parameters
    ----------
    evaluation : ScoredEvaluation
        The runs of both.
    held_out : sequence of str
        Names of the recordings that the search did not see.
    metrics : sequence of str
        Metrics to compare.
    """
    names = [recording.name for recording in evaluation.recordings]
    parts = {
        TUNED: [name for name in names if name not in held_out],
        HELD_OUT: [name for name in names if name in held_out],
    }
    failed = {(cell.system, cell.recording) for cell in evaluation.failed}
    lines = []
    for metric, (part, among) in itertools.product(metrics, parts.items()):
        base, best = (
            {
                name: [
                    None if (system.label, name) in failed else getattr(run.metrics, metric)
                    for run in evaluation.of(name, system.label)
                ]
                for name in among
            }
            for system in evaluation.systems
        )
        for name in among:
            means = (mean_of_means({name: runs[name]}) for runs in (base, best))
            spreads = (_spread(runs[name]) for runs in (base, best))
            lines.append(ComparedMetric(part, name, metric, *means, *spreads))
        if among:
            over_all = map(mean_of_means, (base, best))
            lines.append(ComparedMetric(part, f"mean of {len(among)}", metric, *over_all))
    return lines


def _spread(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return statistics.stdev(known) if len(known) > 1 else None


def texts(lines: Sequence[ComparedMetric]) -> tuple[list[str], list[list[str]]]:
    """Return the headings and the rows of the comparison."""
    rows = [
        [
            f"{line.part}: {line.recording}",
            line.metric,
            _number(line.base, line.base_spread),
            _number(line.best, line.best_spread),
            NOTHING if line.change is None else f"{line.change:+.3f}",
        ]
        for line in lines
    ]
    return ["recording", "metric", "default", "best", "change"], rows


def _number(value: float | None, spread: float | None) -> str:
    if value is None:
        return NOTHING
    return f"{value:.3f}" + ("" if spread is None else f" ± {spread:.3f}")


def verdict(lines: Sequence[ComparedMetric], objective: Objective) -> str:
    """State in a sentence whether the gain holds on held-out recordings."""
    sign = 1 if objective.maximise else -1
    gains = {
        line.part: None if line.change is None else sign * line.change
        for line in lines
        if line.metric == objective.metric and line.recording.startswith("mean of ")
    }
    tuned, held_out = gains.get(TUNED), gains.get(HELD_OUT)
    if tuned is None or tuned <= 0:
        return "With other seeds the best parameters are no better than those before."
    if HELD_OUT not in gains:
        return "Without --held-out nothing shows whether this holds on other recordings."
    if held_out is None or held_out <= 0:
        return "The gain does not hold on the recordings held out: this is over-fitted."
    if held_out >= tuned:
        return "The gain holds on the recordings held out."
    return f"On the recordings held out {held_out / tuned:.0%} of the gain is left."

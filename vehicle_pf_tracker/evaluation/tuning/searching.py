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

"""The search: trials that Optuna proposes, run in batches on all recordings and seeds.

The sampler is seeded and every run is stored under the key of all that determines it, so that the
same search goes through the same trials again. An interrupted search continues without a database:
trials that were run before are reported to the sampler at once, and more trials than before
continue where the last one ended. Results do not depend on the number of workers, since a batch has
the same size for any.
"""

from __future__ import annotations

import csv
import io
import statistics
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import GridCell, VariantSystem, seeds_of
from vehicle_pf_tracker.evaluation.grid.running import Runner
from vehicle_pf_tracker.evaluation.result_store import ResultStore, scoring_digest
from vehicle_pf_tracker.evaluation.tuning.search_space import Dimension
from vehicle_pf_tracker.offline.processes import OnProgress, Progress
from vehicle_pf_tracker.parameters.table import Value


@dataclass(frozen=True, slots=True)
class Objective:
    """A metric of `evaluation.metrics` to maximise or minimise."""

    metric: str
    description: str
    maximise: bool = True

    def better(self, one: float, other: float) -> bool:
        """Return whether `one` is better than `other`."""
        return one > other if self.maximise else one < other


OBJECTIVES: Mapping[str, Objective] = MappingProxyType(
    {
        objective.metric: objective
        for objective in (
            Objective("success_auc", "area under the success curve"),
            Objective("precision_auc", "area under the precision curve"),
            Objective("on_target", "share of visible frames with an error below half the diagonal"),
            Objective("p_error_lt_15px", "share of frames with an error below 15 px"),
            Objective("rmse_px", "RMSE in px", maximise=False),
        )
    }
)
"""Objectives by the name of the metric."""


def mean_of_means(runs: Mapping[str, Sequence[float | None]]) -> float | None:
    """Return the mean over recordings of the mean over their runs; None if a run has no value."""
    means = []
    for values in runs.values():
        known = [value for value in values if value is not None]
        if len(known) < len(values) or not known:
            return None
        means.append(statistics.fmean(known))
    return statistics.fmean(means) if means else None


if TYPE_CHECKING:
    import optuna

BATCH = 6
"""Trials proposed before the first of them is known: enough to keep a few workers busy, few enough
for the sampler to learn (40 trials are 7 batches)."""
START_UP = 10
"""Random trials before the sampler uses what it learnt: Optuna's own default."""


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


@dataclass(frozen=True, slots=True)
class Trial:
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
        Called whenever a run begins or ends.
    """
    study = _study(what)
    trials: list[Trial] = []
    score = _Scorer(what, count, store, runner, on_progress)
    while len(trials) < count:
        asked = [_ask(study, what) for _ in range(min(BATCH, count - len(trials)))]
        values = [_values(what, trial) for trial in asked]
        for trial, tried, result in zip(asked, values, score(values), strict=True):
            _tell(study, trial, result)
            trials.append(Trial(len(trials), tried, result))
    return trials


def best_of(trials: Sequence[Trial], objective: Objective) -> Trial:
    """Return the best trial, of equals the first.

    Raises
    ------
    InputError
        If none could run.
    """
    best: Trial | None = None
    for trial in trials:
        if trial.score is None:
            continue
        if best is None or best.score is None or objective.better(trial.score, best.score):
            best = trial
    if best is None:
        raise InputError(
            "no trial could be scored on all recordings; run `evaluate` on them to see why"
        )
    return best


class _Scorer:
    """Scores candidates: runs what the store lacks, for all of them together."""

    def __init__(
        self,
        what: SearchTask,
        count: int,
        store: ResultStore,
        runner: Runner,
        on_progress: OnProgress,
    ) -> None:
        self._what = what
        self._store = store
        self._runner = runner
        self._on_progress = on_progress
        self._runs = len(what.sources) * len(seeds_of(what.base, what.seeds))
        self._total = self._runs * count
        self._done = 0

    def __call__(self, candidates: Sequence[Mapping[str, Value]]) -> list[float | None]:
        grids = [self._cells(values) for values in candidates]
        missing = {
            cell.key(): cell
            for cells in grids
            for cell in cells or ()
            if self._key(cell) not in self._store
        }
        running: tuple[str, ...] = ()
        for turn in self._runner(list(missing.values())):
            running = tuple(cell.label for cell in turn.running)
            if turn.ended is not None:
                cell, outcome = turn.ended
                metric = self._what.objective.metric
                score = None if outcome.metrics is None else getattr(outcome.metrics, metric)
                if not outcome.reason:
                    self._store.add(self._key(cell), cell.label, {"score": score})
                self._done += 1
            self._on_progress(Progress(self._done, self._total, running))
        # What was there before, or is the same as another trial, is done too.
        self._done = self._done - len(missing) + self._runs * len(candidates)
        return [None if cells is None else self._score(cells) for cells in grids]

    def _cells(self, values: Mapping[str, Value]) -> list[GridCell] | None:
        """Return the runs of a candidate; None if its values do not go together."""
        what = self._what
        try:
            system = what.base.changed("trial", values)
        except InputError:
            return None
        return [
            GridCell(source, system, seed, what.max_diff)
            for source in what.sources
            for seed in seeds_of(system, what.seeds)
        ]

    def _key(self, cell: GridCell) -> str:
        return f"{self._what.objective.metric}-{scoring_digest()[:16]}-{cell.key()}"

    def _score(self, cells: Sequence[GridCell]) -> float | None:
        runs: dict[str, list[float | None]] = {}
        for cell in cells:
            key = self._key(cell)
            score = self._store[key]["score"] if key in self._store else None
            runs.setdefault(cell.source.name, []).append(score)
        return mean_of_means(runs)


def _study(what: SearchTask) -> optuna.Study:
    library = _optuna()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the options below count as experimental in some versions
        sampler = library.samplers.TPESampler(
            seed=what.sampler_seed, n_startup_trials=START_UP, constant_liar=True
        )
    direction = "maximize" if what.objective.maximise else "minimize"
    study: optuna.Study = library.create_study(sampler=sampler, direction=direction)
    base = dict(what.base.parameters)
    if all(dimension.covers(base[dimension.name]) for dimension in what.space):
        study.enqueue_trial({dimension.name: base[dimension.name] for dimension in what.space})
    return study


def _ask(study: optuna.Study, what: SearchTask) -> optuna.Trial:
    return study.ask({dimension.name: _distribution(dimension) for dimension in what.space})


def _distribution(dimension: Dimension) -> Any:
    of = _optuna().distributions
    if dimension.choices:
        return of.CategoricalDistribution(dimension.choices)
    if dimension.kind is int:
        low, high = int(dimension.low), int(dimension.high)
        return of.IntDistribution(low, high, log=dimension.logarithmic)
    return of.FloatDistribution(dimension.low, dimension.high, log=dimension.logarithmic)


def _values(what: SearchTask, trial: optuna.Trial) -> dict[str, Value]:
    return {d.name: d.tidy(trial.params[d.name]) for d in what.space}


def _tell(study: optuna.Study, trial: optuna.Trial, score: float | None) -> None:
    if score is None:
        study.tell(trial, state=_optuna().trial.TrialState.FAIL)
    else:
        study.tell(trial, score)


def _optuna() -> Any:
    try:
        import optuna  # noqa: PLC0415 - an extra
    except ModuleNotFoundError:
        raise InputError(
            "tuning needs the extra [tune]: `pip install 'vehicle_pf_tracker[tune]'`"
        ) from None
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna


def to_csv(trials: Sequence[Trial], objective: Objective) -> str:
    """Write a line for each trial, in order; the first is what the search began with."""
    text = io.StringIO()
    names = list(trials[0].values) if trials else []
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["trial", objective.metric, *names])
    for trial in trials:
        score = "" if trial.score is None else repr(trial.score)
        writer.writerow([trial.number, score, *(trial.values[name] for name in names)])
    return text.getvalue()

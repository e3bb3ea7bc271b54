# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tuning: Optuna proposes parameters, and their runs on recordings score them.

Optuna's journal keeps the trials: an interrupted search goes on, and more trials extend it. A study
has the key of all that decides its scores as its name, so that none of other code or parameters are
taken. A batch has the same size for any number of workers, so that results do not depend on it.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import optuna
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.trial import FrozenTrial, TrialState

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.progress import ShowCount
from vehicle_pf_tracker.evaluation.cache_key import result_key
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import GridCell
from vehicle_pf_tracker.evaluation.grid.running import Runner
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.evaluation.search_space import Space
from vehicle_pf_tracker.evaluation.statistics import mean_of_means, summarise
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.evaluation.tuning_aims import OBJECTIVES
from vehicle_pf_tracker.parameters.table import Value

BATCH = 6
"""Trials proposed before the first of them is known: enough to keep a few workers busy, few enough
for the sampler to learn (40 trials are 7 batches)."""
_DONE = (TrialState.COMPLETE, TrialState.PRUNED)
"""States of trials that are not tried again."""


@dataclass(frozen=True, slots=True)
class SearchTask:
    """A search: the space, and the runs that score a point of it.

    Attributes
    ----------
    base : System
        The first trial; parameters that are not searched keep its values.
    space : mapping of str to BaseDistribution
        Parameters that are searched.
    sources : sequence of Source
        The recordings.
    seeds : sequence of int
        Seeds of the runs.
    objective : str
        The metric to optimise, of `OBJECTIVES`.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    """

    base: System
    space: Space
    sources: Sequence[Source]
    seeds: Sequence[int]
    objective: str
    max_diff: float

    def cells(self, values: Mapping[str, Value]) -> list[GridCell]:
        """Return the runs of a candidate; none if its values do not go together."""
        try:
            system = self.base.changed("trial", values)
        except InputError:
            return []
        return [
            GridCell(source, system, seed, self.max_diff)
            for source in self.sources
            for seed in system.seeds(self.seeds)
        ]

    def key(self) -> str:
        """Return the key of all that decides the search."""
        space = {name: repr(distribution) for name, distribution in self.space.items()}
        runs = [cell.key() for cell in self.cells({})]
        return result_key({"objective": self.objective, "space": space, "runs": runs}, ())


def open_study(what: SearchTask, journal: Path) -> optuna.Study:
    """Open the study of a search in the file `journal`, which may have trials of it already."""
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    study = optuna.create_study(
        storage=JournalStorage(JournalFileBackend(str(journal))),
        study_name=what.key(),
        direction="maximize" if OBJECTIVES[what.objective] else "minimize",
        load_if_exists=True,
    )
    # 1. Close what an interrupted search has left: the sampler would take it for under way.
    for left in study.get_trials(states=[TrialState.RUNNING]):  # when it was interrupted
        study.tell(left.number, state=TrialState.FAIL)
    # 2. Begin with the values of before: no search can then end below them.
    if not study.get_trials():
        base = dict(what.base.parameters)
        study.enqueue_trial({name: base[name] for name in what.space})
    # 3. A sampler whose seed is how far the search is: one that goes on does not draw its first
    # trials again. Trials of a batch do not know each other's scores; the constant liar keeps them
    # apart.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the option counts as experimental in some versions
        study.sampler = optuna.samplers.TPESampler(
            seed=len(study.get_trials(states=_DONE)), constant_liar=True
        )
    return study


def search(
    what: SearchTask, count: int, study: optuna.Study, runner: Runner, on_progress: ShowCount
) -> list[FrozenTrial]:
    """Make trials until there are `count`, and return them in order.

    Trials that could not be scored on all recordings have no value.

    Parameters
    ----------
    what : SearchTask
        The search.
    count : int
        Number of trials.
    study : Study
        Study of `open_study`.
    runner : callable
        Runs cells, see `grid.running`.
    on_progress : callable
        Called with the number of runs done, and of all.
    """
    runs = len(what.cells({}))
    while (done := len(study.get_trials(states=_DONE))) < count:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the first trial may lie outside of a given range
            asked = [study.ask(dict(what.space)) for _ in range(min(BATCH, count - done))]
        # All runs of a batch at once, so that workers do not wait at the end of each trial.
        grids = [what.cells(trial.params) for trial in asked]
        found: dict[GridCell, Any] = {}
        on_progress(done * runs, count * runs)
        for number, (cell, outcome) in enumerate(
            runner([cell for grid in grids for cell in grid]), start=1
        ):
            # Kept by cell: runners give them back in any order.
            found[cell] = outcome.metrics and getattr(outcome.metrics, what.objective)
            on_progress(done * runs + number, count * runs)
        for one, grid in zip(asked, grids, strict=True):
            # A trial without a score on every recording is pruned: it says nothing, and is not
            # repeated.
            scores: dict[str, list[float | None]] = {}
            for cell in grid:
                scores.setdefault(cell.source.name, []).append(found[cell])
            score = mean_of_means(scores)
            study.tell(one, score, state=TrialState.PRUNED if score is None else None)
    return study.get_trials(states=_DONE)[:count]


def check_gain(
    evaluation: ScoredEvaluation, held_out: Sequence[str], objective: str
) -> tuple[list[list[str]], str]:
    """Compare the best parameters with those before, and judge the gain.

    Parameters
    ----------
    evaluation : ScoredEvaluation
        Runs of the parameters before and of the best, all of which succeeded.
    held_out : sequence of str
        Names of the recordings that the search did not see.
    objective : str
        The metric that was optimised, of `OBJECTIVES`.

    Returns
    -------
    rows : list of list of str
        Recording, score before, score of the best, and change; ± is the spread over the seeds.
    verdict : str
        Sentence on whether the gain holds on the recordings held out.
    """
    # 1. Scores by recording, (systems, seeds), those held out apart.
    sign = 1 if OBJECTIVES[objective] else -1
    scores: dict[str, dict[str, Array]] = {"tuned on": {}, "held out": {}}
    for name in (entry.name for entry in evaluation.folder.recordings):
        runs = [evaluation.of(name, system.label) for system in evaluation.folder.systems]
        found = [[getattr(run.metrics, objective) for run in some] for some in runs]
        part = "held out" if name in held_out else "tuned on"
        scores[part][name] = np.array(found, dtype=float)  # None is NaN
    # 2. A row for each recording and for the mean of each part. Gains are by seed: their spread is
    # what chance does.
    rows = []
    gains = []
    for part, by_name in scores.items():
        mean = np.mean(list(by_name.values()), axis=0)
        for name, (base, best) in {**by_name, f"mean of {len(by_name)}": mean}.items():
            rows.append([f"{part}: {name}", _text(base), _text(best), _text(best - base, "+")])
        gains.append(summarise(list(sign * (mean[1] - mean[0]))))
    # 3. The verdict, from what was held out alone; NaN of a missing score is no gain, hence `not
    # >`.
    tuned, other = gains
    assert tuned is not None and other is not None
    low, high = (other.mean if end is None else end for end in (other.low, other.high))
    if not tuned.mean > 0:
        return rows, "With other seeds the best parameters are no better than those before."
    if low > 0:
        share = f"{other.mean:.3f} there, {tuned.mean:.3f} where it was tuned"
        return rows, f"The gain holds on the recordings held out: {share}."
    if high > 0:
        return rows, "The gain on the recordings held out is within the spread of the seeds."
    return rows, "The gain does not hold on the recordings held out: this is over-fitted."


def _text(scores: Array, sign: str = "") -> str:
    spread = f" ± {np.std(scores, ddof=1):.3f}" if len(scores) > 1 else ""
    return f"{np.mean(scores):{sign}.3f}{spread}"

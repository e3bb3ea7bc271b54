# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`tune`: search a variant's parameters on recordings, and validate the best on others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import (
    PROGRAM_NAME,
    counting,
    print_rows,
    stages,
    tell_notice,
    tell_notices,
)
from vehicle_pf_tracker.cli.option_values import NameChoices, positive
from vehicle_pf_tracker.cli.parameter_options import ParameterOptions, configure
from vehicle_pf_tracker.cli.requests import option, positional
from vehicle_pf_tracker.cli.shared_options import MaxDiffOption, SchedulerOption, TopicOption
from vehicle_pf_tracker.cli.system_options import make_system, runner_of, settable
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import Plan
from vehicle_pf_tracker.evaluation.grid.running import complete
from vehicle_pf_tracker.evaluation.grid.sources import describe_recordings, find_recordings
from vehicle_pf_tracker.evaluation.tuning_aims import OBJECTIVES, default_search
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.parameters.table import Value, parse_assignments
from vehicle_pf_tracker.results.output_files import make_folder, write_csv, write_text
from vehicle_pf_tracker.trackers.registry import VARIANTS, find_variant

if TYPE_CHECKING:
    from optuna.trial import FrozenTrial

    from vehicle_pf_tracker.evaluation.tuning import SearchTask

TRIALS = 60
"""Parameter sets that are tried by default: ten batches, from nine of which the sampler
learns."""
SEEDS = 3
"""Runs of each set on each recording: a gain of one lucky seed is not taken for one of the set."""
SEARCH_SEED = 100
"""First seed of the search, beyond those of an evaluation, which begin at 0."""
BEST = "best.yaml"
"""Parameter file of the best set."""
EVALUATION = "evaluation"
"""Folder in which the best set is compared with the first."""
Recordings = Sequence[tuple[Source, dict[int, Truth]]]


@dataclass(frozen=True, kw_only=True)
class Request(ParameterOptions, TopicOption, MaxDiffOption, SchedulerOption):
    """Request of `tune`."""

    sources: Sequence[str] = positional(
        nargs="+", metavar="REC", help="recordings with truth to tune on, or a folder"
    )
    variant: str = option(
        required=True, choices=NameChoices(VARIANTS), metavar="NAME",
        help=f"one of: {', '.join(VARIANTS)}",
    )  # fmt: skip
    output: Path = option(
        "-o", required=True, metavar="DIR",
        help="folder for best.yaml and the other results; finished trials in it are kept, the rest "
        "is written anew",
    )  # fmt: skip
    held_out: Sequence[str] = option(
        nargs="+", default=[], metavar="REC",
        help="held-out recordings, unseen by the search; they show whether its gain is real",
    )  # fmt: skip
    search: Sequence[str] = option(
        action="append", default=[], metavar="NAME[=LOW:HIGH],…",
        help="parameters to search (default: those marked as tuned, "
        f"{', '.join(default_search(find_variant('apf')))} for apf)",
    )  # fmt: skip
    trials: int = option(
        type=positive, default=TRIALS, metavar="N",
        help="parameter sets to try (default: %(default)s)",
    )  # fmt: skip
    seeds: int = option(
        type=positive, default=SEEDS, metavar="N",
        help=f"runs of each on each recording (default: %(default)s), with seeds from "
        f"{SEARCH_SEED} on, so that the gain is judged by others",
    )  # fmt: skip
    objective: str = option(
        default="success_auc", choices=OBJECTIVES, metavar="METRIC",
        help=f"what to improve, of {', '.join(OBJECTIVES)} (default: %(default)s): its mean "
        "over the runs of a recording and then over the recordings",
    )  # fmt: skip


def run(request: Request) -> int:
    """Search, write the results, and print whether the gain holds or how to find out."""
    from vehicle_pf_tracker.evaluation import tuning
    from vehicle_pf_tracker.evaluation.search_space import search_space

    variant = find_variant(request.variant)
    given = [] if request.params is None else [request.params]
    assigned = parse_assignments(settable(variant), request.assignments)
    configuration = configure(variant, given, assigned)
    base = make_system(variant, "", configuration, {})
    words = [word for text in request.search for word in text.split(",") if word]
    space = search_space(variant, dict(base.parameters), words)
    with stages("tune") as on_stage:
        tuned = find_recordings(request.sources)
        held_out = find_recordings(request.held_out)
        locations = [*tuned, *held_out]
        recordings = describe_recordings(locations, request.topic, request.max_diff, on_stage)
    sources = [source for source, _ in recordings[: len(tuned)]]
    for other, _ in recordings[len(tuned) :]:
        if other.digest in {source.digest for source in sources}:
            raise InputError(f"{other.path} is both held out and tuned on; it can only be one")
    seeds = range(SEARCH_SEED, SEARCH_SEED + request.seeds)
    what = tuning.SearchTask(base, space, sources, seeds, request.objective, request.max_diff)
    outputs = [Products(request.output, (BEST,)), Products(request.output / EVALUATION)]
    inputs = (*locations, request.params)
    try:
        with claimed(outputs, inputs, overwrite=True):
            return _tune(request, configuration, what, recordings)
    except KeyboardInterrupt:
        tell_notice("interrupted; run the same command to resume")
        raise


def _tune(
    request: Request, configuration: Configuration, what: SearchTask, recordings: Recordings
) -> int:
    """Search, write trials and best parameters, and judge these where recordings are held out."""
    from vehicle_pf_tracker.evaluation import tuning

    # 1. Search; the log keeps every trial, so that the same command goes on with them.
    folder = make_folder(request.output)
    variant = what.base.kind
    study = tuning.open_study(what, folder / "study.log")
    with counting("tuned", "runs") as on_progress:
        trials = tuning.search(what, request.trials, study, runner_of(request), on_progress)
    # 2. Write the trials, and the parameters of the best one.
    _write_trials(folder / "trials.csv", what, trials)
    best = study.best_trial
    names = ", ".join(source.name for source in what.sources)
    title = (
        f"{variant}: tuned by `{PROGRAM_NAME} tune` on {names}; {what.objective} {best.value:.3f}."
    )
    values = configuration.updated(best.params).to_mapping()
    write_text(folder / BEST, to_yaml(configuration.specs(), values, title))
    first = "no" if trials[0].value is None else f"{trials[0].value:.3f}"
    print(
        f"{what.objective}: {first} at first, {best.value:.3f} in trial {best.number}\n"
        f"the parameters are {folder / BEST}"
    )
    # 3. Judge these where the search has not been.
    if request.held_out:
        return _judge(request, what, best.params, recordings)
    print(
        f"check them on recordings that the search has not seen: --held-out REC, or {PROGRAM_NAME} "
        f"evaluate REC --variants {variant} --params {folder / BEST} -o DIR"
    )
    return 0


def _write_trials(path: Path, what: SearchTask, trials: Sequence[FrozenTrial]) -> None:
    """Write a row for each trial, and raise InputError if none has a score."""
    header = ["trial", what.objective, *what.space]
    rows = (
        [trial.number, trial.value, *(trial.params[name] for name in what.space)]
        for trial in trials
    )
    write_csv(path, header, rows)
    if all(trial.value is None for trial in trials):
        raise InputError(
            "no trial could be scored on all recordings; run `evaluate` on them to see why"
        )


def _judge(
    request: Request, what: SearchTask, values: Mapping[str, Value], recordings: Recordings
) -> int:
    """Compare the best parameters with those before, by other seeds, and print the verdict."""
    from vehicle_pf_tracker.evaluation import tuning
    from vehicle_pf_tracker.evaluation.report.writing import write_report
    from vehicle_pf_tracker.evaluation.tables import markdown

    systems = [what.base, what.base.changed("best", values)]
    seeds = range(request.seeds)
    plan = Plan(dict(recordings), systems, seeds, list(request.command), request.max_diff)
    folder = request.output / EVALUATION
    with counting("compared", "runs") as on_progress:
        complete(plan, folder, runner_of(request), on_progress)
    report = write_report(folder)
    tell_notices(report.failures)
    if report.evaluation.failed:
        raise InputError(f"not every run succeeded; {report.page} says why")
    held_out = [source.name for source, _ in recordings if source not in what.sources]
    rows, verdict = tuning.check_gain(report.evaluation, held_out, what.objective)
    header = [what.objective, "default", "best", "change"]
    write_text(request.output / "tuning.md", f"{markdown(header, rows)}\n{verdict}\n")
    print_rows(header, rows)
    print(verdict)
    return 0

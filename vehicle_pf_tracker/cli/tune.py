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

"""`tune`: search a variant's parameters on recordings, and validate the best on others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli import system_options
from vehicle_pf_tracker.cli.console import counting, print_rows, stages, tell_notice
from vehicle_pf_tracker.cli.requests import (
    MaxDiffOption,
    Names,
    TopicOption,
    WorkersOption,
    natural,
    option,
    positional,
    positive,
)
from vehicle_pf_tracker.cli.tracking_options import StartOptions
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import Plan, VariantSystem
from vehicle_pf_tracker.evaluation.grid.running import complete, on_this_machine
from vehicle_pf_tracker.evaluation.grid.sources import describe, find_recordings
from vehicle_pf_tracker.evaluation.report.writing import write_report
from vehicle_pf_tracker.evaluation.result_store import ResultStore
from vehicle_pf_tracker.evaluation.search_space import OBJECTIVES, default_search, search_space
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.evaluation.tuning import (
    ComparedMetric,
    SearchTask,
    Trial,
    best_of,
    compare,
    search,
    texts,
    to_csv,
    verdict,
)
from vehicle_pf_tracker.offline.output_files import make_folder, write_json, write_text
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

TRIALS, SEEDS, SEARCH_SEED = 60, 3, 100
BEST, EVALUATION = "best", "evaluation"

Recordings = Sequence[tuple[Source, dict[int, Truth]]]


@dataclass(frozen=True, kw_only=True)
class Request(StartOptions, TopicOption, MaxDiffOption, WorkersOption):
    """Request of `tune`."""

    sources: Sequence[str] = positional(
        nargs="+", metavar="REC", help="recordings with truth to tune on, or a folder"
    )
    variant: str = option(
        required=True, choices=Names(VARIANTS), metavar="NAME",
        help=f"one of: {', '.join(VARIANTS)}",
    )  # fmt: skip
    output: Path = option(
        "-o", required=True, metavar="DIR",
        help="folder for best.yaml and the other results; finished runs in it are kept, the rest "
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
        help=f"runs of each on each recording (default: %(default)s); the search takes seeds from "
        f"{SEARCH_SEED} on, the comparison others",
    )  # fmt: skip
    objective: str = option(
        default="success_auc", choices=OBJECTIVES, metavar="METRIC",
        help=f"what to improve, of {', '.join(OBJECTIVES)} (default: %(default)s): its mean over "
        "the runs of a recording and then over the recordings",
    )  # fmt: skip
    sampler_seed: int = option(
        type=natural, default=0, metavar="S", help="seed of the search itself"
    )


def run(request: Request) -> int:
    """Search, compare, write all results, and print the comparison."""
    variant = find_variant(request.variant)
    given = [] if request.params is None else [request.params]
    configuration = system_options.configure(variant, given, request.assignments)
    base = system_options.make_system(variant, "", configuration, {})
    what, recordings = _search(variant, base, request)
    outputs = (Products(request.output, (f"{BEST}.yaml",)), Products(request.output / EVALUATION))
    inputs = (*(source.path for source, _ in recordings), request.params)
    try:
        with claimed(outputs, inputs, overwrite=True):
            return _tune(request, variant, configuration, what, recordings)
    except KeyboardInterrupt:
        tell_notice("interrupted; run the same command to resume")
        raise


def _tune(
    request: Request,
    variant: Variant,
    configuration: Configuration,
    what: SearchTask,
    recordings: Recordings,
) -> int:
    output = make_folder(request.output)
    best = _find_best(what, output, request)
    lines = _compare(what, best, recordings, output / EVALUATION, request)
    told = verdict(lines, what.objective)
    names = ", ".join(source.name for source in what.sources)
    title = f"{variant.name}: tuned by `vehicle-pf-tracker tune` on {names}."
    values = configuration.updated(best.values).to_mapping()
    write_text(output / f"{BEST}.yaml", to_yaml(configuration.specs(), values, title))
    head = f"# {variant.name}, tuned for {what.objective.description}\n\n"
    write_text(output / "tuning.md", f"{head}{markdown(*texts(lines))}\n{told}\n")
    document = {
        "command": request.command,
        "variant": variant.name,
        "objective": what.objective.metric,
        "searched": [str(dimension) for dimension in what.space],
        "best_trial": best.number,
        "best": dict(best.values),
        "comparison": [{**line._asdict(), "change": line.change} for line in lines],
        "verdict": told,
    }
    write_json(output / "tuning.json", document)
    print_rows(*texts(lines))
    print(f"{told}\nthe parameters are {output / BEST}.yaml")
    return 0


def _search(
    variant: Variant, base: VariantSystem, request: Request
) -> tuple[SearchTask, Recordings]:
    words = [word for text in request.search for word in text.split(",") if word]
    space = search_space(variant, dict(base.parameters), words)
    tuned = find_recordings(request.sources)
    held_out = find_recordings(request.held_out)
    with stages("tune") as on_stage:
        recordings = describe([*tuned, *held_out], request.topic, request.max_diff, on_stage)
    sources = [source for source, _ in recordings]
    seen = {source.digest for source in sources[: len(tuned)]}
    for source in sources[len(tuned) :]:
        if source.digest in seen:
            raise InputError(
                f"{source.path} is both held out and tuned on; it can only be one of the two"
            )
    seeds = range(SEARCH_SEED, SEARCH_SEED + request.seeds)
    objective = OBJECTIVES[request.objective]
    what = SearchTask(
        base, space, sources[: len(tuned)], seeds, objective, request.max_diff, request.sampler_seed
    )
    return what, recordings


def _find_best(what: SearchTask, output: Path, request: Request) -> Trial:
    store = ResultStore(output / "runs.jsonl")
    with counting("tuned", "runs") as on_progress:
        trials = search(what, request.trials, store, on_this_machine(request.workers), on_progress)
    write_text(output / "trials.csv", to_csv(trials, what.objective))
    return best_of(trials, what.objective)


def _compare(
    what: SearchTask, best: Trial, recordings: Recordings, folder: Path, request: Request
) -> list[ComparedMetric]:
    systems = [what.base, what.base.changed(BEST, best.values)]
    plan = Plan(
        dict(recordings), systems, range(request.seeds), list(request.command), request.max_diff
    )
    with counting("compared", "runs") as on_progress:
        complete(plan, folder, on_this_machine(request.workers), on_progress)
    report = write_report(folder)
    held_out = [source.name for source, _ in recordings if source not in what.sources]
    metrics = dict.fromkeys([what.objective.metric, "rmse_px"])
    return compare(report.evaluation, held_out, list(metrics))

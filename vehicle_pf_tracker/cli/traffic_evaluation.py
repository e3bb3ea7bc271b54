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

"""Options and run of `evaluate --traffic`: many vehicles, in folders as MOTChallenge has them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError, print_rows
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.system_options import FEW_SEEDS, EvaluationRequest
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import parse_assignments, specs

if TYPE_CHECKING:
    from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
    from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

_GRID_ONLY = (
    "params", "without_defaults", "baseline_model", "scheduler", "timing", "shifted_starts",
    "start_frames", "restarts", "max_rmse", "stress", "topic", "video", "recordings",
    "trajectories", "figures",
)  # fmt: skip
"""Options of the grid and of the battery that do not apply."""
PAGE = "traffic.html"


@dataclass(frozen=True, kw_only=True)
class TrafficRequest(EvaluationRequest):
    """Request of the comparison on many vehicles."""

    GROUP = "many vehicles, instead of the grid"

    traffic: bool = switch(
        help="compare `traffic` with SORT, ByteTrack, OC-SORT and C-BIoU; REC are folders as "
        "MOTChallenge has them; see docs/traffic.md",
    )  # fmt: skip
    detections: str | None = option(
        metavar="NAME,…",
        help="only these files of det/, by name without .txt, and `motion` (default: all)",
    )  # fmt: skip
    perturbations: str | None = option(
        metavar="NAME,…",
        help="only these of dropped, gap20, gap40, squared and halved; `none` for none "
        "(default: all)",
    )  # fmt: skip


def check(request: TrafficRequest) -> None:
    """Refuse options that go with the grid only, or with this comparison only.

    Raises
    ------
    UsageError
        If there is one.
    """
    for name in _GRID_ONLY if request.traffic else ("detections", "perturbations"):
        if getattr(request, name):
            option = "--" + name.replace("_", "-")
            raise UsageError(
                f"{option} does not go {'with' if request.traffic else 'without'} --traffic"
            )


def run(request: TrafficRequest) -> int:
    """Run the comparison, write its report, and print its tables."""
    from vehicle_pf_tracker.evaluation.output_files import write_text
    from vehicle_pf_tracker.evaluation.report.traffic import traffic_page
    from vehicle_pf_tracker.evaluation.traffic.client import TrafficWorker
    from vehicle_pf_tracker.evaluation.traffic.comparison import cases_of, compare
    from vehicle_pf_tracker.evaluation.traffic.comparison_report import (
        MARKDOWN,
        by_case,
        main_table,
        write_traffic_report,
    )
    from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence

    sequences = [read_sequence(Path(source)) for source in request.sources]
    cases = cases_of(sequences, _sources(request, sequences), _perturbations(request))
    parameters = _parameters(request)
    seeds = range(request.first_seed, request.first_seed + (request.seeds or FEW_SEEDS))
    with (
        TrafficWorker(request.baselines_python) as worker,
        counting("compared") as progress,
    ):
        results = list(compare(cases, worker, parameters, seeds, on_progress=progress))
        options = {
            "command": list(request.command),
            "seeds": list(seeds),
            "set": request.assignments,
            **worker.versions,
        }
    lines = write_traffic_report(results, request.output, options)
    write_text(request.output / PAGE, traffic_page(lines, " ".join(request.command)))
    for title, group in by_case(lines):
        print_rows(*main_table(group), title)
    print(f"the report is {request.output / PAGE}, and {MARKDOWN} beside it")
    return 0


def _sources(request: TrafficRequest, sequences: Sequence[TrafficSequence]) -> list[str] | None:
    from vehicle_pf_tracker.evaluation.traffic.comparison import MOTION

    if request.detections is None:
        return None
    known = {MOTION, *(name for sequence in sequences for name in sequence.detections)}
    return _names(request.detections, known, "detections")


def _perturbations(request: TrafficRequest) -> list[str]:
    from vehicle_pf_tracker.evaluation.traffic.perturbation import PERTURBATIONS, UNCHANGED

    if request.perturbations is None:
        return list(PERTURBATIONS)
    if request.perturbations == "none":
        return [UNCHANGED]
    return [UNCHANGED, *_names(request.perturbations, set(PERTURBATIONS), "perturbations")]


def _names(text: str, known: set[str], what: str) -> list[str]:
    names = list(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in known:
            raise InputError(
                f"there are no {what} {name!r}{suggestion(name, known)}; choose from "
                f"{', '.join(sorted(known))}"
            )
    return names


def _parameters(request: TrafficRequest) -> TrafficParameters:
    from vehicle_pf_tracker.parameters.configuration import Configuration
    from vehicle_pf_tracker.trackers.registry import TRAFFIC

    table = specs(TRAFFIC.parameters)
    configuration = Configuration.of(TRAFFIC).updated(parse_assignments(table, request.assignments))
    parameters: TrafficParameters = configuration.tracker
    return parameters

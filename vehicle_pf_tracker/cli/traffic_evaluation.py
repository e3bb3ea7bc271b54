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

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError, print_table
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import parse_assignments, specs

if TYPE_CHECKING:
    from vehicle_pf_tracker.evaluation.traffic.comparison_report import Line
    from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
    from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

SEEDS = 1
"""Seeds of a run: differences between scenes are larger than those between seeds."""
_GRID_ONLY = (
    "params", "without_defaults", "baseline_model", "scheduler", "timing", "shifted_starts",
    "start_frames", "restarts", "max_rmse", "stress", "topic", "video", "recordings",
    "trajectories", "figures",
)  # fmt: skip
"""Options of the grid and of the battery that do not apply."""
PAGE = "traffic.html"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the comparison on many vehicles."""
    add = parser.add_argument_group("many vehicles, instead of the grid").add_argument
    add(
        "--traffic", action="store_true",
        help="compare `traffic` with SORT, ByteTrack, OC-SORT and C-BIoU; REC are folders as "
        "MOTChallenge has them; see docs/traffic.md",
    )  # fmt: skip
    add(
        "--detections", metavar="NAME,…",
        help="only these files of det/, by name without .txt, and `motion` (default: all)",
    )  # fmt: skip
    add(
        "--perturbations", metavar="NAME,…",
        help="only these of dropped, gap20, gap40, squared and halved; `none` for none "
        "(default: all)",
    )  # fmt: skip


def check(args: argparse.Namespace) -> None:
    """Refuse options that go with the grid only, or with this comparison only.

    Raises
    ------
    UsageError
        If there is one.
    """
    for name in _GRID_ONLY if args.traffic else ("detections", "perturbations"):
        if getattr(args, name):
            option = "--" + name.replace("_", "-")
            raise UsageError(
                f"{option} does not go {'with' if args.traffic else 'without'} --traffic"
            )


def run(args: argparse.Namespace) -> int:
    """Run the comparison, write its report, and print its tables."""
    from vehicle_pf_tracker.evaluation.output_files import write_text
    from vehicle_pf_tracker.evaluation.report.traffic import traffic_page
    from vehicle_pf_tracker.evaluation.traffic.client import TrafficWorker
    from vehicle_pf_tracker.evaluation.traffic.comparison import cases_of, compare
    from vehicle_pf_tracker.evaluation.traffic.comparison_report import (
        MARKDOWN,
        write_traffic_report,
    )
    from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence

    sequences = [read_sequence(Path(source)) for source in args.sources]
    cases = cases_of(sequences, _sources(args, sequences), _perturbations(args))
    parameters = _parameters(args)
    seeds = range(args.first_seed, args.first_seed + (args.seeds or SEEDS))
    with (
        TrafficWorker(args.baselines_python) as worker,
        counting("compared") as progress,
    ):
        results = list(compare(cases, worker, parameters, seeds, on_progress=progress))
        options = {
            "command": list(args.command),
            "seeds": list(seeds),
            "set": args.assignments,
            **worker.versions,
        }
    lines = write_traffic_report(results, args.output, options)
    write_text(args.output / PAGE, traffic_page(lines, " ".join(args.command)))
    _show(lines)
    print(f"the report is {args.output / PAGE}, and {MARKDOWN} beside it")
    return 0


def _sources(args: argparse.Namespace, sequences: Sequence[TrafficSequence]) -> list[str] | None:
    from vehicle_pf_tracker.evaluation.traffic.comparison import MOTION

    if args.detections is None:
        return None
    known = {MOTION, *(name for sequence in sequences for name in sequence.detections)}
    return _names(args.detections, known, "detections")


def _perturbations(args: argparse.Namespace) -> list[str]:
    from vehicle_pf_tracker.evaluation.traffic.perturbation import PERTURBATIONS, UNCHANGED

    if args.perturbations is None:
        return list(PERTURBATIONS)
    if args.perturbations == "none":
        return [UNCHANGED]
    return [UNCHANGED, *_names(args.perturbations, set(PERTURBATIONS), "perturbations")]


def _names(text: str, known: set[str], what: str) -> list[str]:
    names = list(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in known:
            raise InputError(
                f"there are no {what} {name!r}{suggestion(name, known)}; choose from "
                f"{', '.join(sorted(known))}"
            )
    return names


def _parameters(args: argparse.Namespace) -> TrafficParameters:
    from vehicle_pf_tracker.parameters.configuration import Configuration
    from vehicle_pf_tracker.trackers.registry import TRAFFIC

    table = specs(TRAFFIC.parameters)
    configuration = Configuration.of(TRAFFIC).updated(parse_assignments(table, args.assignments))
    parameters: TrafficParameters = configuration.tracker
    return parameters


def _show(lines: Sequence[Line]) -> None:
    from rich.table import Table
    from rich.text import Text

    from vehicle_pf_tracker.evaluation.traffic.comparison_report import by_case, main_table

    for title, group in by_case(lines):
        headings, rows = main_table(group)
        table = Table(title=title)
        for heading in headings:
            table.add_column(Text(heading), justify="right")
        for row in rows:
            table.add_row(*map(Text, row))
        print_table(table)

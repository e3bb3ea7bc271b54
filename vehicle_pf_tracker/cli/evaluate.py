# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`evaluate`: compare systems on recordings with truth, over seeds.

With `--traffic`, trackers of many vehicles on folders as MOTChallenge has them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli import console, report
from vehicle_pf_tracker.cli.option_values import names_in, positive
from vehicle_pf_tracker.cli.report import ReportParts
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.shared_options import (
    IdOption,
    MaxDiffOption,
    SchedulerOption,
    TopicOption,
)
from vehicle_pf_tracker.cli.system_options import (
    DEFAULT_SEEDS,
    FEW_SEEDS,
    EvaluationRequest,
    asked_systems,
    runner_of,
)
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.grid.cells import ALL_CELLS, Part, Plan
from vehicle_pf_tracker.evaluation.grid.running import complete
from vehicle_pf_tracker.evaluation.grid.sources import describe_recordings, find_recordings
from vehicle_pf_tracker.parameters.table import parse_assignments, specs

if TYPE_CHECKING:
    from vehicle_pf_tracker.evaluation.report.writing import Report

_GRID_ONLY = (
    "params",
    "baseline_model",
    "max_rmse",
    "topic",
    "id",
    "figures",
    "part",
    "scheduler",
    "restart",
)
"""Options of the grid of systems, recordings and seeds, which `--traffic` refuses."""


@dataclass(frozen=True, kw_only=True)
class Request(
    EvaluationRequest, SchedulerOption, ReportParts, TopicOption, IdOption, MaxDiffOption
):
    """Request of `evaluate`."""

    max_rmse: float | None = option(
        metavar="PX",
        help="end with status 1 if a system's RMSE, mean over seeds and then recordings, is larger",
    )  # fmt: skip
    restart: int | None = option(
        type=positive, metavar="N",
        help="run everything a second time with restarts from the truth N frames after a failure, "
        "as the VOT challenge does (5); docs/scoring.md",
    )  # fmt: skip
    part: Part | None = option(
        type=Part.parse, metavar="K/N",
        help="run only part K of N, each on a machine of its own; `merge` joins their folders",
    )  # fmt: skip
    traffic: bool = switch(
        help="compare `traffic` with SORT, ByteTrack, OC-SORT and C-BIoU instead; REC are folders "
        "as MOTChallenge has them; see docs/traffic_results.md",
    )  # fmt: skip
    detections: str | None = option(
        metavar="NAME,…",
        help="only these files of det/, by name without .txt, and `motion` (default: all)",
    )  # fmt: skip


def check(request: Request) -> None:
    """Refuse options that go with the grid only, or with this comparison only.

    Raises
    ------
    UsageError
        If there is one.
    """
    for name in _GRID_ONLY if request.traffic else ("detections",):
        if getattr(request, name):
            option = "--" + name.replace("_", "-")
            raise console.UsageError(
                f"{option} does not go {'with' if request.traffic else 'without'} --traffic"
            )


def run_traffic(request: Request) -> int:
    """Run the comparison, write its report, and print its tables."""
    from vehicle_pf_tracker.evaluation.traffic import comparison, comparison_report
    from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
    from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE
    from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence
    from vehicle_pf_tracker.parameters.configuration import Configuration
    from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT

    sequences = [read_sequence(Path(source)) for source in request.sources]
    known = {MOTION_SOURCE, *(name for sequence in sequences for name in sequence.detections)}
    only = request.detections
    sources = None if only is None else names_in(only, known, "a file of det/")
    cases = comparison.cases_of(sequences, sources)
    assigned = parse_assignments(specs(TRAFFIC_VARIANT.parameters), request.assignments)
    parameters = Configuration.of(TRAFFIC_VARIANT).updated(assigned).tracker
    seeds = request.some_seeds(FEW_SEEDS)
    with (
        TrafficWorker(request.baselines_python) as worker,
        console.counting("compared") as progress,
    ):
        results = list(comparison.compare(cases, worker, parameters, seeds, on_progress=progress))
        options = {
            "command": list(request.command),
            "seeds": list(seeds),
            "set": request.assignments,
            **worker.versions,
        }
    tables = comparison_report.write_traffic_report(results, request.output, options)
    for title, table in tables.items():
        console.print_rows(*table, title)
    print(f"the report is {request.output / comparison_report.NAME}.md")
    return 0


_SHOWN = ("rmse_px", "median_px", "on_target", "success_auc", "recovered", "failures")
"""Metrics of the table on the terminal, few enough for its width."""


def run(request: Request) -> int:
    """Run the missing cells, write the report, and print the table."""
    check(request)
    sources = request.sources if request.traffic else find_recordings(request.sources)
    try:
        with claimed([Products(request.output)], sources, overwrite=True):
            return run_traffic(request) if request.traffic else _run_grid(request, sources)
    except KeyboardInterrupt:
        if not request.traffic:
            console.tell_notice("interrupted; run the same command to resume")
        raise


def _run_grid(request: Request, sources: Sequence[str]) -> int:
    """Run the missing cells of the grid, and write the report unless a part was asked for."""
    systems, notes = asked_systems(request)
    with console.stages("evaluate") as on_stage:
        recordings = describe_recordings(
            sources, request.topic, request.max_diff, on_stage, request.id
        )
    console.tell_notices(notes)
    seeds = request.some_seeds(DEFAULT_SEEDS)
    command = list(request.command)
    part = request.part or ALL_CELLS
    plan = Plan(dict(recordings), systems, seeds, command, request.max_diff, part, request.restart)
    with console.counting("evaluated", "runs") as on_progress:
        complete(plan, request.output, runner_of(request), on_progress)
    if request.part is not None:
        print(f"part {part.number} of {part.total} is in {request.output}; `merge` joins the parts")
        return 0
    return _judge(report.write(request.output, request), request.max_rmse)


def _judge(written: Report, limit: float | None) -> int:
    """Print the means, and return the status that they give."""
    from vehicle_pf_tracker.evaluation.tables import overall_table, restarts_table

    evaluation = written.evaluation
    aggregates = written.aggregates
    failed = dict.fromkeys((cell.system, cell.reason) for cell in evaluation.failed)
    for system, reason in failed:
        console.tell_notices([f"{system} did not run everywhere: {reason}"])
    if not evaluation.runs:
        console.tell_error("no system could run; the report says why")
        return 1
    console.print_rows(*overall_table(aggregates, _SHOWN).texts())
    if (restarts := restarts_table(aggregates)) is not None:
        title = "With restarts after failure, beside two metrics without"
        console.print_rows(*restarts.texts(), title)
    if failed:
        console.tell_error("not every run succeeded; the report says why")
    errors = {label: metrics["rmse_px"] for label, metrics in aggregates.overall.items()}
    beyond = [
        f"{label} {rmse.mean:.1f} px"
        for label, rmse in errors.items()
        if limit is not None and rmse is not None and rmse.mean > limit
    ]
    if beyond:
        console.tell_error(f"the RMSE is larger than --max-rmse {limit:g} px: {', '.join(beyond)}")
    return int(bool(failed or beyond or written.failures))

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

"""`evaluate`: compare systems on recordings with truth, over seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.cli import report, stress, system_options, traffic_evaluation
from vehicle_pf_tracker.cli.console import print_table, tell_error, tell_notices
from vehicle_pf_tracker.cli.report import ReportParts
from vehicle_pf_tracker.cli.requests import VerbRequest, option, switch
from vehicle_pf_tracker.cli.shared_options import MaxDiffOption, natural, positive
from vehicle_pf_tracker.cli.stress import StressRequest
from vehicle_pf_tracker.cli.traffic_evaluation import TrafficRequest
from vehicle_pf_tracker.cli.work_progress import stages, telling
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.grid.plan import Plan, Robustness
from vehicle_pf_tracker.evaluation.grid.running import Runner, complete, on_this_machine
from vehicle_pf_tracker.evaluation.grid.sources import describe, find_recordings
from vehicle_pf_tracker.evaluation.grid.timing import time_systems
from vehicle_pf_tracker.evaluation.tables import SystemSummary, grid_table, summarise_grid

TIMING_FRAMES = 200


@dataclass(frozen=True, kw_only=True)
class RobustnessOptions(VerbRequest):
    """Runs in addition to the grid."""

    GROUP = "robustness runs, in addition to the grid"

    shifted_starts: bool = switch(
        help="also start on twelve shifted and scaled boxes, with the first seed"
    )
    start_frames: int = option(
        type=natural, default=0, metavar="N",
        help="also start in N other frames, with the first seed",
    )  # fmt: skip
    restarts: bool = switch(help="also run with a new start after each failure, and count those")


@dataclass(frozen=True, kw_only=True)
class Request(RobustnessOptions, StressRequest, TrafficRequest, ReportParts, MaxDiffOption):
    """Request of `evaluate`."""

    scheduler: str | None = option(
        metavar="URL",
        help="run on the Dask cluster of this scheduler, as tcp://host:8786; the workers read the "
        "recordings at the same paths or URLs",
    )  # fmt: skip
    topic: str | None = option(help="the image topic, where recordings have several")
    max_rmse: float | None = option(
        type=float, metavar="PX",
        help="end with status 1 if a system's RMSE, mean over seeds and then recordings, is larger",
    )  # fmt: skip
    timing: bool = switch(
        help="afterwards measure the speed of each system in turn, on an otherwise idle machine"
    )
    timing_frames: int = option(
        type=positive, default=TIMING_FRAMES, metavar="N",
        help="frames per recording for --timing (default: %(default)s)",
    )  # fmt: skip


def run(request: Request) -> int:
    """Run the missing cells, write the report, and print the table."""
    traffic_evaluation.check(request)
    stress.check(request)
    is_grid = not (request.traffic or request.stress)
    sources = find_recordings(request.sources) if is_grid else request.sources
    try:
        with claimed([Products(request.output)], sources, overwrite=True):
            if is_grid:
                return _run_grid(request, sources)
            return stress.run(request) if request.stress else traffic_evaluation.run(request)
    except KeyboardInterrupt:
        if not request.traffic:
            tell_notices(["interrupted; run the same command to resume"])
        raise


def _run_grid(request: Request, sources: Sequence[str]) -> int:
    plan = _plan(request, sources)
    with telling("evaluate") as on_progress:
        complete(plan, request.output, _runner(request), on_progress, _tell)
    if request.timing:
        with telling("timing") as on_progress:
            time_systems(plan, request.output, request.timing_frames, on_progress)
    summaries = summarise_grid(plan, request.output)
    _show(summaries)
    report.write(request.output, request)
    return _judge(summaries, request.max_rmse)


def _tell(notice: str) -> None:
    tell_notices([notice])


def _plan(request: Request, sources: Sequence[str]) -> Plan:
    systems, notes = system_options.chosen(request)
    with stages("evaluate") as on_stage:
        recordings = describe(sources, request.topic, request.max_diff, on_stage)
    tell_notices(notes)
    return Plan(
        dict(recordings),
        systems,
        range(request.first_seed, request.first_seed + (request.seeds or system_options.SEEDS)),
        list(request.command),
        request.max_diff,
        Robustness(request.shifted_starts, request.start_frames, request.restarts),
    )


def _runner(request: Request) -> Runner:
    if request.scheduler is None:
        return on_this_machine(request.workers)
    from vehicle_pf_tracker.evaluation.grid.cluster import on_cluster

    return on_cluster(request.scheduler)


def _show(summaries: Sequence[SystemSummary]) -> None:
    print_table(grid_table(summaries))
    for summary in summaries:
        for reason in dict.fromkeys(summary.reasons):
            tell_notices([f"{summary.label} did not run everywhere: {reason}"])


def _judge(summaries: Sequence[SystemSummary], limit: float | None) -> int:
    if not any(summary.runs for summary in summaries):
        tell_error("no system could run; the report says why")
        return 1
    status = 0
    if failed := [summary.label for summary in summaries if summary.reasons]:
        tell_error(f"not every run succeeded: {', '.join(failed)}; the report says why")
        status = 1
    if limit is None:
        return status
    means = {summary.label: summary.mean("rmse_px") for summary in summaries}
    beyond = {name: mean for name, mean in means.items() if mean is not None and mean > limit}
    if not beyond:
        return status
    told = ", ".join(f"{name} {mean:.1f} px" for name, mean in beyond.items())
    tell_error(f"the RMSE is larger than --max-rmse {limit:g} px: {told}")
    return 1

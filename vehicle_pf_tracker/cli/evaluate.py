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

import argparse
from collections.abc import Sequence
from pathlib import Path

from vehicle_pf_tracker.cli import report, stress, system_options, traffic_evaluation
from vehicle_pf_tracker.cli.console import print_table, tell_error, tell_notices
from vehicle_pf_tracker.cli.shared_options import add_max_diff, add_workers, natural, positive
from vehicle_pf_tracker.cli.work_progress import stages, telling
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.grid.plan import Plan, Robustness
from vehicle_pf_tracker.evaluation.grid.running import Runner, complete, on_this_machine
from vehicle_pf_tracker.evaluation.grid.sources import describe, find_recordings
from vehicle_pf_tracker.evaluation.grid.timing import time_systems
from vehicle_pf_tracker.evaluation.tables import SystemSummary, grid_table, summarise_grid

SEEDS = 5
TIMING_FRAMES = 200


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add(
        "sources", nargs="+", metavar="REC",
        help="rosbag2 folder or MCAP file with truth, a folder of such, or a URL of one",
    )  # fmt: skip
    add(
        "-o", "--output", type=Path, required=True, metavar="DIR",
        help="evaluation folder; finished runs in it are kept, the report is written anew",
    )  # fmt: skip
    system_options.add_arguments(parser)
    add(
        "--seeds", type=positive, metavar="N",
        help=f"seeds of each stochastic system (default: {SEEDS}, with --stress "
        f"{stress.SEEDS})",
    )  # fmt: skip
    add("--first-seed", type=natural, default=0, metavar="S", help="the first of the seeds")
    add_workers(parser)
    add(
        "--scheduler", metavar="URL",
        help="run on the Dask cluster of this scheduler, as tcp://host:8786; the workers read the "
        "recordings at the same paths or URLs",
    )  # fmt: skip
    add("--topic", help="the image topic, where recordings have several")
    add_max_diff(parser)
    add(
        "--max-rmse", type=float, metavar="PX",
        help="end with status 1 if a system's RMSE, mean over seeds and then recordings, is larger",
    )  # fmt: skip
    _add_timing(parser)
    report.add_report_options(parser)
    _add_robustness(parser)
    stress.add_arguments(parser)
    traffic_evaluation.add_arguments(parser)


def _add_timing(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "--timing", action="store_true",
        help="afterwards measure the speed of each system in turn, on an otherwise idle machine",
    )  # fmt: skip
    add(
        "--timing-frames", type=positive, default=TIMING_FRAMES, metavar="N",
        help="frames per recording for --timing (default: %(default)s)",
    )  # fmt: skip


def _add_robustness(parser: argparse.ArgumentParser) -> None:
    robust = parser.add_argument_group("robustness runs, in addition to the grid")
    robust.add_argument(
        "--shifted-starts", action="store_true",
        help="also start on twelve shifted and scaled boxes, with the first seed",
    )  # fmt: skip
    robust.add_argument(
        "--start-frames", type=natural, default=0, metavar="N",
        help="also start in N other frames, with the first seed",
    )  # fmt: skip
    robust.add_argument(
        "--restarts", action="store_true",
        help="also run with a new start after each failure, and count those",
    )  # fmt: skip


def run(args: argparse.Namespace) -> int:
    """Run the missing cells, write the report, and print the table."""
    traffic_evaluation.check(args)
    stress.check(args)
    is_grid = not (args.traffic or args.stress)
    sources = find_recordings(args.sources) if is_grid else args.sources
    try:
        with claimed([Products(args.output)], sources, overwrite=True):
            if is_grid:
                return _run_grid(args, sources)
            return stress.run(args) if args.stress else traffic_evaluation.run(args)
    except KeyboardInterrupt:
        if not args.traffic:
            tell_notices(["interrupted; run the same command to resume"])
        raise


def _run_grid(args: argparse.Namespace, sources: Sequence[str]) -> int:
    plan = _plan(args, sources)
    with telling("evaluate") as on_progress:
        complete(plan, args.output, _runner(args), on_progress, _tell)
    if args.timing:
        with telling("timing") as on_progress:
            time_systems(plan, args.output, args.timing_frames, on_progress)
    summaries = summarise_grid(plan, args.output)
    _show(summaries)
    report.write(args.output, args)
    return _judge(summaries, args.max_rmse)


def _tell(notice: str) -> None:
    tell_notices([notice])


def _plan(args: argparse.Namespace, sources: Sequence[str]) -> Plan:
    systems, notes = system_options.chosen(args)
    with stages("evaluate") as on_stage:
        recordings = describe(sources, args.topic, args.max_diff, on_stage)
    tell_notices(notes)
    return Plan(
        dict(recordings),
        systems,
        range(args.first_seed, args.first_seed + (args.seeds or SEEDS)),
        args.command,
        args.max_diff,
        Robustness(args.shifted_starts, args.start_frames, args.restarts),
    )


def _runner(args: argparse.Namespace) -> Runner:
    if args.scheduler is None:
        return on_this_machine(args.workers)
    from vehicle_pf_tracker.evaluation.grid.cluster import on_cluster

    return on_cluster(args.scheduler)


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

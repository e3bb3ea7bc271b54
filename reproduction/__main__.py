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

"""`python -m reproduction`: the papers' experiments as data, figure and verdict."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from reproduction.catalogue import (
    ALL,
    EXPERIMENTS,
    PAPERS,
    find_experiments,
)
from reproduction.experiment import (
    QUICK_SEEDS,
    SEEDS,
    Experiment,
    Holds,
    Size,
)
from reproduction.output import write_report
from reproduction.page import write_page
from reproduction.running import complete
from vehicle_pf_tracker.cli.console import USAGE, UsageError, telling
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.requests import WorkersOption, add_options, natural, positive
from vehicle_pf_tracker.evaluation.result_store import ResultStore

PROGRAM = "python -m reproduction"
CELLS = "cells.jsonl"
"""File in the output folder with what was run so far."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv`, that of the process if None, and return the exit status."""
    words = sys.argv[1:] if argv is None else argv
    return exit_status(lambda: _run(words), PROGRAM)


def _run(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog=PROGRAM, description="Make the papers' figures again.")
    _add_arguments(parser)
    try:
        args = parser.parse_args(words)
    except SystemExit as ended:  # argparse has said all there is to say
        return ended.code if isinstance(ended.code, int) else USAGE
    return _reproduce_all(args)


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("figures", nargs="*", metavar="FIGURE", help=f"{ALL}, or some of: {', '.join(EXPERIMENTS)}")
    add("--list", action="store_true", help="list the figures and tables")
    add(
        "-o", "--output", type=Path, default=Path("results/reproduce"), metavar="DIR",
        help="folder for the results; what was run there before is not run again "
        "(default: results/reproduce)",
    )  # fmt: skip
    add("--seeds", type=positive, metavar="N", help=f"runs of each kind (default: {SEEDS})")
    add(
        "--first-seed", type=natural, default=0, metavar="S",
        help="the first of the seeds; to try things out take others than 0 to 9, from 100 on",
    )  # fmt: skip
    add_options(parser, WorkersOption)
    add(
        "--quick", action="store_true",
        help=f"coarse grids and {QUICK_SEEDS} seeds, to see that everything works",
    )  # fmt: skip
    add(
        "--docs", type=Path, metavar="DIR",
        help="also write reproduction.md with the figures into this folder, of all that is in the "
        "output folder",
    )  # fmt: skip


def _reproduce_all(args: argparse.Namespace) -> int:
    """Run what is missing, write the reports, and print the verdicts."""
    if args.list:
        print("\n".join(f"{e.name}: {e.title}" for e in EXPERIMENTS.values()))
        return 0
    if not args.figures:
        raise UsageError(f"name a FIGURE, or {ALL}; `{PROGRAM} --list` shows them")
    experiments = find_experiments(args.figures)
    count = args.seeds or (QUICK_SEEDS if args.quick else SEEDS)
    size = Size(range(args.first_seed, args.first_seed + count), args.quick)
    store = ResultStore(args.output / CELLS)
    for experiment in experiments:
        holds = _reproduce(experiment, size, store, args)
        print(f"{experiment.name}: {holds.value}  ({experiment.title})", flush=True)
    print(f"results are in {args.output}")
    if args.docs is not None:
        command = f"{PROGRAM} {ALL} --docs {args.docs}"
        page = write_page(args.docs, args.output, PAPERS, command)
        print(f"the page is {page}")
    return 0


def _reproduce(
    experiment: Experiment, size: Size, store: ResultStore, args: argparse.Namespace
) -> Holds:
    with telling(experiment.name) as on_progress:
        results = complete(experiment.cells(size), store, args.workers, on_progress)
    report = experiment.report(results, size)
    write_report(args.output / experiment.name, experiment, report, size)
    return report.verdict.holds


if __name__ == "__main__":
    sys.exit(main())

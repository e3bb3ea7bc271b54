# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`python -m reproduction`: the papers' experiments as data, figure and verdict."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from laboratory.result_store import ResultStore
from reproduction.catalogue import ALL, EXPERIMENTS, PAPERS, find_experiments
from reproduction.experiment import EXPERIMENT_SEEDS, QUICK_SEEDS, Size
from reproduction.pages.output import write_report
from reproduction.pages.page import write_page
from reproduction.runs.running import complete
from vehicle_pf_tracker.cli.console import USAGE_STATUS, UsageError, counting
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.option_values import natural, positive
from vehicle_pf_tracker.cli.requests import add_options, option, positional, request_of, switch
from vehicle_pf_tracker.cli.shared_options import WorkersOption

PROGRAM = "python -m reproduction"
CELLS = "cells.jsonl"
"""File in the output folder with what was run so far."""


@dataclass(frozen=True, kw_only=True)
class Request(WorkersOption):
    """Request of experiments."""

    figures: Sequence[str] = positional(
        nargs="*", metavar="FIGURE", help=f"{ALL}, or some of: {', '.join(EXPERIMENTS)}"
    )
    list: bool = switch(help="list the figures and tables")
    output: Path = option(
        "-o", type=Path, default=Path("results/reproduce"), metavar="DIR",
        help="folder for the results; what was run there before is not run again "
        "(default: results/reproduce)",
    )  # fmt: skip
    seeds: int | None = option(
        type=positive, metavar="N", help=f"runs of each kind (default: {EXPERIMENT_SEEDS})"
    )
    first_seed: int = option(
        type=natural, default=0, metavar="S",
        help="the first of the seeds; to try things out take others than 0 to 9, from 100 on",
    )  # fmt: skip
    quick: bool = switch(help=f"coarse grids and {QUICK_SEEDS} seeds, to see that everything works")
    docs: Path | None = option(
        type=Path, metavar="DIR",
        help="also write reproduction.md with the figures into this folder, of all that is in the "
        "output folder",
    )  # fmt: skip


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv`, that of the process if None, and return the exit status."""
    words = sys.argv[1:] if argv is None else list(argv)
    return exit_status(lambda: _run(words), PROGRAM)


def _run(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog=PROGRAM, description="Make the papers' figures again.")
    add_options(parser, Request)
    parser.set_defaults(command=[PROGRAM, *words])
    try:
        args = parser.parse_args(words)
    except SystemExit as ended:  # argparse has said all there is to say
        return ended.code if isinstance(ended.code, int) else USAGE_STATUS
    return _reproduce_all(request_of(Request, args))


def _reproduce_all(request: Request) -> int:
    """Run what is missing, write the reports, and print the verdicts."""
    if request.list:
        print("\n".join(f"{e.name}: {e.title}" for e in EXPERIMENTS.values()))
        return 0
    if not request.figures:
        raise UsageError(f"name a FIGURE, or {ALL}; `{PROGRAM} --list` shows them")
    experiments = find_experiments(request.figures)
    count = request.seeds or (QUICK_SEEDS if request.quick else EXPERIMENT_SEEDS)
    size = Size(range(request.first_seed, request.first_seed + count), request.quick)
    store = ResultStore(request.output / CELLS)
    for experiment in experiments:
        with counting(f"{experiment.name}: did", "runs") as on_progress:
            results = complete(experiment.cells(size), store, request.workers, on_progress)
        report = experiment.report(results, size)
        write_report(request.output / experiment.name, experiment, report, size)
        print(f"{experiment.name}: {report.verdict.holds.value}  ({experiment.title})", flush=True)
    print(f"results are in {request.output}")
    if request.docs is not None:
        command = f"{PROGRAM} {ALL} --docs {request.docs}"
        print(f"the page is {write_page(request.docs, request.output, PAPERS, command)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""`reproduce`: the papers' experiments as data, figure and verdict."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle_pf_tracker.cli.console import PROGRAM, UsageError
from vehicle_pf_tracker.cli.shared_options import add_workers
from vehicle_pf_tracker.cli.whole_numbers import natural, positive
from vehicle_pf_tracker.cli.work_progress import telling
from vehicle_pf_tracker.evaluation.experiments.catalogue import (
    ALL,
    EXPERIMENTS,
    PAPERS,
    find_experiments,
)
from vehicle_pf_tracker.evaluation.experiments.experiment import (
    QUICK_SEEDS,
    SEEDS,
    Experiment,
    Size,
)
from vehicle_pf_tracker.evaluation.experiments.output import write_document, write_report
from vehicle_pf_tracker.evaluation.experiments.running import complete
from vehicle_pf_tracker.evaluation.experiments.verdict import Holds
from vehicle_pf_tracker.evaluation.result_store import ResultStore

CELLS = "cells.jsonl"
"""File in the output folder with what was run so far."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
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
    add_workers(parser)
    add(
        "--quick", action="store_true",
        help=f"coarse grids and {QUICK_SEEDS} seeds, to see that everything works",
    )  # fmt: skip
    add(
        "--docs", type=Path, metavar="DIR",
        help="also write reproduction.md with the figures into this folder, of all that is in the "
        "output folder",
    )  # fmt: skip


def run(args: argparse.Namespace) -> int:
    """Run what is missing, write the reports, and print the verdicts."""
    if args.list:
        print("\n".join(f"{e.name}: {e.title}" for e in EXPERIMENTS.values()))
        return 0
    if not args.figures:
        raise UsageError(f"reproduce wants FIGURE…, or {ALL}; `reproduce --list` shows them")
    experiments = find_experiments(args.figures)
    count = args.seeds or (QUICK_SEEDS if args.quick else SEEDS)
    size = Size(range(args.first_seed, args.first_seed + count), args.quick)
    store = ResultStore(args.output / CELLS)
    for experiment in experiments:
        holds = _reproduce(experiment, size, store, args)
        print(f"{experiment.name}: {holds.value}  ({experiment.title})", flush=True)
    print(f"results are in {args.output}")
    if args.docs is not None:
        command = f"{PROGRAM} reproduce {ALL} --docs {args.docs}"
        page = write_document(args.docs, args.output, PAPERS, command)
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

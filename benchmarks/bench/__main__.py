# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measure everything, and write `bench.json`: `python -m benchmarks.bench [--quick | --toy]`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from fnmatch import fnmatch
from importlib.util import find_spec
from pathlib import Path

import cv2

from benchmarks.bench import bandwidth, costs, kernels, memory, performance_page, steps
from benchmarks.bench.case import Case
from benchmarks.bench.effort import FULL, QUICK, TOY, Effort
from benchmarks.bench.environment import describe
from benchmarks.bench.results import Results
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels.interface import compile_all

OUTPUT = Path("results/bench/bench.json")
"""Results of a run that counts."""
TOY_FOLDER = Path("results/bench_toy")
"""Folder of a run that only shows that everything works; it replaces no page."""


def main() -> int:
    """Run the benchmarks; 1 where something that they need is missing."""
    args = _arguments()
    # One thread: with more, OpenCV's share of the cores would decide a ratio.
    cv2.setNumThreads(1)
    # A domain of its own: nodes of another run on this machine are not heard.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
    effort = TOY if args.toy else QUICK if args.quick else FULL
    patterns = args.only or effort.cases
    command = " ".join(["python -m benchmarks.bench", *sys.argv[1:]])
    results = Results(describe(), [command])
    compile_all("auto")  # else the first step that needs a kernel would be measured with it
    try:
        _measure(
            results, lambda name: any(fnmatch(name, pattern) for pattern in patterns), effort, args
        )
    except InputError as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    # The results before the page, which may fail and is made again from them.
    results.save(args.output)
    performance_page.write_targets(results, args.output.parent)
    print(f"wrote {args.output}")
    if args.docs is not None:
        _write_page(results, args.docs)
    return 0


def _write_page(results: Results, folder: Path) -> None:
    """Write the page, and print last what is dearer than on the one that it replaces."""
    dearer = performance_page.write(results, folder)
    print(f"wrote {folder / performance_page.PAGE}")
    print(dearer)


def _measure(
    results: Results, wanted: Callable[[str], bool], effort: Effort, args: argparse.Namespace
) -> None:
    results.cases += _told(kernels.measure(wanted, effort))
    results.cases += _told(bandwidth.measure(wanted, effort))
    of_steps, results.on_target = steps.measure(wanted, effort, args.baselines)
    results.cases += _told(of_steps)
    results.cases += _told(costs.measure(wanted, effort))
    # In processes of their own, whatever this one has loaded by now.
    results.memory += memory.measure(wanted)
    if find_spec("rclpy") is None:
        print("no rclpy here: the nodes are left out", file=sys.stderr)
    else:
        _measure_nodes(results, wanted, effort)
    for one in results.memory:
        print(f"{one.name:48} {one.ours_mb:10.1f} MB {one.baseline_mb:10.1f} MB")
    for delivery in results.deliveries:
        print(f"{delivery.name:48} {delivery.lost} of {delivery.sent} lost")


def _measure_nodes(results: Results, wanted: Callable[[str], bool], effort: Effort) -> None:
    from benchmarks.bench import nodes, startup  # noqa: PLC0415 - they need ROS

    results.cases += _told(startup.measure(wanted, effort))
    of_nodes, resident = nodes.measure(wanted, effort)
    results.cases += _told(of_nodes)
    results.memory += resident
    results.deliveries += nodes.fleet(wanted, effort)


def _told(cases: Iterable[Case]) -> Iterator[Case]:
    for case in cases:
        print(
            f"{case.name:48} {case.ours_ms:10.4f} ms {case.baseline_ms:10.4f} ms "
            f"{case.ratio:8.2f}x  +- {case.spread / 2:.2f}",
            flush=True,
        )
        yield case


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.bench", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="rough numbers in about a minute")
    parser.add_argument(
        "--toy",
        type=Path,
        nargs="?",
        const=TOY_FOLDER,
        metavar="DIR",
        help="run some cases of every part once, and write into this folder only "
        f"(default: {TOY_FOLDER})",
    )
    parser.add_argument(
        "--only", nargs="+", metavar="PATTERN", help="cases by name, as step/*/csrt"
    )
    parser.add_argument(
        "--baselines",
        type=Path,
        help="interpreter with OpenCV's contrib trackers; see `make baselines`",
    )
    parser.add_argument("-o", "--output", type=Path, default=OUTPUT)
    parser.add_argument(
        "--docs",
        type=Path,
        metavar="DIR",
        help=f"also write {performance_page.PAGE} and its figures into this folder, and name steps "
        "that became slower than its figures",
    )
    args = parser.parse_args()
    # A toy run must not replace results or pages of a run that counts.
    if args.toy is not None:
        args.output = args.toy / OUTPUT.name
        args.docs = args.toy
    return args


if __name__ == "__main__":
    raise SystemExit(main())

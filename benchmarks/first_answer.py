# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time from a node's start to its first answered image: `python -m benchmarks.first_answer`.

A camera shows images all the time, as one does that was there before. Prints wall seconds until
the node says that it is ready, and until an image is answered with a position: of the floor (a node
that only answers), of `apf` with compiled kernels kept, and of `apf` with nothing compiled.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from benchmarks.bench.camera import Camera
from benchmarks.bench.processes import NodeProcess, floor_words, tracker_words
from vehicle_pf_tracker.core.errors import InputError

_IMAGE = "/bench/first"
_ANSWERS = {"floor": "/floor/position", "warm": "/apf_tracker/position"}
"""Position topic by kind; a cold start has that of the warm one."""
KINDS = ("floor", "warm", "cold")
"""Kinds of starts, the cheapest first: a warm one leaves nothing for the cold one behind."""


def main() -> int:
    """Print the table; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.first_answer", description=__doc__)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--rounds", type=int, default=3, help="starts of each kind, in turns")
    args = parser.parse_args()
    # A domain of its own: nodes of another run on this machine are not heard.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
    try:
        times = _measure(args.kinds, args.rounds)
    except InputError as error:
        print(f"first_answer: {error}", file=sys.stderr)
        return 1
    print("| start | ready, s | first answer, s |\n| --- | ---: | ---: |")
    for kind, pairs in times.items():
        ready, answer = (statistics.median(seconds) for seconds in zip(*pairs, strict=True))
        print(f"| {kind} | {ready:.2f} | {answer:.2f} |")
    return 0


def _measure(kinds: Sequence[str], rounds: int) -> dict[str, list[tuple[float, float]]]:
    """Start each kind in turns; seconds until ready and until the first answer, by kind."""
    if "warm" in kinds:
        start("warm")  # not counted: it compiles, and keeps the kernels for those that are
    times: dict[str, list[tuple[float, float]]] = {kind: [] for kind in kinds}
    for _ in range(rounds):
        for kind in kinds:
            times[kind].append(start(kind))
    return times


def start(kind: str) -> tuple[float, float]:
    """Start a node before a running camera; seconds until it is ready, and until it answers.

    Raises
    ------
    InputError
        If it ends at once, or answers no image.
    """
    with (
        tempfile.TemporaryDirectory() as empty,
        Camera({_IMAGE: _ANSWERS["floor" if kind == "floor" else "warm"]}) as camera,
        ThreadPoolExecutor(1) as thread,
    ):
        began = time.monotonic()
        answered = thread.submit(camera.first_answer, _IMAGE)
        # An empty cache: numba has to compile everything.
        environment = {"NUMBA_CACHE_DIR": empty} if kind == "cold" else {}
        with NodeProcess(_words(kind), environment):
            ready = time.monotonic() - began
            return ready, answered.result() - began


def _words(kind: str) -> Sequence[str]:
    return floor_words(_IMAGE) if kind == "floor" else tracker_words("apf", _IMAGE)


if __name__ == "__main__":
    raise SystemExit(main())

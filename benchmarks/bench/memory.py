# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory that trackers keep: `… memory VARIANT COUNT` prints MB with one and with COUNT."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from benchmarks.bench.costs import BENCHED_VARIANTS
from benchmarks.bench.material import drive
from benchmarks.bench.resident import resident_mb
from benchmarks.bench.root import ROOT
from benchmarks.bench.turns import Own

TRACKERS = 64
"""Trackers in the larger process: the share of one is then clear of what libraries keep."""
_STEPS = 5
"""Steps of each: all that a tracker keeps is there after two."""


@dataclass(frozen=True)
class MemoryCase:
    """Resident memory of ours and of what it is compared with, in MB."""

    name: str
    ours_mb: float
    baseline_mb: float


def measure(wanted: Callable[[str], bool]) -> Iterator[MemoryCase]:
    """Measure ``memory/trackers/VARIANT``: a process with `TRACKERS` trackers and with one."""
    for variant in BENCHED_VARIANTS:
        name = f"memory/trackers/{variant}/{TRACKERS}"
        if wanted(name):
            words = [sys.executable, "-m", "benchmarks.bench.memory", variant, str(TRACKERS)]
            # A process of its own: allocators keep what earlier work has freed.
            done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True)
            one, many = map(float, done.stdout.split())
            yield MemoryCase(name, many, one)


def main(variant: str, count: int) -> None:
    """Let one tracker follow, then `count` more, and print what was resident each time."""
    frames, boxes = drive()
    # Kept, so that the second figure has the first tracker in it, too: 65 against 1.
    kept = []
    for number in (1, count):
        trackers = Own(variant, count=number)
        trackers.start(frames[0], boxes[0], seed=0)
        for frame in frames[1 : 1 + _STEPS]:
            trackers.step(frame)
        kept.append(trackers)
        print(resident_mb())


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""CPU of a node's process until it says that it is ready: with compiled kernels kept, and without.

The start with kept kernels is measured after one that leaves them behind.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator

from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.processes import NodeProcess, floor_words, tracker_words

_IMAGE = "/bench/nothing"
"""A topic without images: only the start is measured."""


def measure(wanted: Callable[[str], bool], effort: Effort) -> Iterator[Case]:
    """Measure ``startup/apf/…``: warm against the floor and against no numba; cold against warm.

    Raises
    ------
    InputError
        If a node does not start.
    """
    pairs = {
        "startup/apf/warm": ("warm", "floor"),
        "startup/apf/numba": ("warm", "opencv"),
        "startup/apf/cold": ("cold", "warm"),
    }
    chosen = {name: pair for name, pair in pairs.items() if wanted(name)}
    kinds = sorted({kind for pair in chosen.values() for kind in pair})
    if not kinds:
        return
    # Not counted: it leaves compiled kernels behind for those that are.
    _start("warm")
    times: dict[str, list[float]] = {kind: [] for kind in kinds}
    for number in range(effort.starts):
        for kind in kinds:
            if kind != "cold" or number % 2 == 0:  # it takes as long as all the others
                times[kind].append(_start(kind))
    for name, (ours, baseline) in chosen.items():
        # In pairs: of cold starts there are half as many.
        rounds = min(len(times[ours]), len(times[baseline]))
        yield Case.of(name, times[ours][:rounds], times[baseline][:rounds])


def _start(kind: str) -> float:
    """CPU seconds until a node is ready."""
    kernels = "opencv" if kind == "opencv" else "auto"
    words = tracker_words("apf", _IMAGE, kernels=kernels)
    if kind == "floor":
        words = floor_words(_IMAGE)
    with tempfile.TemporaryDirectory() as empty:
        # An empty cache: numba has to compile everything.
        environment = {"NUMBA_CACHE_DIR": empty} if kind == "cold" else {}
        with NodeProcess(words, environment) as node:
            return node.cpu_seconds

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Distance of each kernel from memory bandwidth, the limit that no code can pass.

A kernel has to fetch the part of the frame that its windows cover. The baseline reads as many
bytes, once, from memory that no cache holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.interleaving import compare
from benchmarks.bench.kernels import contests
from benchmarks.bench.material import clouds, drive
from benchmarks.bench.routes import routes
from vehicle_pf_tracker.image.windows.bin_counting import covered_region
from vehicle_pf_tracker.image.windows.window import Window, bounds

MEASURED = (
    "joint512/41x31/vga/n200",
    "joint512/41x31/vga/n1000",
    "three_features/41x31/vga/n200",
)
"""Cases of the kernels that are compared: the default, many particles, and all of `mfpf`."""
_WINDOW = Window(20, 15)
"""Window of these cases: the default of 41x31 px."""
_LARGER_THAN_CACHES = 1 << 28
"""Bytes of the memory that is read by turns: several times the last cache of a large server."""
_STRIDE = 7 << 20
"""Bytes between the beginnings of two reads: none begins where one before has ended."""


def measure(wanted: Callable[[str], bool], effort: Effort) -> Iterator[Case]:
    """Measure ``bandwidth/KERNEL``; the ratio is the share of the bandwidth that is reached."""
    names = [name for name in MEASURED if wanted(f"bandwidth/{name}")]
    if not names:
        return
    # The best kernels of this machine: the question is what is left to gain.
    route = next(iter(routes()))
    makers = contests(route)
    memory = np.ones(_LARGER_THAN_CACHES, np.uint8)
    for name in names:
        kernel, _ = makers[f"{route.name}/{name}"]()
        count = touched_bytes(int(name.rpartition("/n")[2]))

        def read(number: int, count: int = count) -> object:
            # Another part each time, so that no cache has it.
            first = number * _STRIDE % (_LARGER_THAN_CACHES - count)
            # The maximum touches every byte, and does little else.
            return memory[first : first + count].max()

        yield compare(f"bandwidth/{name}", kernel, read, effort.case_seconds)


def touched_bytes(particles: int) -> int:
    """Count the bytes of the frame that the windows of a cloud cover together."""
    # In the middle of the drive, where the whole cloud is in the image.
    first = len(drive().frames) // 2
    frame = drive().frames[first]
    centre = drive().boxes[first].centre
    windows = bounds(frame, clouds(centre, particles, 1)[0], _WINDOW)
    return int(covered_region(frame, windows)[0].size)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory of libraries that a node needs while it starts, and not afterwards.

Linking compiled kernels reads some 45 MB of LLVM's library, a quarter of a node's resident memory.
Given back, these pages stay in the system's cache as long as it has room; a later call into the
library reads what it needs again.
"""

from __future__ import annotations

import ctypes
import mmap
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

LINKER = "libllvmlite"
"""LLVM's library, which nothing calls once kernels are loaded: 45 MB of it are resident then."""
SMAPS = Path("/proc/self/smaps")
"""Areas of this process's address space, each with the file that it is of, and its sizes."""
_AREA = r"^([0-9a-f]+)-([0-9a-f]+) (\S+) .*/{}.*\n((?:\w+:.*\n)+)"
"""An area of a file there: addresses, permissions, and lines of sizes; to be given its name."""
_SIZE = re.compile(r"(\w+): +(\d+) kB")


class Area(NamedTuple):
    """Part of the address space.

    Attributes
    ----------
    start, end : int
        Addresses.
    resident : int
        Resident memory, kB.
    """

    start: int
    end: int
    resident: int


def give_back_library(name: str) -> int:
    """Give the pages of a shared library back to the system; code that it runs goes on.

    Parameters
    ----------
    name : str
        Beginning of the name of its file.

    Returns
    -------
    int
        Resident memory of these pages before, kB; 0 where the system cannot take them.
    """
    advice = getattr(mmap, "MADV_DONTNEED", None)
    try:
        areas = list(unchanged_areas(name))
    except OSError:  # no Linux, or a container that hides it
        return 0
    advise = getattr(ctypes.CDLL(None), "madvise", None)
    if advise is None or advice is None:
        return 0
    given = 0
    for area in areas:
        size = ctypes.c_size_t(area.end - area.start)
        if advise(ctypes.c_void_p(area.start), size, advice) == 0:
            given += area.resident
    return given


def unchanged_areas(name: str) -> Iterator[Area]:
    """List the areas of a library that are as in its file; others would lose what they have."""
    area = re.compile(_AREA.format(re.escape(name)), re.MULTILINE)
    for match in area.finditer(SMAPS.read_text()):
        start, end, permissions, lines = match.groups()
        sizes = {key: int(size) for key, size in _SIZE.findall(lines)}
        # What the loader has changed, and then made read-only, is anonymous, or swapped out; where
        # the system does not say, it may be.
        changed = sizes.get("Anonymous", 1) + sizes.get("Swap", 1)
        if "w" not in permissions and not changed:
            yield Area(int(start, 16), int(end, 16), sizes.get("Rss", 0))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory of a process."""

from __future__ import annotations

import os
from pathlib import Path


def resident_mb(process: int | str = "self") -> float:
    """Resident memory of a process in MB, shared libraries included."""
    # The second number is the resident set, in pages.
    pages = int(Path("/proc", str(process), "statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def proportional_mb(process: int) -> float:
    """Resident memory of a process in MB; its part of what it shares with others."""
    lines = Path("/proc", str(process), "smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) * 1024 / 1e6

"""Memory of a process."""

from __future__ import annotations

import os
from pathlib import Path


def resident_mb(process: int | str = "self") -> float:
    """Resident memory of a process in MB, shared libraries included."""
    pages = int(Path("/proc", str(process), "statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

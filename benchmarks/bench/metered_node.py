# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A tracker node that tells what its steps cost: `… metered_node FILE VARIANT --ros-args …`.

The file, 16 bytes, holds CPU seconds of the stepping thread and the number of steps, both as
doubles, so that they can be read while the node runs.
"""

from __future__ import annotations

import mmap
import struct
import sys
import time
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.ros.executables import main as run
from vehicle_pf_tracker.trackers.base import BaseTracker

METER_RECORD = struct.Struct("dd")
"""Content of the file: CPU seconds of all steps, and their number."""


def meter_steps(path: Path) -> None:
    """Add up in `path` what `BaseTracker.step` takes from now on."""
    with path.open("r+b") as file:
        shared = mmap.mmap(file.fileno(), METER_RECORD.size)
    # In the base class: whatever starts a tracker, each of its steps comes by here.
    original = BaseTracker.step

    def step(self: Any, *arguments: Any) -> Any:
        # Of the stepping thread: the executor's threads belong to the node's cost.
        before = time.thread_time()
        estimate = original(self, *arguments)
        seconds, steps = METER_RECORD.unpack(shared)
        shared[:] = METER_RECORD.pack(seconds + time.thread_time() - before, steps + 1)
        return estimate

    BaseTracker.step = step  # type: ignore[method-assign, assignment]


if __name__ == "__main__":
    meter_steps(Path(sys.argv[1]))
    raise SystemExit(run(sys.argv[2], sys.argv[3:]))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The machine and the versions that numbers are from."""

from __future__ import annotations

import os
from datetime import datetime, timezone
from importlib import metadata
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.results.run_folder import versions

_ROS = "ros-jazzy-rclpy"
"""Package whose version stands for that of ROS."""


def describe() -> dict[str, Any]:
    """Return versions, processor, and how busy it was when the run began."""
    return {
        "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        **versions(),
        "rclpy": _rclpy(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        # Well above 0 other programs ran, too, and times are less certain.
        "load_average": round(os.getloadavg()[0], 2),
    }


def _processor() -> str:
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    # Linux on other processors than x86 has no such line.
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, "unknown")


def _rclpy() -> str | None:
    found = {dist.name: dist.version for dist in metadata.distributions(name=_ROS)}
    return found.get(_ROS)

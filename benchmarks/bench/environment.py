# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The machine and the versions that numbers are from."""

from __future__ import annotations

import os
from datetime import datetime, timezone
from importlib import metadata
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.results.run_folder import versions

_ROS = "ros-jazzy-rclpy"


def describe() -> dict[str, Any]:
    """Return versions, processor, and how busy it was when the run began."""
    return {
        "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        **versions(),
        "rclpy": _rclpy(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load_average": round(os.getloadavg()[0], 2),
    }


def _processor() -> str:
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, "unknown")


def _rclpy() -> str | None:
    found = {dist.name: dist.version for dist in metadata.distributions(name=_ROS)}
    return found.get(_ROS)

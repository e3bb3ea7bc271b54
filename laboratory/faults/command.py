# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`python -m laboratory faults`: the table of what held."""

from __future__ import annotations

import tempfile
from pathlib import Path

from laboratory.faults.request import FAULT_KINDS, Request

__all__ = ["Request", "run"]


def run(request: Request) -> int:
    """Give the faults, and print what held; return 1 where something did not."""
    from laboratory.faults.kinds import give  # noqa: PLC0415 - needs ROS

    rows = []
    # One folder for all kinds: built messages are used again.
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        for kind in request.kinds or FAULT_KINDS:
            print(f"## {kind}", flush=True)
            rows.append(f"| {kind} | {'yes' if give(kind, request, Path(folder)) else 'no'} |")
    print("\n".join(["| faults | all held |", "| --- | --- |", *rows]))
    return 0 if all(row.endswith("yes |") for row in rows) else 1

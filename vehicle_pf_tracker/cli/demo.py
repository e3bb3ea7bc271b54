# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`demo`: the other verbs on a synthetic scene, in the order in which a user would type them."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from vehicle_pf_tracker.cli.console import PROGRAM_NAME, tell_notice
from vehicle_pf_tracker.cli.missing_modules import EVALUATION_MODULES
from vehicle_pf_tracker.cli.requests import option
from vehicle_pf_tracker.cli.run import SHEET_FILE
from vehicle_pf_tracker.cli.shared_options import OverwriteOption
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.estimates import EstimateRow, read_estimates
from vehicle_pf_tracker.results.run_folder import ESTIMATES_FILE

# By Python, and not by the names of executables: those need not be on the path.
_COMMAND = (sys.executable, "-m", "vehicle_pf_tracker")
_NODE = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('fusion'))"
_PATIENCE = "600"
"""Patience with a busy machine that compiles kernels, s; a quiet one needs a few."""


@dataclass(frozen=True, kw_only=True)
class Request(OverwriteOption):
    """Request of `demo`."""

    output: Path = option(
        "-o", default=Path("results/demo"), metavar="DIR",
        help="folder for recording, estimates, video and scores (default: results/demo)",
    )  # fmt: skip


def run(request: Request) -> int:
    """Run the whole chain; return 1 if the node's numbers differ from those of `run`."""
    replaced = ["--overwrite"] if request.overwrite else []
    folder = request.output
    # 1. A scene, and `run` on it.
    recording, offline, ros = (str(folder / name) for name in ("recording", "offline", "ros"))
    video = str(folder / "demo.mp4")
    _verb("synth", "highway", recording, *replaced)
    _verb("run", recording, "--seed", "0", "-o", offline, "--video", video, *replaced)
    # 2. The same images through a node, whose numbers have to be the same.
    same = True
    if importlib.util.find_spec("rclpy") is None:
        tell_notice("ROS is not installed or not sourced, so no node is run")
    else:
        with _node():
            _verb(
                "replay",
                recording,
                "--lockstep",
                "--node",
                "fusion_tracker",
                "--timeout",
                _PATIENCE,
                "-o",
                ros,
                *replaced,
            )
        same = _numbers(Path(ros)) == _numbers(Path(offline))
        print(f"the node's numbers are {'' if same else 'NOT '}those of `run`")
    # 3. Variants compared on them.
    if all(importlib.util.find_spec(name) for name in EVALUATION_MODULES):
        scores = folder / "evaluation"
        words = ["--variants", "fusion,apf,pf", "--seeds", "3", "--figures", "png"]
        _verb("evaluate", recording, *words, "-o", str(scores))
        print(f"errors over time are in {scores / 'figures' / 'errors_recording.png'}")
    else:
        tell_notice("nothing is scored without the extra [evaluation]")
    print(f"the video is {video}, and {folder / 'offline' / SHEET_FILE} has its key frames")
    return 0 if same else 1


def _verb(*words: str) -> None:
    """Run a verb as a process of its own, and show what one would type."""
    print(f"+ {PROGRAM_NAME} {' '.join(words)}", flush=True)
    status = subprocess.run([*_COMMAND, *words], check=False).returncode
    if status:
        raise InputError(f"the demo ends here: {words[0]} ended with status {status}")


@contextmanager
def _node() -> Iterator[None]:
    """Run the node of `fusion`, in a ROS domain away from robots unless the user has chosen one."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 101))
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    words = ["--ros-args", "--log-level", "warn", "-r", "image:=/camera/image_raw", "-p", "seed:=0"]
    print(f"+ fusion_tracker {' '.join(words)} &", flush=True)
    node = subprocess.Popen([sys.executable, "-c", _NODE, *words])
    try:
        yield
    finally:
        node.terminate()
        node.wait()


def _numbers(folder: Path) -> Sequence[EstimateRow]:
    """Return the estimates without the one column that depends on the machine's speed."""
    return [replace(row, step_ms=None) for row in read_estimates(folder / ESTIMATES_FILE)]

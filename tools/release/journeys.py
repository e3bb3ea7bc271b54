# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The README's ways in, as commands that can be typed and results that can be judged."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Mapping
from itertools import groupby
from pathlib import Path

from tools import ROOT

WRITTEN = {
    "video": (
        "grid.png",
        "seen.mp4",
        "out/summary.png",
        "out/estimates.csv",
        "vehicles/tracks.csv",
    ),
    "ros": ("rec/metadata.yaml", "replayed/estimates.csv"),
    "evaluation": ("recordings/bridge/metadata.yaml", "results/report.html"),
}
"""Files that the README's commands leave, by the extra that they need."""
_FURTHER = {"ros": "vehicle-pf-tracker run rec -o offline\n"}
"""Commands of docs/first_steps.md after those of the README, by extra."""


def commands(extra: str) -> str:
    """Return the commands of a way in, after ``pip install '.[EXTRA]'`` in the README."""
    ways = (ROOT / "README.md").read_text(encoding="utf-8").split("## Three ways in")[1]
    blocks: list[str] = re.findall(r"```sh\n(.*?)```", ways, re.DOTALL)
    first = f"pip install '.[{extra}]'\n"
    (typed,) = [block.removeprefix(first) for block in blocks if block.startswith(first)]
    return typed + _FURTHER.get(extra, "")


def problem(extra: str, folder: Path) -> str:
    """Return what is wrong with the files that a way has left in a folder; empty if nothing."""
    for name in WRITTEN[extra]:
        if not (folder / name).exists() or not (folder / name).stat().st_size:
            return f"there is no {name}"
    return _JUDGES[extra](folder)


def _judge_engineer(folder: Path) -> str:
    """Judge that the vehicle is followed behind the bridge and the lorry, and out again."""
    modes = [row["mode"] for row in _rows(folder / "out" / "estimates.csv")]
    spans = [mode for mode, _ in groupby(modes)]
    if spans != ["TRACKING", "OCCLUDED", "TRACKING", "OCCLUDED", "TRACKING"]:
        return f"the vehicle is {', '.join(spans)}"
    return ""


def _judge_robot_developer(folder: Path) -> str:
    """Judge that a node and a run without ROS give the same, but for the time of a step."""
    of_node, of_run = (
        [{**row, "step_ms": ""} for row in _rows(folder / name / "estimates.csv")]
        for name in ("replayed", "offline")
    )
    return "" if of_node == of_run else "the node's estimates are not those of a run without ROS"


def _judge_researcher(folder: Path) -> str:
    """Judge that `fusion` errs less than `pf`, which loses the vehicle at the bridge."""
    errors = {
        row["system"]: float(row["mean"])
        for row in _rows(folder / "results" / "summary.csv")
        if row["metric"] == "rmse_px"
    }
    return "" if errors["fusion"] < errors["pf"] else f"RMSE, px: {errors}"


_JUDGES: Mapping[str, Callable[[Path], str]] = {
    "video": _judge_engineer,
    "ros": _judge_robot_developer,
    "evaluation": _judge_researcher,
}


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))

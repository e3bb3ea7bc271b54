# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The folder of an evaluation: the plan, the truth, and the results of every cell of the grid.

::

    evaluation.json                                      the plan
    recordings/<recording>/truth.csv
    cells/<recording>/<system>/seed-<n>/estimates.csv    metrics.json and run.json; or
    cells/<recording>/<system>/seed-<n>/restarted.csv    with --restart, beside them
    cells/<recording>/<system>/seed-<n>/failed.json      {"reason": a sentence}
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.recordings.footage import LARGEST_PX
from vehicle_pf_tracker.results.estimates import EstimateRow, read_estimates
from vehicle_pf_tracker.results.output_files import read_csv, write_csv
from vehicle_pf_tracker.results.run_folder import ESTIMATES_FILE, RUN_FILE

FOLDER_FORMAT = 2
"""Format of the folder; folders of another format are refused. Counted up when the layout
changes."""


@dataclass(frozen=True, slots=True)
class Source:
    """A recording of the plan.

    Attributes
    ----------
    name : str
        Name of the recording in all tables, and of its folders.
    path : str
        Path of the recording.
    topic : str
        The image topic.
    frames, width, height : int
        Number of images, and their size in px.
    digest : str
        SHA-256 of its content.
    identity : int or None
        Number of the target, where the truth has several.
    """

    name: str
    path: str
    topic: str
    frames: int
    width: int
    height: int
    digest: str
    identity: int | None = None


RESTART_KEY = "restart"
"""Key, in the options of the plan and in a cell's `run.json`, of the frames from a failure to the
next start."""
PLAN_FILE = "evaluation.json"
"""File of what is evaluated, which is there before the first result."""
CELLS_FOLDER = "cells"
"""Folder of the results, with a folder of a run for each recording, system and seed."""
FAILED_FILE = "failed.json"
"""File in the folder of a run that failed, with the reason."""
RESTARTED_FILE = "restarted.csv"
"""File of the estimates with restarts after failure, in the columns of `estimates.csv`."""
RECORDINGS_FOLDER = "recordings"
"""Folder of what the report needs of each recording, so that it can be written again without
it."""
TRUTH_FILE = "truth.csv"
"""File of a recording's truth there."""
COLUMNS = ("frame", "stamp_ns", "x", "y", "width", "height", "occlusion")
"""Columns of `TRUTH_FILE`: x and y are the top-left corner, px."""


def write_truth(path: Path, truths: Mapping[int, Truth]) -> None:
    """Write truths by the number of their frame (top-left corner and size in px, every digit).

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    # By the number of the frame, so that a report is written again without the recording.
    rows = (
        [frame, truth.stamp_ns, *astuple(truth.box), truth.occlusion.name.lower()]
        for frame, truth in sorted(truths.items())
    )
    write_csv(path, COLUMNS, rows)


def read_truth(path: Path) -> dict[int, Truth]:
    """Read truths by the number of their frame.

    Raises
    ------
    InputError
        If there is no such file, or a line of it is not as `write_truth` writes it.
    """
    return dict(read_csv(path, "the truth", COLUMNS, _row))


def _row(line: Mapping[str, str]) -> tuple[int, Truth]:
    box = Box(*(float(line[name]) for name in ("x", "y", "width", "height")))
    if not all(abs(value) <= LARGEST_PX for value in astuple(box)):
        raise ValueError(f"a box beyond {LARGEST_PX:.0f} px")
    truth = Truth(int(line["stamp_ns"]), box, Occlusion[line["occlusion"].upper()])
    return int(line["frame"]), truth


class EvaluationFolder:
    """Reads the folder of an evaluation.

    Parameters
    ----------
    path : Path
        The folder.

    Attributes
    ----------
    plan : mapping of str to Any
        Content of `evaluation.json`.
    recordings : tuple of Source
        Recordings in the order of the plan.
    systems : tuple of System
        Systems in the order of the plan.
    seeds : tuple of int
        Seeds in the order of the plan.

    Raises
    ------
    InputError
        If it is not such a folder, or the plan lacks something.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if not (path / PLAN_FILE).is_file():
            raise InputError(f"{path} is not an evaluation folder: it has no {PLAN_FILE}")
        self.plan: Mapping[str, Any] = read_document(path / PLAN_FILE)
        if self.plan.get("format", FOLDER_FORMAT) != FOLDER_FORMAT:
            raise InputError(
                f"{path} is an evaluation of another version of this program (format "
                f"{self.plan['format']}, not {FOLDER_FORMAT}): evaluate again into another folder"
            )
        try:
            self.recordings = tuple(Source(**entry) for entry in self.plan["recordings"])
            self.seeds = tuple(map(int, self.plan["seeds"]))
            self.systems = tuple(map(System.from_json, self.plan["systems"]))
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise InputError(f"the plan {path / PLAN_FILE} is broken: {error!r}") from error

    def truth(self, recording: str) -> dict[int, Truth]:
        """Return the truths of a recording by the number of their frame; empty without any."""
        path = self.path / RECORDINGS_FOLDER / recording / TRUTH_FILE
        return read_truth(path) if path.is_file() else {}

    def cell(
        self, recording: str, system: str, seed: int
    ) -> tuple[list[EstimateRow], dict[str, Any]]:
        """Read the rows of one cell of the grid, and its `run.json`.

        Raises
        ------
        InputError
            If it has no result, with the reason, or cannot be read.
        """
        folder = cell_folder(self.path, recording, system, seed)
        # First: a failed cell has no estimates, and its reason is worth more than "not run".
        if (folder / FAILED_FILE).is_file():
            raise InputError(
                read_document(folder / FAILED_FILE).get("reason", "no reason was given")
            )
        if not (folder / ESTIMATES_FILE).is_file():
            raise InputError("it was not run")
        return read_estimates(folder / ESTIMATES_FILE), read_document(folder / RUN_FILE)

    def restarted(self, recording: str, system: str, seed: int) -> list[EstimateRow]:
        """Read the rows of a cell with restarts; empty where the evaluation has none.

        Raises
        ------
        InputError
            If they cannot be read.
        """
        path = cell_folder(self.path, recording, system, seed) / RESTARTED_FILE
        wait = self.plan.get("options", {}).get(RESTART_KEY)
        # What an earlier evaluation left there, with another wait, is none of this one.
        if wait is None or read_document(path.parent / RUN_FILE).get(RESTART_KEY) != wait:
            return []
        return read_estimates(path)


def cell_folder(folder: Path, recording: str, system: str, seed: int) -> Path:
    """Return the folder of one cell of the evaluation in `folder`."""
    return folder / CELLS_FOLDER / recording / safe_name(system) / f"seed-{seed}"


def safe_name(label: str) -> str:
    """Return `label` as a name that every file system takes."""
    return "".join(c if c.isalnum() or c in "._-" else "_" for c in label)


def read_document(path: Path) -> dict[str, Any]:
    """Read a JSON object.

    Raises
    ------
    InputError
        If it cannot be read, or is not a JSON object.
    """
    text = read_text(path, "the file")
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} is not JSON: {error}") from error
    if not isinstance(document, dict):
        raise InputError(f"{path} does not hold a JSON object")
    return document

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joining the folders of an evaluation whose parts ran on several machines."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors, whole_folder
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    CELLS_FOLDER,
    PLAN_FILE,
    RECORDINGS_FOLDER,
    read_document,
)
from vehicle_pf_tracker.results.output_files import make_folder, write_json
from vehicle_pf_tracker.results.run_folder import METRICS_FILE

_PLANNED = ("format", "systems", "seeds", "options")
"""Keys of the plan that are equal in all parts of one evaluation, as their recordings are."""


def merge(parts: Sequence[Path], output: Path) -> int:
    """Join the folders of parts in the folder `output`, and return the number of its cells.

    A cell that several parts have is that of the first; one that failed gives way to a result.

    Raises
    ------
    InputError
        If a folder is none of an evaluation, two are not of one evaluation, or nothing can be
        written.
    """
    plans = {part: read_document(part / PLAN_FILE) for part in parts}
    first = parts[0]
    for part, plan in plans.items():
        _check_alike(first, plans[first], part, plan)
    make_folder(output)
    write_json(output / PLAN_FILE, plans[first])
    with output_errors(output):
        for part in parts:
            _copy(part / RECORDINGS_FOLDER, output / RECORDINGS_FOLDER)
            for cell in sorted((part / CELLS_FOLDER).glob("*/*/seed-*")):
                _copy_cell(cell, output / cell.relative_to(part))
    return len(list((output / CELLS_FOLDER).glob("*/*/seed-*")))


def _check_alike(first: Path, one: Mapping[str, Any], part: Path, other: Mapping[str, Any]) -> None:
    """Refuse to join what is not one evaluation."""
    # The command and the versions may differ: each part has its own --part, and its own machine.
    differing = [name for name in _PLANNED if one.get(name) != other.get(name)]
    if _contents(one) != _contents(other):
        differing.append("recordings")
    if differing:
        raise InputError(
            f"{part} is not a part of the evaluation in {first}: they differ in "
            f"{', '.join(differing)}; run the same command with another --part"
        )


def _contents(plan: Mapping[str, Any]) -> dict[str, str]:
    """Digests of the recordings by name: their paths may differ from machine to machine."""
    return {entry["name"]: entry["digest"] for entry in plan.get("recordings", [])}


def _copy(folder: Path, target: Path) -> None:
    if folder.is_dir() and folder.resolve() != target.resolve():
        shutil.copytree(folder, target, dirs_exist_ok=True)


def _copy_cell(cell: Path, target: Path) -> None:
    has_result = (cell / METRICS_FILE).is_file()
    # Only a failed cell gives way, and only to a result.
    if target.exists() and (not has_result or (target / METRICS_FILE).is_file()):
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    # At its place only when it is whole: a copy that is broken off is no cell.
    with whole_folder(target) as partial:
        shutil.copytree(cell, partial, dirs_exist_ok=True)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trajectory files in TUM's format, which evo reads: time in s, position, orientation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.results.output_files import make_folder, write_text

TRUTH = "truth"
"""Name of the file of the truth, after that of the estimates."""

Point = tuple[int, float, float]
"""Stamp in ns, x and y in px."""


def trajectory_files(path: Path, names: Sequence[str]) -> list[Path]:
    """Return the files of targets by these names: `path` for one, one for each of several.

    The last is that of the truth, which a run of one target has.

    Raises
    ------
    InputError
        If a target has the name of the file of the truth.
    """
    truth = path.with_stem(f"{path.stem}_{TRUTH}")
    files = [path.with_stem(f"{path.stem}_{name}") for name in names] if names[1:] else [path]
    if truth in files:
        raise InputError(f"a target is named {TRUTH}, as the file {truth}; give it another name")
    return [*files, truth]


def write_trajectories(
    path: Path, rows: Mapping[str, Sequence[EstimateRow]], truths: Iterable[Truth]
) -> None:
    """Write the positions of each target, and the true ones where there is one target.

    Frames without a position are left out; positions predicted while the vehicle is hidden are not.

    Parameters
    ----------
    path : Path
        File of a single target; see `trajectory_files` for several.
    rows : mapping of str to sequence of EstimateRow
        Estimates by the target's name.
    truths : iterable of Truth
        The truth of the source; no file is written where there is none.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    make_folder(path.parent)
    *files, true_file = trajectory_files(path, list(rows))
    for file, of_target in zip(files, rows.values(), strict=True):
        _write(file, ((row.stamp_ns, *row.position) for row in of_target if row.position))
    true_points = [(truth.stamp_ns, *truth.box.centre) for truth in truths]
    # The truth of a run of several would not say whose it is.
    true_file.unlink(missing_ok=True)
    if true_points and len(rows) == 1:
        _write(true_file, true_points)


def _write(path: Path, points: Iterable[Point]) -> None:
    """Write a line for each point, with every digit and no rotation."""
    lines = (
        f"{stamp // 10**9}.{stamp % 10**9:09d} {float(x)!r} {float(y)!r} 0 0 0 0 1\n"
        for stamp, x, y in points
    )
    write_text(path, "".join(lines))

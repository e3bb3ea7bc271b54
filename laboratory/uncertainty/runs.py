# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Kept runs of a variant, and their errors in units of a covariance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread

RUN_COLUMNS = (
    "stamp", "error_x", "error_y", "xx", "xy", "yy", "width", "height", "vx", "vy", "period",
    "mode", "confidence", "occlusion",
)  # fmt: skip
"""Columns of a run: time in s, errors and sizes in px, velocity in px per frame period."""
INSIDE_95 = 5.991
"""Square of the Mahalanobis distance that holds 95 % of a normal distribution in two dimensions."""


class Runs:
    """Frames of all runs of a variant, but for the first of each, which is the truth itself.

    Parameters
    ----------
    paths : list of Path
        Files of its runs.
    """

    def __init__(self, paths: list[Path]) -> None:
        tables = [_read(path) for path in paths]
        # The first frame of each run is the truth that it starts on: no error to judge.
        self._values = np.concatenate([table[1:] for table in tables])
        self.hidden_for = np.concatenate([_hidden_for(table)[1:] for table in tables])
        self.change = np.concatenate([_change(table)[1:] for table in tables])

    def __getitem__(self, name: str) -> Array:
        column: Array = self._values[:, RUN_COLUMNS.index(name)]
        return column

    @property
    def is_visible(self) -> npt.NDArray[np.bool_]:
        """True where the tracker claims TRACKING."""
        return np.asarray(self["mode"] == 0)

    @property
    def is_occluded(self) -> npt.NDArray[np.bool_]:
        """True where the vehicle is truly out of sight."""
        return np.asarray(self["occlusion"] == Occlusion.TOTAL)

    def squares(self, spread: Spread) -> tuple[Array, Array]:
        """Return squared Mahalanobis distances of the errors, and determinants, px⁴."""
        # Independent parts of the error add as variances: the box's size times a share, what the
        # tracker doubts, how the size has changed since the start, and the time since TRACKING.
        doubt = spread.doubt * (1 - self["confidence"])
        level = self["width"] * self["height"]
        grown = spread.growth * self.hidden_for
        changed = spread.change * self.change
        level = level * (spread.size**2 + doubt**2 + changed**2 + grown**2)
        # Along the predicted way: an error of the speed grows with the distance covered.
        way = spread.drift * self.hidden_for / self["period"]
        vx = way * self["vx"]
        vy = way * self["vy"]
        xx = spread.cloud**2 * self["xx"] + level + vx * vx
        xy = spread.cloud**2 * self["xy"] + vx * vy
        yy = spread.cloud**2 * self["yy"] + level + vy * vy
        x, y = self["error_x"], self["error_y"]
        # A cloud of one point, as mean shift has, and a size that the search takes to nothing.
        area = np.maximum(xx * yy - xy * xy, 1e-12)
        # d² = e' S^-1 e, with the inverse of two by two written out for all frames at once.
        return (yy * x * x - 2 * xy * x * y + xx * y * y) / area, area

    def calibrated(self, calibration: Calibration) -> tuple[Array, Array]:
        """Return `squares` with the spread that belongs to each frame."""
        pairs = zip(
            self.squares(calibration.visible), self.squares(calibration.hidden), strict=True
        )
        first, second = (np.where(self.is_visible, *pair) for pair in pairs)
        return first, second


def _read(path: Path) -> Array:
    try:
        table: Array = np.load(path)[:, : len(RUN_COLUMNS)]
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read the run {path}: {error}") from error
    return table


def _hidden_for(table: Array) -> Array:
    """Return the time since the last claim of TRACKING, s."""
    stamps = table[:, 0]
    visible = table[:, RUN_COLUMNS.index("mode")] == 0
    # The stamp of the last visible frame so far, carried on through the hidden ones.
    seen = np.maximum.accumulate(np.where(visible, stamps, stamps[0]))
    since: Array = stamps - seen
    return since


def _change(table: Array) -> Array:
    """Return the logarithm of the side, in those of the first box."""
    area = table[:, RUN_COLUMNS.index("width")] * table[:, RUN_COLUMNS.index("height")]
    # Half the logarithm of the area is that of its side.
    change: Array = np.log(area / area[0]) / 2
    return change


def runs_of(folder: Path) -> dict[str, list[Path]]:
    """Return the files of runs by variant.

    Raises
    ------
    InputError
        If there are none.
    """
    found: dict[str, list[Path]] = {}
    for path in sorted(folder.glob("*.npy")):
        found.setdefault(path.name.partition(".")[0], []).append(path)
    if not found:
        raise InputError(f"{folder} has no runs; make them with `uncertainty run`")
    return found

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Share of frames whose truth the calibrated ellipses hold, by variant."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from laboratory.uncertainty.runs import INSIDE_95, Runs, runs_of
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.trackers.uncertainty import Calibration
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS


def report(folder: Path) -> str:
    """Write the table of coverage by variant."""
    runs = {name: Runs(paths) for name, paths in runs_of(folder).items()}
    header = (
        "variant", "all frames", "claimed visible", "claimed hidden", "truly out of sight",
        "radius visible", "radius hidden",
    )  # fmt: skip
    return markdown(header, [_coverage_row(name, one, CALIBRATIONS) for name, one in runs.items()])


def _coverage_row(
    name: str, runs: Runs, calibrations: Mapping[str, Calibration]
) -> tuple[str, ...]:
    squares, areas = runs.calibrated(calibrations[name])
    inside = squares <= INSIDE_95
    # Radius of the circle as large as the 95 % ellipse, in sides of the box.
    radius = np.sqrt(INSIDE_95 * np.sqrt(areas) / (runs["width"] * runs["height"]))
    everything = np.ones(len(inside), bool)
    groups = (everything, runs.is_visible, ~runs.is_visible, runs.is_occluded)
    shares = (_percent(inside[group]) for group in groups)
    radii = (_median(radius[group]) for group in (runs.is_visible, ~runs.is_visible))
    return (f"`{name}`", *shares, *radii)


def _percent(inside: npt.NDArray[np.bool_]) -> str:
    return f"{100 * inside.mean():.1f} %" if len(inside) else NO_SCORE


def _median(values: Array) -> str:
    return f"{np.median(values):.2g}" if len(values) else NO_SCORE

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit and coverage of covariances over the runs that `laboratory.uncertainty` keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS

COVERAGE_COLUMNS = (
    "stamp", "error_x", "error_y", "xx", "xy", "yy", "width", "height", "vx", "vy", "period",
    "mode", "confidence", "occlusion",
)  # fmt: skip
"""Columns of a run: time in s, errors and sizes in px, velocity in px per frame period."""
INSIDE_95 = 5.991
"""Square of the Mahalanobis distance that holds 95 % of a normal distribution in two dimensions."""
_TAIL = 3.0
"""Degrees of freedom of the Student distribution that is fitted: errors of trackers have far
outliers, and these must not widen the ellipses of all the other frames."""
_FIRST = ((1.0, 0.05, 0.15, 0.1, 0.4, 0.4), (1.0, 0.3, 0.4, 0.1, 1.0, 1.0))
"""Numbers of a spread that the search starts from."""
_PULL = 1e-4
"""Weight of the squared logarithms beside the mean log-likelihood: numbers that the runs say
nothing about stay near 1."""


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
        column: Array = self._values[:, COVERAGE_COLUMNS.index(name)]
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
        table: Array = np.load(path)[:, : len(COVERAGE_COLUMNS)]
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read the run {path}: {error}") from error
    return table


def _hidden_for(table: Array) -> Array:
    """Return the time since the last claim of TRACKING, s."""
    stamps = table[:, 0]
    visible = table[:, COVERAGE_COLUMNS.index("mode")] == 0
    # The stamp of the last visible frame so far, carried on through the hidden ones.
    seen = np.maximum.accumulate(np.where(visible, stamps, stamps[0]))
    since: Array = stamps - seen
    return since


def _change(table: Array) -> Array:
    """Return the logarithm of the side, in those of the first box."""
    area = table[:, COVERAGE_COLUMNS.index("width")] * table[:, COVERAGE_COLUMNS.index("height")]
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


def fit(runs: Runs) -> Calibration:
    """Fit the spreads to runs: shape by likelihood, size by what holds 95 % of the frames."""
    return Calibration(_fit(runs, runs.is_visible), _fit(runs, ~runs.is_visible))


def _fit(runs: Runs, used: npt.NDArray[np.bool_]) -> Spread:
    def cost(logarithms: Array) -> float:
        squares, areas = runs.squares(Spread(*np.exp(logarithms).tolist()))
        # Student's distribution in two dimensions: log det / 2 + (nu + 2) / 2 log(1 + d² / nu).
        tail = (_TAIL + 2) / 2 * np.log1p(squares[used] / _TAIL)
        likelihood = float(np.mean(np.log(areas[used]) / 2 + tail))
        return likelihood + _PULL * float(logarithms @ logarithms)

    options = {"maxiter": 4000, "xatol": 1e-3, "fatol": 1e-7}
    # From two starts, as the search may end in a valley of its own; the better one counts.
    found = min(
        (minimize(cost, np.log(first), method="Nelder-Mead", options=options) for first in _FIRST),
        key=lambda result: float(result.fun),
    )
    numbers = np.exp(found.x)
    squares, _ = runs.squares(Spread(*numbers.tolist()))
    # The tail is not normal: a factor makes the share that the ellipse is published for right.
    factor = np.sqrt(np.quantile(squares[used], 0.95) / INSIDE_95)
    if not runs.hidden_for[used].any():  # visible: nothing grows
        numbers[4:] = 0
    # Four digits, as the table has them.
    return Spread(*(float(f"{number:.4g}") for number in factor * numbers))


def fitted_table(folder: Path, licence: str) -> str:
    """Write the module with the calibration of every variant, and of all together."""
    paths = runs_of(folder)
    everything = [path for group in paths.values() for path in group]
    fits = {name: fit(Runs(group)) for name, group in [("*", everything), *paths.items()]}
    rows = [
        f'    "{name}": ({_source(found.visible)}, {_source(found.hidden)}),\n'
        for name, found in fits.items()
    ]
    return f"{licence}{_TABLE[0]}{''.join(rows)}{_TABLE[1]}"


_TABLE = (
    '''"""Calibration of covariances, written by `python -m laboratory.uncertainty fit`."""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread

_SPREADS: Mapping[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
''',
    '''}
"""`Spread` while visible and otherwise, by variant; `*` serves those that are not in it."""

CALIBRATIONS: Mapping[str, Calibration] = {
    name: Calibration(Spread(*visible), Spread(*hidden))
    for name, (visible, hidden) in _SPREADS.items()
}
''',
)


def _source(spread: Spread) -> str:
    numbers = astuple(spread)
    used = numbers if any(numbers[4:]) else numbers[:4]
    return f"({', '.join(f'{number:g}' for number in used)})"


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

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit of a variant's calibration to its runs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from laboratory.uncertainty.runs import INSIDE_95, Runs
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread

_TAIL = 3.0
"""Degrees of freedom of the Student distribution that is fitted: errors of trackers have far
outliers, and these must not widen the ellipses of all the other frames."""
_FIRST = ((1.0, 0.05, 0.15, 0.1, 0.4, 0.4), (1.0, 0.3, 0.4, 0.1, 1.0, 1.0))
"""Numbers of a spread that the search starts from."""
_PULL = 1e-4
"""Weight of the squared logarithms beside the mean log-likelihood: numbers that the runs say
nothing about stay near 1."""


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

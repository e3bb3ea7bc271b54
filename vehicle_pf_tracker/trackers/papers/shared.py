# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of variants of several papers: colour likelihood, mean velocity and parameters."""

from __future__ import annotations

import functools
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import TypeAlias

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.filtering.weights import Weights
from vehicle_pf_tracker.image.windows.similarity import hellinger_distance
from vehicle_pf_tracker.parameters.table import parameter

Vector: TypeAlias = tuple[float, float]
"""Position (x, y) in px, or velocity in px per nominal frame."""
_Move: TypeAlias = tuple[float, float, float]
"""Displacement (x, y) in px, and its time in nominal frame periods."""


sigma_v_parameter = functools.partial(
    parameter,
    doc="Smaller: weights fall faster as a particle's histogram departs from the reference.",
    bounds=(1e-3, 100.0), tuned=True,
)  # fmt: skip
"""Declare the spread of the distance; `source` is the equation of the paper that has it."""
squared_distance_parameter = functools.partial(
    parameter, True, "False takes the distance unsquared; the weights are then almost flat."
)
"""Declare the switch of the distance's square; `source` is the equation, and what it prints."""


@dataclass(frozen=True, slots=True)
class LikelihoodParameters:
    """Decrease of the weights with the distance of the histograms."""

    sigma_v: float = sigma_v_parameter(0.1, source="P1 eq. 25, interpretation 1 (printed: 1.5)")
    squared_distance: bool = squared_distance_parameter(
        source="P1 eq. 25, interpretation 1 (printed unsquared)"
    )


def log_likelihood(coefficients: Array, parameters: LikelihoodParameters) -> Weights:
    """Logarithm of equation 25 without its constant factor.

    Parameters
    ----------
    coefficients : (N,) array
        Bhattacharyya coefficients of the particles' histograms with the reference.
    parameters : LikelihoodParameters
        Spread of the distance, and whether it is squared.

    Returns
    -------
    (N,) array
        ``-d_B² / (2 sigma_v²)``, or with ``d_B`` in place of its square.
    """
    # As a logarithm, and without the factor before exp, which is the same for all particles.
    distance = hellinger_distance(coefficients)
    if parameters.squared_distance:
        distance = np.square(distance)
    return np.asarray(distance / (-2 * parameters.sigma_v**2))


as_printed_switch = functools.partial(
    parameter, False, "Follow the paper to the letter: overrides every interpretation below."
)
"""Declare the switch that follows the paper to the letter; `source` names what it undoes."""
histogram_bits_parameter = functools.partial(
    parameter, 3, "More: finer colours, more easily upset by light and noise.", bounds=(1, 5),
    unit="bits/channel", source="P1 section III-C", effect="relearns",
)  # fmt: skip
"""Declare the resolution of joint colour histograms."""
resampling_parameter = functools.partial(
    parameter, "multinomial", "How ancestors are drawn; systematic and stratified vary less.",
    choices=RESAMPLING_SCHEMES,
)  # fmt: skip
"""Declare the choice of a resampling scheme; `source` is where the paper resamples."""


class MeanVelocity:
    """Mean of the last displacements per nominal frame (P1, section III-B; interpretation 5).

    Parameters
    ----------
    window : int
        Number of displacements that count; 0 counts all.
    delay : int
        Number of newest displacements that do not count for `settled` yet.
    """

    def __init__(self, window: int, delay: int = 0) -> None:
        self._window = window
        self._delay = delay
        self.moves: deque[_Move] = deque()
        """Moves that may still count, the newest last."""
        self._older: _Move = (0.0, 0.0, 0.0)
        """Sum of the moves before these, where all count."""

    @property
    def value(self) -> Vector:
        """Velocity in px per nominal frame; (0, 0) while nothing has moved in time."""
        return self._mean_until(len(self.moves))

    @property
    def settled(self) -> Vector:
        """Velocity without the newest displacements, but with at least half of all.

        An occlusion pulls the estimates along before it is noticed, and the drift must not follow
        that.
        """
        count = len(self.moves)
        # Soon after the start the older half is all there is; with older moves none is needed.
        fewest = 0 if self._older[2] > 0 else (count + 1) // 2
        return self._mean_until(max(count - self._delay, fewest))

    def _mean_until(self, end: int) -> Vector:
        if self._window:
            return _mean(islice(self.moves, max(end - self._window, 0), end))
        return _mean([self._older, *islice(self.moves, end)])

    def add(self, before: Vector, after: Vector, elapsed: float) -> None:
        """Count the move from `before` to `after` in `elapsed` nominal frame periods."""
        # With its time: after a missing frame a move takes two periods, and weighs as much.
        self.moves.append((after[0] - before[0], after[1] - before[1], elapsed))
        while len(self.moves) > self._window + self._delay:
            oldest = self.moves.popleft()
            if not self._window:
                self._older = _sum([self._older, oldest])

    def resized(self, window: int, delay: int = 0) -> MeanVelocity:
        """Return the same history with another window."""
        other = MeanVelocity(window, delay)
        other._older = self._older
        other.moves = self.moves.copy()
        return other


def _sum(moves: Iterable[_Move]) -> _Move:
    # Summed again each time, since a running sum would gather rounding over months.
    x = y = elapsed = 0.0
    for move in moves:
        x = x + move[0]
        y = y + move[1]
        elapsed = elapsed + move[2]
    return x, y, elapsed


def _mean(moves: Iterable[_Move]) -> Vector:
    x, y, elapsed = _sum(moves)
    return (x / elapsed, y / elapsed) if elapsed > 0 else (0.0, 0.0)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Interval of the true count at a line, from the signs that were seen there.

Each crossing is true with a probability by its sign: their number is a sum of binomials. What was
missed is a Poisson number with a mean of so much for each sign, whose rate differs between lines
by a gamma factor: a negative binomial. The true count is the sum of both.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.counting.count_signs import Sign

HELD_SHARE = 0.9
"""Share of lines whose interval is to hold the true count: a choice, which users read as "90 %"."""
_MASS = 0.93
"""Probability in an interval: with .93 those of cameras that had no part in the fit hold 85 % by
boxes, with .9 84.8 %."""
_TAIL = 12.0
"""Standard deviations of the number missed, and as many vehicles, that are told apart: beyond lies
less than one in 10 000, also at the larger `spread` below."""
_WIDEST = 8.0
"""Standard deviations of the number of true crossings that are told apart, so that a count of a
month costs little more than one of a day: of a normal distribution 1e-15 lies beyond."""


@dataclass(frozen=True, slots=True)
class Trust:
    """Calibration of the signs, for one kind of detector.

    Attributes
    ----------
    true : mapping of Sign to float
        Probability that a crossing with this sign is one.
    missed : mapping of Sign to float
        Mean number of crossings that were missed, for each sign.
    unseen : float
        Mean number missed at a line without any sign.
    spread : float
        Variance of the rate of what is missed between lines, as a share of its mean squared.
    """

    true: Mapping[Sign, float]
    missed: Mapping[Sign, float]
    unseen: float
    spread: float

    def interval(self, signs: Mapping[Sign, int], mass: float = _MASS) -> tuple[int, int]:
        """Return the least and largest likely number of true crossings."""
        first, likely = self.distribution(signs)
        # The likeliest numbers until they have the mass: the narrowest set. A stable sort makes
        # ties the same on every machine.
        order = np.argsort(-likely, kind="stable")
        inside = order[: int(np.searchsorted(np.cumsum(likely[order]), mass)) + 1]
        return first + int(inside.min()), first + int(inside.max())

    def distribution(self, signs: Mapping[Sign, int]) -> tuple[int, Array]:
        """Return a number of true crossings, and the probabilities of it and of those above."""
        # Poisson means add up, and so do the numbers: one distribution for all signs of misses.
        missed = self.unseen + sum(each * signs.get(sign, 0) for sign, each in self.missed.items())
        likely = _negative_binomial(missed, self.spread)
        first = 0
        for sign, share in self.true.items():
            if signs.get(sign, 0):
                low, shares = _binomial(signs[sign], share)
                # The distribution of a sum of independent numbers.
                likely = np.convolve(likely, shares)
                first += low
        return first, np.asarray(likely)


def _binomial(count: int, share: float) -> tuple[int, Array]:
    """Return a number of successes, and the probabilities of it and of those above."""
    reach = 1 + _WIDEST * math.sqrt(count * share * (1 - share))
    low = max(0, math.floor(count * share - reach))
    high = min(count, math.ceil(count * share + reach))
    number = np.arange(low + 1, high + 1)
    # Ratios of neighbours in place of binomial coefficients, which overflow.
    steps = np.log((count + 1 - number) / number) + math.log(share / (1 - share))
    return low, _probabilities(steps)


def _negative_binomial(mean: float, spread: float) -> Array:
    """Probabilities of 0, 1, 2 … of a Poisson number whose rate is spread by a gamma factor."""
    # The shape of the gamma distribution, which has this variance around a mean of 1.
    size = 1 / spread
    most = math.ceil(mean + _TAIL * (1 + math.sqrt(mean + spread * mean**2)))
    number = np.arange(1, most + 1)
    return _probabilities(np.log((number + size - 1) / number) + math.log(mean / (size + mean)))


def _probabilities(steps: Array) -> Array:
    """Return N + 1 probabilities from the logarithms (N,) of the ratios of neighbours."""
    logs = np.concatenate([[0.0], np.cumsum(steps)])
    # The largest is 1 before they are normalised: none overflows, only the negligible vanish.
    shares = np.exp(logs - logs.max())
    return np.asarray(shares / shares.sum())


OF_BOXES = Trust(
    true=MappingProxyType({Sign.SEEN: 0.971, Sign.VAGUE: 0.956, Sign.DOUBTED: 0.710}),
    missed=MappingProxyType(
        {Sign.PASSED: 1.090, Sign.BROKEN: 0.584, Sign.UNCONFIRMED: 0.171, Sign.SEEN: 0.015}
    ),
    unseen=0.046,
    spread=0.584,
)
"""For detectors that report vehicles: ``python -m laboratory.count_trust`` on 24 runs of 11
cameras; the intervals hold 86 % of the lines of cameras left out."""
OF_BLOBS = Trust(
    true=MappingProxyType({Sign.SEEN: 0.981, Sign.VAGUE: 0.874, Sign.DOUBTED: 0.589}),
    missed=MappingProxyType(
        {
            Sign.PASSED: 0.856,
            Sign.BROKEN: 0.962,
            Sign.UNCONFIRMED: 0.463,
            Sign.SEEN: 0.031,
            Sign.JOINED: 0.200,
        }
    ),
    unseen=0.075,
    spread=0.603,
)
"""For motion, whose blobs may hold several vehicles: in the same way on 11 runs of 9 cameras, 88 %,
and half as wide again."""

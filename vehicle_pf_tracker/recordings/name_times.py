# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Times in the names of images: their unit, or why the numbers may as well count frames."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

Numeral: TypeAlias = tuple[int, str]
"""A number in a name: its integer, and the digits of its fraction, empty without a point."""

_UNITS: Mapping[str, int] = {"s": 10**9, "ms": 10**6, "µs": 10**3, "ns": 1}
"""Length of each unit, ns."""
_SMALLER_UNITS = ("ms", "µs", "ns")
"""Units of integers from a start: whole seconds are the same for many images."""
_EPOCH_S = (1_000_000_000, 2_000_000_000)
"""Seconds since 1970 that are taken for such: from 2001 to 2033. The ranges of the four units do
not overlap, and a number that begins with 20 may be a date, YYYYMMDD..."""
_RATES = (2, 250)
"""Usual rates of cameras, 1/s. Steps between them differ from one unit to the next by a factor of
eight and more, so that a step fits one unit at most."""
_LONGEST_COUNT = 4000
"""A larger step is no count of frames: every 4000th is one in two minutes of video."""
_SHORTEST_MS = 16
"""A smaller step is a count of frames: at rates above 1000 / 16 = 62 images/s a whole number of ms
no longer tells one image from the next, and every second to tenth frame is what tools extract."""
_STEP_TOLERANCE = 0.15
"""Steps of an even camera differ from the median by less than this fraction: 33 and 34 ms by 3 %,
jitter of a driver by a tenth."""
_LEAST_SHARE = 2 / 3
"""Fraction of the steps that are near the median in times: of most images none was dropped."""
_FRACTIONS_S = (0.001, 10.0)
"""Steps of numbers with a fraction that are seconds, s: up to 1000 images/s, down to one in 10 s.
Outside, the numbers are of another unit."""
_SAME = 0.1
"""A step is the period of a stated frame rate when they differ by less than this fraction."""
_LEAST_STEPS = 2
"""Steps that show times beside a stated frame rate: a single one may be a gap in a count."""


@dataclass(frozen=True, slots=True)
class Times:
    """Times that the names of images state.

    Attributes
    ----------
    unit : str
        Unit that was recognised: s, ms, µs or ns.
    since_1970 : bool
        True where they count from 1970; else from a start that is not known.
    ns : list of int
        The times, ns.
    """

    unit: str
    since_1970: bool
    ns: list[int]


class AmbiguousNamesError(ValueError):
    """Raised where numbers may be times or a count of frames; its text says which."""


def times_of(values: Sequence[Numeral], fps: float | None) -> Times | None:
    """Return the times that increasing numbers state; None where they count frames.

    Parameters
    ----------
    values : sequence of Numeral
        The numbers, in order.
    fps : float or None
        Frame rate that is stated beside them, 1/s.

    Raises
    ------
    AmbiguousNamesError
        If they may be both.
    """
    # 1. Times since 1970 are so large that they are nothing else.
    if since_1970 := epoch_unit(values):
        return Times(since_1970, True, [_ns(value, _UNITS[since_1970]) for value in values])
    # 2. Counters have no fraction.
    if any(fraction for _, fraction in values):
        return _of_fractions(values)
    # 3. The unit of integers is known by their steps.
    integers = [integer for integer, _ in values]
    steps = [after - before for before, after in pairwise(integers)]
    unit = _unit_of(steps, fps) if steps else None
    return None if unit is None else Times(unit, False, [at * _UNITS[unit] for at in integers])


def epoch_unit(values: Sequence[Numeral]) -> str | None:
    """Return the unit in which all numbers are times since 1970; None if there is none."""
    for unit, length in _UNITS.items():
        # In integers: 19 digits of ns do not fit a float64.
        first, last = (bound * 10**9 // length for bound in _EPOCH_S)
        if all(first <= integer < last for integer, _ in values):
            return unit
    return None


def _ns(value: Numeral, length: int) -> int:
    """Return a number of a unit in ns; digits below 1 ns are dropped."""
    # In integers, as above: a float64 of seconds since 1970 ends at 0.2 µs.
    integer, fraction = value
    return integer * length + int(fraction or "0") * length // int("1" + "0" * len(fraction))


def _of_fractions(values: Sequence[Numeral]) -> Times:
    ns = [_ns(value, _UNITS["s"]) for value in values]
    steps = [after - before for before, after in pairwise(ns)]
    # median_low: a step that occurs, as the mean of two middle ones would be of no pair of images.
    least, most = (seconds * _UNITS["s"] for seconds in _FRACTIONS_S)
    if steps and not least <= statistics.median_low(steps) <= most:
        raise AmbiguousNamesError(
            f"numbers whose usual step is {statistics.median_low(steps) / 1e9:g} are not plausible "
            "as seconds"
        )
    return Times("s", False, ns)


def _unit_of(steps: Sequence[int], fps: float | None) -> str | None:
    """Return the unit of integers by their steps; None for a count of frames."""
    step = statistics.median_low(steps)
    if fps is not None:
        if unit := _unit_of_period(step, fps):
            return unit
        # Beside a stated rate a count is likelier than times of another rate.
        if step < _LONGEST_COUNT or len(steps) < _LEAST_STEPS:
            return None
    # At such steps ms are implausible, and smaller units even more: a count.
    if step < _SHORTEST_MS:
        return None
    unit = next((unit for unit in _SMALLER_UNITS if _is_usual(step, unit)), None)
    if unit is None:
        raise AmbiguousNamesError(f"the usual step of the numbers, {step}, fits no unit of time")
    # A camera's steps vary by the rounding to ms, or by jitter; those of a count do not.
    near = [each for each in steps if abs(each - step) < _STEP_TOLERANCE * step]
    is_varied = len(set(near)) > 1 and len(near) >= _LEAST_SHARE * len(steps)
    if unit == "ms" and not is_varied:
        raise AmbiguousNamesError(
            f"the usual step of the numbers is {step}, of milliseconds or of a count of frames"
        )
    return unit


def _unit_of_period(step: int, fps: float) -> str | None:
    """Return the unit in which a step is the period of a frame rate; None without such."""
    periods = {unit: 1e9 / (fps * _UNITS[unit]) for unit in _SMALLER_UNITS}
    fits = (unit for unit, period in periods.items() if abs(step - period) < _SAME * period)
    # A step of 1 is a count, also where the period is 1 ms.
    return next(fits, None) if step > 1 else None


def _is_usual(step: int, unit: str) -> bool:
    slowest, fastest = _RATES
    return 1e9 / fastest <= step * _UNITS[unit] <= 1e9 / slowest

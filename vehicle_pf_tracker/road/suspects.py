# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs of a road that do not agree with the others, and are to be read again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.homography import LEAST_PAIRS
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane, residuals

_LARGE_PX = 3.0
"""Standard error of the pairs above which they disagree, px: points that are clicked with care are
off by 1 to 2 px."""
_GAIN = 5.0
"""The rest must agree this many times better than all: of six pairs that are off by chance alone,
the best five do so once in five times, and then they seldom disagree by `_LARGE_PX`."""
_MOST_LEFT_OUT = 2
"""Pairs left out at once: one that was misread, or two that were exchanged."""
_MOST_PAIRS = 30
"""Pairs of which two are left out at once: there are 435 such sets, fitted in a second."""
_FLAT = 0.02
"""Three points are on a line if their height over the longest side is below this fraction of it:
rounding to pixels makes less of sides above 50 px."""


def disagreement(pairs: Sequence[Pair], lens: Lens | None) -> str:
    """Return which pairs to read again, as a sentence; empty where all agree.

    Of four pairs only an impossible order or points in line can be told, of five not which is off.
    """
    try:
        # A fit that fails says less than one that is bad: which pairs make it impossible is another
        # question.
        error = _standard_error(pairs, lens)
    except InputError:
        return _of_impossible(pairs, lens)
    if error <= _LARGE_PX:
        return ""
    wrong = _left_out(pairs, lens, error / _GAIN)
    if wrong:
        # How far off a pair is, is measured from a fit that it did not bend.
        rest = _fitted([pair for place, pair in enumerate(pairs) if place not in wrong], lens)
        off = residuals(rest, [pairs[place] for place in wrong])[0]
        return "read again: " + ", ".join(
            f"{_named(pairs[place])} is {px:.0f} px from where the others put it"
            for place, px in zip(wrong, off, strict=True)
        )
    worst = int(np.argmax(residuals(_fitted(pairs, lens), pairs)[0]))
    more = "; a sixth pair would tell which" if len(pairs) == LEAST_PAIRS + 1 else ""
    return f"the pairs disagree by {error:.0f} px, {_named(pairs[worst])} most{more}"


def _fitted(pairs: Sequence[Pair], lens: Lens | None) -> RoadPlane:
    return RoadPlane.of_pairs(pairs, lens, margin=0.0, coarsest=np.inf)


def _standard_error(pairs: Sequence[Pair], lens: Lens | None) -> float:
    """Return the standard error of a pixel coordinate, px; a homography has eight numbers."""
    off = residuals(_fitted(pairs, lens), pairs)[0]
    # Two coordinates a pair, less the eight numbers: four pairs fit exactly, whatever is wrong.
    free = 2 * (len(pairs) - LEAST_PAIRS)
    return float(np.sqrt((off**2).sum() / free)) if free else 0.0


def _left_out(pairs: Sequence[Pair], lens: Lens | None, most: float) -> tuple[int, ...]:
    """Return the fewest pairs without which the rest agrees to `most` px; none if there are none.

    The rest must have more pairs than determine it, so that it can disagree at all.
    """
    # Fewest first: leaving out two would hide which one was misread.
    for count in range(1, _MOST_LEFT_OUT + 1):
        if len(pairs) - count <= LEAST_PAIRS or (count > 1 and len(pairs) > _MOST_PAIRS):
            break
        errors = {}
        for places in combinations(range(len(pairs)), count):
            rest = [pair for place, pair in enumerate(pairs) if place not in places]
            errors[places] = _error_or_inf(rest, lens)
        best = min(errors, key=errors.__getitem__)
        if errors[best] <= most:
            return best
    return ()


def _error_or_inf(pairs: Sequence[Pair], lens: Lens | None) -> float:
    try:
        return _standard_error(pairs, lens)
    except InputError:
        return np.inf


def _of_impossible(pairs: Sequence[Pair], lens: Lens | None) -> str:
    """Return which pairs keep a set from determining any mapping."""
    wrong = _left_out(pairs, lens, _LARGE_PX)
    if wrong:
        return "read again: " + ", ".join(_named(pairs[place]) for place in wrong)
    for what in ("pixel", "road"):
        points = np.array([getattr(pair, what) for pair in pairs], np.float64)
        # In the image first: points in line on the road may have been read in line.
        for places in combinations(range(len(pairs)), 3):
            if _is_flat(points[list(places)]):
                names = ", ".join(_named(pairs[place]) for place in places)
                return (
                    f"read again or replace one of {names}, which are on one line or the same point"
                )
    exchanged = [
        f"{_named(pairs[one])} and {_named(pairs[other])}"
        for one, other in combinations(range(len(pairs)), 2)
        if _error_or_inf(_exchanged(pairs, one, other), lens) <= _LARGE_PX
    ]
    return "read again " + ", or ".join(exchanged) if exchanged else ""


def _exchanged(pairs: Sequence[Pair], one: int, other: int) -> list[Pair]:
    """Exchange the road points of two pairs."""
    changed = list(pairs)
    changed[one] = replace(pairs[one], road=pairs[other].road)
    changed[other] = replace(pairs[other], road=pairs[one].road)
    return changed


def _is_flat(points: Array) -> bool:
    sides = np.roll(points, -1, axis=0) - points
    longest = float((sides**2).sum(axis=1).max())
    twice_area = abs(sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0])
    return bool(twice_area <= _FLAT * longest)


def _named(pair: Pair) -> str:
    u, v = pair.pixel
    x, y = pair.road
    return f"{u:g},{v:g}={x:g},{y:g}"

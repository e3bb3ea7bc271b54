# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Width and height of the box follow the response to sizes a step larger and smaller."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.parameters import SizeParameters

_DIRECTIONS = ((1.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
"""Axes that are stretched, one pair of sizes per search in turns: vehicles mostly keep their
aspect, so that both sides together have every second turn."""


def searched_size(
    size: Array,
    turn: int,
    peaks: Callable[[Sequence[Array]], Sequence[float]],
    parameters: SizeParameters,
) -> Array:
    """Move the size towards the vertex of the response over three sizes.

    Parameters
    ----------
    size : (2,) array
        Width and height, px.
    turn : int
        Number of the search, which decides the direction that is tried.
    peaks : callable
        Function that gives the responses at some sizes (2,), px.
    """
    direction = np.array(_DIRECTIONS[turn % len(_DIRECTIONS)])
    if not parameters.step or not parameters.gain:
        return size
    # Equal factors up and down: a parabola needs sizes that are equidistant, here in the logarithm.
    factor = (1 + parameters.step) ** direction
    at_size, smaller, larger = peaks([size, size / factor, size * factor])
    bend = smaller + larger - 2 * at_size
    # Below a millionth a bend is rounding, as responses have 7 digits. Without a bend the vertex is
    # beyond the sizes that were tried: one whole step towards the larger response, and no farther.
    if bend < -1e-6 * at_size:
        steps = min(max(0.5 * (smaller - larger) / bend, -1.0), 1.0)
    else:
        steps = float(np.sign(larger - smaller))
    return np.asarray(size * factor ** (parameters.gain * steps))

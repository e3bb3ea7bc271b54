# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Width and height of the box follow the stretch of the points on the vehicle, and the response.

The stretch follows what is fast; the response to sizes a step larger and smaller trims the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.parameters import EVEN_SHARE, SizeParameters

_DIRECTIONS = ((1.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
"""Axes that are stretched, one pair of sizes per search in turns: vehicles mostly keep their
aspect, so that both sides together have every second turn."""
_WHOLE_SHARE = 0.8
"""Share of the surface above which the points' spread gives both sides. A prototype with true boxes
has .96 of a vehicle wholly visible, and .72 with a tenth to a third of it covered
(laboratory/notes/fusion_tried.md)."""
_POINTS_GAIN = 0.5
"""Weight of a stretch along one axis, as an occluder makes it too. A fitted weight was set to one
half together with others, at no cost (laboratory/notes/fusion.md, twelve tuned numbers)."""
_LEAST_BELIEVED = 20.0
"""Geometric mean of the sides, px, below which points are not believed wholly: they are magnified
twofold and more, as are their errors. Without it white_van is claimed in .67 of its hidden frames
instead of .20; laws without a number lose more (laboratory/notes/fusion_tried.md)."""


def believed_stretch(stretch: Array, share: float, size: Array, options: SizeParameters) -> Array:
    """Change of log width and height (2,) by the stretch (2,) of the points on the vehicle.

    An occluder draws points together along one axis. So the stretch that both axes have in common
    is believed wholly if it widens the box, or narrows it faster than the response can follow. The
    rest is believed in part, and only where the surface is wholly visible.
    """
    # The smaller one where both agree in sign, zero where they do not. `reach` is what one search
    # can correct: narrowing within it is left to the response, as occluders narrow the spread, too.
    common = max(stretch.min(), 0.0) + min(stretch.max(), 0.0)
    reach = options.gain * np.log1p(options.step)
    if -reach <= common <= 0 or size.prod() <= _LEAST_BELIEVED**2:
        common = 0.0
    if share > _WHOLE_SHARE:
        # The common part twice at half weight, hence wholly; what is beyond it at half weight.
        return np.asarray(_POINTS_GAIN * (stretch + common))
    return np.full(2, common if share > EVEN_SHARE else 0.0)


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

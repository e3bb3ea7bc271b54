# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Positions, and paints, that rule out the return of a hidden vehicle.

Hypotheses there gain no evidence of being visible, and no return is accepted.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.behind import BEHIND, is_behind
from vehicle_pf_tracker.trackers.fusion.hidden_way import HiddenWay
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Step
from vehicle_pf_tracker.trackers.fusion.verdict import Hidden

_LEAST_PAINT = 0.1
"""Least share of a box that has the vehicle's paint: windows, lamps and road have another. A tenth
is a choice: 7 of the 64 spots that are compared."""

Exclusion = Callable[[Array], npt.NDArray[np.bool_]]
"""Function of positions (..., 2), px: at which of them no hypothesis is the vehicle."""


def exclusion_of(state: State, step: Step) -> Exclusion | None:
    """Return the positions where a hidden vehicle cannot be; None where none are known."""
    if not isinstance(state.verdict, Hidden):
        return None
    way = _way_of(state)
    if way is not None:
        return way.excludes
    if step.memory.foreground.is_known:
        return None
    # Before a moving camera there is no outline, but sightings are carried along with it.
    fitted = state.sightings.fit()
    if fitted is None:
        return None
    motion, last = fitted
    # Sightings that were moved with the camera have its error. A predicted displacement below the
    # limit for what is behind gives no heading: at .34 sizes, one of 13 px returned .58 behind
    # (S0601).
    moved = float(np.hypot(*(motion.position_at(last.age) - last.position)))
    if moved < BEHIND * float(np.sqrt(last.size.prod())):
        return None
    return partial(is_behind, motion=motion, last=last, age=last.age)


def is_stranger(state: State, position: Array, step: Step) -> bool:
    """Test whether a return at this position would be another vehicle's: by position, or by paint.

    Paint is learnt before a standing camera only.
    """
    if state.particles.probability_visible <= 0.5:
        return False
    excludes = exclusion_of(state, step)
    if excludes is not None and excludes(position):
        return True
    if _way_of(state) is None:
        return False
    appearance = step.memory.appearance
    return appearance.paint_share(step.frame, position, state.size) < _LEAST_PAINT


def is_covered(state: State) -> bool:
    """Test whether the vehicle is hidden behind something that stands."""
    way = _way_of(state)
    return way is not None and way.is_covered


def _way_of(state: State) -> HiddenWay | None:
    """Predicted path of a hidden vehicle, before a standing camera."""
    match state.verdict:
        case Hidden(outlines=outlines):
            return outlines.way
    return None

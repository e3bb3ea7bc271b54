# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Positions behind a hidden vehicle, where it cannot return, because it does not reverse."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting

BEHIND = 0.5
"""Distance in sizes against the heading beyond which nothing is the vehicle: it does not reverse on
a road, and what comes up from behind is another one. The half is a choice: three such were .44 to
.54 behind the predicted path, outlines of scene `turn` .2 (laboratory/notes/fusion_tried.md)."""
_MOVED = 0.75
"""Distance in sizes by which that bound moves on while the vehicle is predicted to move by its
size: an occluder that stands hides a vehicle only until it has moved by about its own length."""


def is_behind(
    positions: Array, motion: PerspectiveMotion, last: Sighting, age: float
) -> npt.NDArray[np.bool_]:
    """Test which positions are behind the one at which a vehicle was last seen, by its heading.

    Parameters
    ----------
    positions : (..., 2) array
        Centres, px, in the present image, as are those of `motion` and `last`.
    motion : PerspectiveMotion
        Motion of the vehicle, whose time 0 is its last clear sighting.
    last : Sighting
        That sighting.
    age : float
        Periods since then.
    """
    # Both sides times the speed, undivided: of a vehicle that stood nothing is behind.
    velocity = motion.velocity
    speed = float(np.hypot(*velocity))
    reach = float(np.sqrt(last.size.prod())) * speed
    # The bound stops at a size: one that brakes falls behind its prediction more and more.
    predicted = float((motion.position_at(age) - last.position) @ velocity)
    bound = _MOVED * min(max(predicted, 0.0), reach) - BEHIND * reach
    return np.asarray((positions - last.position) @ velocity < bound)

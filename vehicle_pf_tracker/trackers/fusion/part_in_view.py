# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The part of a hidden vehicle that is in view beside what hides it, before a standing camera.

While a vehicle drives behind a wall, and while it comes out, the filter does not know what is left
of it, and nothing can be measured there: position and size are predicted. But what moves in the
predicted box, mostly lies within it, and has the vehicle's paint, is the rest of the vehicle. What
drives by in front of it, or behind, reaches far beyond its box.
"""

from __future__ import annotations

import math

from vehicle_pf_tracker.trackers.fusion.reappearance import LEAST_PAINT
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Step
from vehicle_pf_tracker.trackers.fusion.verdict import Hidden

_EVEN_PART = 0.2
"""Share of the predicted box that moves, at even odds of the vehicle being in view. Behind painted
walls .15 doubts fewer frames, and claims more of the hidden ones: those in which nearly a tenth is
in view (laboratory/notes/fusion_tried.md)."""
_SLOPE = 20.0
"""Change of the log odds by that share: a tenth more or less are odds of 7 to 1. A choice, as only
the side of the even odds was judged."""
_BARE = 0.1
"""Least part of the box, at one end of it, in which nothing moves: an occluder that stands shows
itself there. Where all of the box moves it is a vehicle in full view, which the filter would know,
or what drives by. A tenth is a choice."""


def part_in_view(state: State, step: Step) -> float:
    """Probability that a part of a hidden vehicle is in view in its predicted box.

    Zero for a vehicle that is not hidden, and before a moving camera.
    """
    verdict = state.verdict
    if not isinstance(verdict, Hidden) or verdict.outlines.reappearance is None:
        return 0.0
    # What was in view elsewhere when the vehicle was hidden is another one, here too.
    if verdict.outlines.reappearance.is_another(state.position):
        return 0.0
    part = step.memory.foreground.part_in(state.position, state.size)
    if part is None or part.bare < _BARE:
        return 0.0
    low, high = part.sides
    paint = step.memory.appearance.paint_share(step.frame, (low + high) / 2, high - low)
    if paint < LEAST_PAINT:
        return 0.0
    return 1 / (1 + math.exp(-_SLOPE * (part.share - _EVEN_PART)))

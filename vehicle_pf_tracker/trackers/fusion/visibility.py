# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The judgement of a step: visible as a whole or in part, turning, hidden, or gone.

Each hypothesis has its own probability of being visible (`Hypotheses`). Evidence that is common to
all of them is weighed here.
"""

from __future__ import annotations

import functools
import math

from vehicle_pf_tracker.trackers.fusion.departure import Departure
from vehicle_pf_tracker.trackers.fusion.hypotheses import chain
from vehicle_pf_tracker.trackers.fusion.parameters import VisibilityParameters
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Observation, Prediction, Step
from vehicle_pf_tracker.trackers.fusion.turning import Outlines
from vehicle_pf_tracker.trackers.fusion.verdict import (
    Gone,
    Hidden,
    PartlyHidden,
    Turning,
    Verdict,
    Visible,
)

_LARGEST_PARTIAL_LOG_RATIO = 3.0
"""Bound of a frame's log ratio of whole against partial, 20 to 1: errors of flow last over frames.
A choice, half of that of the response, so that no single frame ends a belief of .99
(`verdict.WHOLE_AT_FIRST`)."""


def judge(state: State, seen: Observation, prediction: Prediction, step: Step) -> Verdict:
    """Decide on the vehicle's visibility."""
    is_visible = state.particles.probability_visible > 0.5
    # 1. A vehicle that has left stays gone until it is visible; a hidden one may have left.
    departure = None
    if prediction.left_image and not is_visible and isinstance(state.verdict, Hidden):
        place = step.inside(state.particles.mean)
        departure = Departure.by_border(step.frame, place, state.size, state.strangers)
    if isinstance(state.verdict, Gone):
        departure = None if is_visible else seen.departure
    if departure is not None:
        return Gone(departure)
    # 2. An outline that proves a turn is believed before the response, which a turn lowers.
    outlines = state.verdict.outlines if isinstance(state.verdict, Turning | Hidden) else Outlines()
    difference = functools.partial(step.memory.appearance.paint_difference, step.frame)
    foreground = step.memory.foreground
    outlines = outlines.followed(foreground, step.elapsed, seen.view, difference)
    if outlines.vehicle is not None:
        return Turning(outlines)
    # 3. The hypotheses decide between hidden and visible, the surface between a part and all.
    if not is_visible:
        followed = state.verdict.followed if isinstance(state.verdict, Hidden) else None
        return Hidden(outlines, followed)
    whole = _judged_whole(state, seen, step)
    return Visible(whole) if whole > 0.5 else PartlyHidden(whole)


def _judged_whole(state: State, seen: Observation, step: Step) -> float:
    """Probability that all of a visible vehicle is visible.

    What is outside the image is hidden like what is behind an occluder.
    """
    before = state.whole.probability
    if seen.was_hidden:  # the share is of what was there before
        return before
    share = state.surface.share * step.share_inside(seen.position, state.size)
    return wholeness(before, share, step.elapsed, step.parameters.visibility)


def wholeness(before: float, share: float, elapsed: float, options: VisibilityParameters) -> float:
    """Probability that a visible vehicle is whole, `elapsed` frames later, by its surface's share.

    *Whole* and *partial* are a Markov chain. Covering begins and ends as often as occlusions do; an
    occluder shows in the share while response and position do not yet fall.
    """
    stays, returns = chain(elapsed)
    before = before * stays + (1 - before) * returns
    # Even odds at `partial_middle`; linear as the other ratios are.
    ratio = options.partial_slope * (share - options.partial_middle)
    bound = _LARGEST_PARTIAL_LOG_RATIO
    whole = before * math.exp(min(max(ratio, -bound), bound))
    return whole / (whole + (1 - before))

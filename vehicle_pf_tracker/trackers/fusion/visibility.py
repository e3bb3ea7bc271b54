# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The judgement of a step: visible as a whole or in part, turning, hidden, or gone.

Each hypothesis has its own probability of being visible (`Hypotheses`). Evidence that is common to
all of them is weighed here.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from vehicle_pf_tracker.trackers.fusion.departure import Departure, is_too_far
from vehicle_pf_tracker.trackers.fusion.hypotheses import chain
from vehicle_pf_tracker.trackers.fusion.parameters import EVEN, VisibilityParameters
from vehicle_pf_tracker.trackers.fusion.state import Observation, State, Step, Visibility
from vehicle_pf_tracker.trackers.fusion.turning import Turning

_LARGEST_PARTIAL_LOG_RATIO = 3.0
"""Bound of a frame's log ratio of whole against partial, 20 to 1: errors of flow last over
frames."""
_UNDISTURBED = 0.9
"""Response, and share of the surface, above which a frame is undisturbed: the size is followed in
one, flow judged and appearance learnt in the next. That saves a quarter of the time and costs
nothing over 633 runs; from .8 up it costs .01 on target (laboratory/notes/fusion_tried.md)."""
_SETTLED = 10
"""Frames before which none is undisturbed: the usual response follows the first ones as their mean,
and is not known yet."""
_LARGEST_PARTIAL = 1.5
"""Bound of the growth, and of the shrinking, of a partly hidden vehicle, since it became that or
came back as that. It is a tenth on the real sequences; an error of the rate must not go on for as
long as a vehicle waits behind a hedge."""


def judge(state: State, seen: Observation, step: Step) -> State:
    """Decide on the vehicle's visibility."""
    state = _scheduled(state, seen.response)
    if not seen.was_hidden:
        state = _weighed_by_flow(state, seen, step)
    visible = state.particles.probability_visible > 0.5
    state = state._replace(departure=_departure(state, step, visible=visible))
    if state.departure is not None:
        return state._replace(visibility=Visibility.GONE, turning=Turning())
    difference = functools.partial(step.memory.appearance.paint_difference, step.frame)
    turning = state.turning.followed(step.memory.foreground, step.elapsed, seen.view, difference)
    if turning.vehicle is not None:
        return state._replace(visibility=Visibility.TURNING, turning=turning)
    if not visible:
        return state._replace(visibility=Visibility.HIDDEN, turning=turning)
    state = _judged_whole(state, seen, step)
    visibility = Visibility.VISIBLE if state.is_whole else Visibility.PARTLY_HIDDEN
    return state._replace(visibility=visibility, turning=Turning())


def _scheduled(state: State, response: float) -> State:
    """Choose the costly tasks of a frame: both, but in undisturbed frames in turns."""
    settled = state.visibility is Visibility.VISIBLE and state.frames > _SETTLED
    level = min(state.surface.share, response) if state.surface.is_reliable else 0.0
    alternates = settled and level > _UNDISTURBED
    trains = not alternates or not state.trains_filter
    return state._replace(follows_size=not alternates or not trains, trains_filter=trains)


def _weighed_by_flow(state: State, seen: Observation, step: Step) -> State:
    """Take the share of the surface that moves with the vehicle as evidence on visibility.

    In a frame that does not judge it, the share of the frame before counts again: both are
    undisturbed, and the evidence of every frame has the same strength.
    """
    patch, particles = step.memory.appearance.usual_patch(seen.view.patch), state.particles
    points, surface = state.points, state.surface
    if state.follows_size:
        points = points.tracked(patch, seen.position, state.size)
    if state.trains_filter:
        surface = surface.judged(patch, seen.position, state.size)
    if surface.is_reliable:
        ratio = points_evidence(surface.share, step.parameters.visibility)
        particles = particles.weighed_alike(ratio)
    return state._replace(particles=particles, points=points, surface=surface)


def points_evidence(share: float, parameters: VisibilityParameters) -> float:
    """Log-likelihood ratio by the share of the surface's points that move with the vehicle."""
    return parameters.points_slope * (min(share, 1.0) - EVEN)


def _departure(state: State, step: Step, *, visible: bool) -> Departure | None:
    """Decide whether a hidden vehicle has left, by a border or by becoming too small.

    One that has left stays so until it is visible.
    """
    if state.visibility is Visibility.GONE:
        return None if visible else state.departure
    if state.visibility is not Visibility.HIDDEN:
        return None
    position, strangers = step.inside(state.particles.mean), state.strangers
    if state.left_image and not visible:
        return Departure.by_border(step.frame, position, state.size, strangers)
    if is_too_far(state.size, step.memory.appearance.first_size):
        return Departure.far_away(position, state.size, state.particles.mean_velocity, strangers)
    return None


def _judged_whole(state: State, seen: Observation, step: Step) -> State:
    """Judge whether all of the vehicle is visible; predict the size of one that is partly hidden.

    It grows as it did in the sightings before, since its visible part has another size. What is
    outside the image is hidden like what is behind an occluder.
    """
    whole = state.whole
    if not seen.was_hidden:  # until then the share is of what was there before
        share = state.surface.share * step.share_inside(seen.position, state.size)
        whole = wholeness(whole, share, step.elapsed, step.parameters.visibility)
    if whole > 0.5:
        return state._replace(whole=whole)
    growth, measured = state.growth, state.measured
    if state.is_whole:
        fitted = state.sightings.fit()
        growth = 0.0 if fitted is None else fitted[0].rate
    if state.is_whole or seen.was_hidden:
        measured = state.size
    grown = state.size * math.exp(growth * step.elapsed)
    grown = np.clip(grown, measured / _LARGEST_PARTIAL, measured * _LARGEST_PARTIAL)
    return state._replace(whole=whole, growth=growth, measured=measured, size=step.bounded(grown))


def wholeness(before: float, share: float, elapsed: float, options: VisibilityParameters) -> float:
    """Probability that a visible vehicle is whole, `elapsed` frames later, by its surface's share.

    *Whole* and *partial* are a Markov chain. Covering begins and ends as often as occlusions do; an
    occluder shows in the share while response and position do not yet fall.
    """
    stays, returns = chain(elapsed)
    before = before * stays + (1 - before) * returns
    ratio = options.partial_slope * (share - options.partial_middle)
    bound = _LARGEST_PARTIAL_LOG_RATIO
    whole = before * math.exp(min(max(ratio, -bound), bound))
    return whole / (whole + (1 - before))

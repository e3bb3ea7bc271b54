# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The second half of a step: follow the vehicle, and learn its appearance."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.patches.side_network import side_cells
from vehicle_pf_tracker.trackers.fusion.anchoring import anchored
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.hypotheses import (
    LARGEST_GROWTH,
    PRIOR_DOUBT,
    corrected_velocities,
    hidden_hypotheses,
)
from vehicle_pf_tracker.trackers.fusion.observe import gathered
from vehicle_pf_tracker.trackers.fusion.parameters import (
    EVEN_RESPONSE,
    SIZE_RESPONSE,
    TURNING_RESPONSE,
)
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE
from vehicle_pf_tracker.trackers.fusion.sides import Sides
from vehicle_pf_tracker.trackers.fusion.size_search import believed_stretch, searched_size
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Observation, Step
from vehicle_pf_tracker.trackers.fusion.surface_flow import USUAL_RATE
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints
from vehicle_pf_tracker.trackers.fusion.turning import Branch, Outlines, proven
from vehicle_pf_tracker.trackers.fusion.verdict import (
    Gone,
    Hidden,
    PartlyHidden,
    Turning,
    Verdict,
    Visible,
)

_SURE = 0.8
"""Probability of being visible above which size, usual share and paint are measured: odds of 4 to
1, since an occluder that is measured once stays in the size of all later frames."""
_TURNING_STIFFNESS = 0.5
"""Resistance against change while a vehicle turns, a tenth of the usual: within the 20 frames of a
turn by 90 degrees nothing that was learnt before stays right (scene `turn`, seed 100)."""
_LEAST_LEVEL = 0.3
"""Least response that the usual one follows in a turn, and that learning is the faster by: below it
the filter may answer to the road."""
_TURNING_LEVEL_RATE = 0.3
"""Rate per frame at which the usual response follows that in a turn: a new level in 3 frames."""
_TURNING_SHARE = 0.85
"""Share of the surface above which a visible vehicle may turn. With the survival of points in its
place, 57 of 81 occlusions are recovered instead of 62 (laboratory/notes/fusion_tried.md)."""


def follow(state: State, verdict: Verdict, seen: Observation, step: Step) -> State:
    """Follow a visible vehicle, or the prediction of a hidden one, by this frame's verdict."""
    state = state._replace(verdict=verdict, sides=_sides(state, verdict, seen, step))
    match verdict:
        # Before the peak: a filter that does not know the new side has its peak anywhere.
        case Turning(outlines=outlines):
            return _follow_outline(state, outlines, step)
        case Visible(whole=whole) | PartlyHidden(whole=whole):
            return _follow_peak(_with_whole(state, whole, seen, step), seen, step)
        # The first hidden frame. In later ones the hypotheses go on by themselves.
        case Hidden() if not seen.was_hidden:
            state = _enter_occlusion(state, step)
        # In each frame, since the chain lets some become visible: only a proven return counts.
        case Gone():
            state = state._replace(particles=state.particles.all_visible(0.0))
    return state._replace(position=step.inside(state.particles.mean))


def _sides(state: State, verdict: Verdict, seen: Observation, step: Step) -> Sides:
    """Follow the sides of a vehicle in full view, where its surroundings were looked at."""
    sides = state.sides.passed(step.elapsed * step.period, state.size)
    match verdict:
        case Visible():
            foreground = step.memory.foreground
            # The first look comes some time after the background, which is poor at first.
            if foreground.is_known and not sides.is_rested:
                return sides
            around = foreground.around(seen.position, state.size)
            return sides.looked(around, seen.position, state.size)
        case Turning():  # its box is the outline, and as loose as one that is given
            return Sides()
    return sides.doubted()


def _with_whole(state: State, whole: float, seen: Observation, step: Step) -> State:
    """Believe that all or a part is visible; predict the size of a vehicle that is partly hidden.

    It grows as it did in the sightings before, since its visible part has another size.
    """
    before = state.whole
    if whole > 0.5:
        return state._replace(whole=before._replace(probability=whole))
    # The rate is fitted when a part becomes hidden, and kept: later sightings have sizes that were
    # predicted by it, and would confirm whatever it was.
    growth = before.growth
    measured = before.measured
    if before.is_likely:
        fitted = state.sightings.fit()
        growth = 0.0 if fitted is None else fitted[0].rate
    if before.is_likely or seen.was_hidden:
        measured = state.size
    grown = state.size * math.exp(growth * step.elapsed)
    # An error of the rate must not go on for as long as a vehicle waits behind a hedge.
    grown = np.clip(grown, measured / LARGEST_GROWTH, measured * LARGEST_GROWTH)
    whole_now = before._replace(probability=whole, measured=measured, growth=growth)
    return state._replace(whole=whole_now, size=step.bounded(grown))


def _enter_occlusion(state: State, step: Step) -> State:
    """Predict from the last clear sightings: the occluder has dragged later ones along."""
    # What it was taken for since a short return may have been another vehicle.
    state = state._replace(sightings=state.sightings.proven())
    fitted = state.sightings.fit()
    # Never seen clearly: the hypotheses are all there is.
    if fitted is None:
        whole = state.whole._replace(measured=state.size)
        return state._replace(particles=state.particles.all_visible(PRIOR_DOUBT), whole=whole)
    path, last = fitted
    foreground = step.memory.foreground
    # Once, of the frames before: all hidden frames are compared with the same background.
    if foreground.is_known:
        foreground.learn_background()
    outlines = Outlines.begun(foreground, path, last)
    # Weighed once, too: of a hidden vehicle no new sightings tell more.
    followed = state.sightings.followed()
    state = state._replace(verdict=Hidden(outlines, followed))
    # The size too: the occluder has shrunk the box in the frames since.
    size = last.size * path.scale_at(last.age)
    state = state._replace(size=size, whole=state.whole._replace(measured=size))
    count = step.parameters.num_particles
    sigma = step.hidden_velocity_sigma(state.sightings)
    particles = hidden_hypotheses(step.rng, path, last.age, count, state.extent, sigma)
    if followed is not None:
        particles = particles.held(followed.place, followed.share)
    return state._replace(particles=particles)


def _follow_peak(state: State, seen: Observation, step: Step) -> State:
    """Take position, velocity and, of a vehicle that is wholly visible, size from the peak."""
    # Position first, since sizes are compared there; the sighting last, with both.
    state = _centred(state, seen, step)
    # Before a moving camera the filter answers to a turn by the part that it still knows: measured
    # by it, the box shrinks onto that part.
    level = SIZE_RESPONSE if step.memory.foreground.is_known else TURNING_RESPONSE
    if seen.tasks.follows_size and seen.response > level and _is_sure(state):
        state = _sized(state, seen, step)
    response = _response_of_sighting(state, seen, step)
    sightings = state.sightings.added(
        state.position, state.size, response, returned=seen.was_hidden
    )
    return state._replace(sightings=sightings)


def _response_of_sighting(state: State, seen: Observation, step: Step) -> float:
    """Response that a sighting is kept with: before a moving camera a turn counts as clear."""
    # The filter does not know the new side, but the surface moves with the vehicle as a whole. Else
    # a doubt at the end of the turn would go back to where it began, half a second before.
    response = seen.response
    if step.memory.foreground.is_known or seen.was_hidden:  # outlines tell; or the share is old
        return response
    surface = state.surface
    moves_along = surface.is_reliable and surface.share > _TURNING_SHARE
    return max(response, CLEAR_RESPONSE) if moves_along and _is_sure(state) else response


def _is_sure(state: State) -> bool:
    """Test whether a vehicle is surely visible, and as a whole."""
    return state.whole.is_likely and state.particles.probability_visible > _SURE


def _centred(state: State, seen: Observation, step: Step) -> State:
    """Centre the hypotheses on the sighting; their velocities take on the displacement."""
    particles = state.particles
    position = seen.position
    if seen.was_hidden:
        # The last position was a prediction: a displacement from it is its error, and no velocity.
        # And the hypotheses are too far apart for one that is seen.
        visible = particles.probability_visible
        particles = gathered(state, step, position, particles.mean_velocity, visible)
    else:
        # The first displacement is all that is known of a velocity.
        gain = 1.0 if state.frames == 1 else step.parameters.motion.gain
        moved = position - state.position
        velocities = corrected_velocities(particles.velocities, moved, step.elapsed, gain)
        # Moved as one, they keep their spread: it is what the next climb starts from.
        centred = step.inside(particles.positions + (position - particles.mean))
        particles = particles._replace(positions=centred, velocities=velocities)
    return state._replace(particles=particles, position=position)


def _sized(state: State, seen: Observation, step: Step) -> State:
    """Follow the size by the spread of points on the vehicle, and by the filter's response.

    Each pair of frames has one direction of the search, as in undisturbed frames one of two
    follows the size.
    """
    options = step.parameters.size
    size = state.size
    # Points first: they follow what is faster than a step of the search, which then trims the rest.
    peaks = partial(step.memory.appearance.responses_at, step.frame, state.position)
    if options.step and not seen.was_hidden:
        stretch = believed_stretch(state.points.stretch, state.surface.share, size, options)
        size = size * np.exp(stretch)
    size = searched_size(size, state.frames // 2, peaks, options)
    return state._replace(size=step.bounded(size))


def _follow_outline(state: State, outlines: Outlines, step: Step) -> State:
    """Take position, size and velocity from the outline of a vehicle that turns."""
    vehicle = proven(outlines)
    centre, outer = vehicle.box
    position = step.inside(centre)
    size = step.bounded(outer)
    # Counted as clear: the filter's response to the new side would exclude it from the next fit.
    sightings = state.sightings.added(position, size, 1.0)
    state = state._replace(position=position, size=size, sightings=sightings)
    particles = gathered(state, step, position, vehicle.velocity, 1 - PRIOR_DOUBT)
    return state._replace(particles=particles)


def learn(state: State, seen: Observation, step: Step) -> State:
    """Learn from a visible vehicle; keep what the next frame is compared with."""
    match state.verdict:
        case Turning(outlines=outlines):
            _learn_turn(state, proven(outlines), seen.view, step)
        case Visible() | PartlyHidden():
            _learn_appearance(state, seen, step)
            state = _learn_usual(state, seen, step)
            # Of a part none is: a doubt discards the looks.
            unfolded = state.sides.unfolded(state.size)
            if unfolded is not None and _is_sure(state):
                return anchored(state, unfolded.box(state.position, state.size), step)
    if state.is_visible and seen.was_hidden:  # what was kept shows an occluder
        state = state._replace(surface=state.surface.restarted())
    # Kept in every frame: `was_hidden` keeps the next step from comparing with a hidden one.
    patch = step.memory.appearance.usual_patch(seen.view.patch)
    return state._replace(
        points=_renewed_points(state, seen, patch),
        surface=state.surface.kept(patch, state.position, state.size),
        sides=_seen_sides(state, patch, step),
    )


def _seen_sides(state: State, patch: Patch, step: Step) -> Sides:
    """Look where a vehicle in full view ends: by the network, and by edges of what moves."""
    sides = state.sides
    if not isinstance(state.verdict, Visible):
        return sides.parted()
    position = state.position
    size = state.size
    if sides.is_unseen:
        look = partial(_seen_by_network, step)
        sides = sides.seen(look, step.memory.network.noise_by_side, position, size)
    if not step.memory.foreground.stands:
        return sides.parted()
    return sides.compared(patch, position, size, frame_size(step.frame))


def _seen_by_network(step: Step, centre: Array, size: Array) -> Array:
    """Distances (2, 2) of a vehicle's sides beyond those of a box, as the network sees them."""
    kernels = step.memory.appearance.kernels
    cells = side_cells(step.frame, step.inside(centre), step.bounded(size), kernels)
    return step.memory.network.beyond(cells)


def _learn_usual(state: State, seen: Observation, step: Step) -> State:
    """Learn the usual share of the surface, the paint, and how strangers respond."""
    surface = state.surface
    strangers = state.strangers
    memory = step.memory
    if _is_sure(state) and seen.response > CLEAR_RESPONSE:
        surface = surface.learnt_usual()
        if memory.foreground.is_known:  # only then is it asked for
            memory.appearance.learn_paint(step.frame, state.position, state.size)
    # Of a part, what is beside it may be the rest of the vehicle itself.
    if state.whole.is_likely:
        strangers = strangers.measured(seen.view, state.position, state.size)
    return state._replace(surface=surface, strangers=strangers)


def _renewed_points(state: State, seen: Observation, patch: Patch) -> SurfacePoints:
    """Place new points on a vehicle that is visible, and keep the patch if points are tracked."""
    points = state.points
    turns = isinstance(state.verdict, Turning)
    follows_size = seen.tasks.follows_size
    if turns or (state.is_visible and seen.was_hidden):
        points = points.restarted()
    if turns or (state.is_visible and follows_size):
        whole = turns or state.whole.is_likely
        points = points.renewed(state.position, state.size, whole=whole)
    return points.kept(patch, state.position) if follows_size else points


def _learn_turn(state: State, vehicle: Branch, view: View, step: Step) -> None:
    """Train fast on a vehicle that turns."""
    appearance = step.memory.appearance
    # Followed down, or the vehicle would count as hidden as soon as the outline ends.
    response = min(max(view.at(vehicle.box[0]), _LEAST_LEVEL), 1.0)
    appearance.learn_usual(response, _TURNING_LEVEL_RATE)
    # Without a spectrum the cells are measured again, at the size of the outline.
    bare = replace(view, spectrum=None)
    appearance.learn(step.frame, bare, state.position, state.size, _TURNING_STIFFNESS)


def _learn_appearance(state: State, seen: Observation, step: Step) -> None:
    """Train the filter on a vehicle that is whole or turns, less the less surely it is visible."""
    memory = step.memory
    options = step.parameters.filter
    response = seen.response
    surface = state.surface
    appearance = memory.appearance
    turns = surface.is_reliable and surface.share > _TURNING_SHARE and response < TURNING_RESPONSE
    turns &= not memory.foreground.is_known  # outlines tell more of a turn, size included
    if not turns and (response <= EVEN_RESPONSE or not state.whole.is_likely):
        return
    visible = state.particles.probability_visible
    # First the mean of all frames, then an exponential one; less where the frame may be an
    # occluder's. In every frame, since a response costs nothing more, while training has its turns.
    appearance.learn_usual(response, max(USUAL_RATE, 1 / (state.frames + 1)) * visible)
    if not seen.tasks.trains_filter:
        return
    # Stiffness is the weight of the filter before: half as sure, the frame counts half as much.
    stiffness = options.stiffness / visible
    if turns:
        stiffness *= max(response, _LEAST_LEVEL)
    appearance.learn(step.frame, seen.view, state.position, state.size, stiffness)

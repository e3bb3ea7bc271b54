# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The end of a step before a moving camera: a vehicle that was lost for long is begun anew."""

from __future__ import annotations

from functools import partial

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.trackers.fusion.hypotheses import PRIOR_DOUBT, Hypotheses
from vehicle_pf_tracker.trackers.fusion.lone_mover import JOINED, LEAST_MOVING, LoneMover, Mover
from vehicle_pf_tracker.trackers.fusion.state import State, Wholeness
from vehicle_pf_tracker.trackers.fusion.step import Step
from vehicle_pf_tracker.trackers.fusion.surface_flow import SurfaceFlow
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints

_NEW_VELOCITY = 3.0
"""Spread of the first velocities in units of the change per frame: none is known yet. That is .09
of the size per frame; faster starts are measured by `SurfacePoints.first_motion`."""


def scattered(
    rng: np.random.Generator, count: int, box: tuple[Array, Array], sigmas: tuple[float, float]
) -> Hypotheses:
    """Draw the first hypotheses.

    Parameters
    ----------
    count : int
        Number of hypotheses.
    box : pair of (2,) arrays
        Centre, and width and height, px.
    sigmas : pair of float
        Spread of positions, and of a change of the velocity per frame, fractions of the size.
    """
    position, size = box
    # Isotropic: neither heading nor speed is known. Both scale with the size, as a near vehicle
    # moves by more px than a far one.
    spread = rng.normal(size=(2, count, 2)) * float(np.sqrt(size.prod()))
    velocities = spread[1] * sigmas[1] * _NEW_VELOCITY
    positions = np.asarray(position + spread[0] * sigmas[0])
    return Hypotheses.around(positions, velocities, np.zeros(count), 1 - PRIOR_DOUBT)


def recovered(state: State, search: LoneMover, step: Step) -> tuple[State, LoneMover]:
    """Begin anew, with no frame seen since, on the one thing that moves in the vehicle's paint."""
    # A standing camera has outlines.
    if step.memory.foreground.is_known:
        return state, LoneMover()
    search = search.moved(step.memory.panned.camera)
    if search.followed is not None:
        # Until the filter agrees with it.
        vehicle = (state.position, state.size) if state.is_visible else None
        search = search.compared(_boxes(state, step), vehicle)
        begins = not search.agreed
    elif state.is_visible:
        return state, LoneMover()
    else:
        search = _searched(search.passed(step.elapsed), state, step)
        begins = True
    if search.followed is None or not begins:
        return state, search
    return _begun_anew(state, search.followed, step), search


def _searched(search: LoneMover, state: State, step: Step) -> LoneMover:
    """Search for a vehicle that is lost; follow what is proven to be it."""
    if not search.is_due:
        return search
    difference = partial(step.memory.appearance.paint_difference, step.frame)
    image_size = np.array(frame_size(step.frame))
    vehicle = state.position, state.size
    search = search.observed(_boxes(state, step), vehicle, image_size, difference)
    found = search.found()
    return search if found is None else LoneMover(followed=found)


def _boxes(state: State, step: Step) -> Array:
    extent = state.extent
    return step.memory.panned.boxes(JOINED * extent, LEAST_MOVING * extent**2)


def _begun_anew(state: State, mover: Mover, step: Step) -> State:
    """Begin as in a first frame, on what moves."""
    low, high = mover.sides
    position = step.inside((low + high) / 2)
    size = step.bounded(high - low)
    appearance = step.memory.appearance
    appearance.learn_anew(step.frame, position, size)
    motion = step.parameters.motion
    sigmas = motion.position_sigma, motion.velocity_sigma
    count = step.parameters.num_particles
    particles = scattered(step.rng, count, (position, size), sigmas)
    # The next frame is compared with this one.
    patch = appearance.patch(step.frame, position, size)
    return State(
        particles._replace(positions=step.inside(particles.positions)),
        position,
        size,
        Wholeness.at_start(size),
        points=SurfacePoints().kept(patch, position),
        surface=SurfaceFlow().kept(patch, position, size),
        drift=state.drift,
    )

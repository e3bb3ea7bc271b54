# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence on visibility by the flow on the vehicle's surface, the same for all hypotheses."""

from __future__ import annotations

from vehicle_pf_tracker.trackers.fusion.parameters import (
    EVEN_SHARE,
    TURNING_RESPONSE,
    VisibilityParameters,
)
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Observation, Step


def weigh_by_flow(state: State, seen: Observation, step: Step) -> State:
    """Take the share of the surface that moves with the vehicle as evidence on visibility.

    In a frame that does not judge it, the share of the frame before counts again: both are
    undisturbed, and the evidence of every frame has the same strength.
    """
    if seen.was_hidden:  # what was kept of the frame before shows an occluder
        return state
    patch = step.memory.appearance.usual_patch(seen.view.patch)
    kernels = step.memory.appearance.kernels
    # At the peak, not at the prediction: points and flow have to be looked for on the vehicle.
    points = state.points
    surface = state.surface
    if seen.tasks.follows_size:
        points = points.tracked(patch, seen.position, state.size, kernels)
    if seen.tasks.trains_filter:
        is_low = seen.response < TURNING_RESPONSE
        surface = surface.judged(patch, seen.position, state.size, kernels, is_low=is_low)
    particles = state.particles
    # A vehicle whose surface never moved with it, of a few px, is judged by the response alone; so
    # is one whose flow has failed.
    if surface.is_reliable:
        ratio = points_evidence(surface.share, step.parameters.visibility)
        particles = particles.weighed_alike(ratio)
    return state._replace(particles=particles, points=points, surface=surface)


def points_evidence(share: float, parameters: VisibilityParameters) -> float:
    """Log-likelihood ratio by the share of the surface's points that move with the vehicle."""
    # Linear in the share, as the ratio by the response is: even odds where half of it moves along.
    return parameters.points_slope * (min(share, 1.0) - EVEN_SHARE)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The first half of a step: predict where the vehicle is, and observe it there."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import small_grey
from vehicle_pf_tracker.image.windows.window import is_outside
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.departure import Departure
from vehicle_pf_tracker.trackers.fusion.exclusion import (
    Exclusion,
    exclusion_of,
    is_covered,
    is_stranger,
)
from vehicle_pf_tracker.trackers.fusion.followed_by_camera import Followed
from vehicle_pf_tracker.trackers.fusion.hypotheses import (
    ACROSS_LANES,
    HIDDEN_SCALES,
    LARGEST_GROWTH,
    PRIOR_DOUBT,
    Hypotheses,
)
from vehicle_pf_tracker.trackers.fusion.parameters import EVEN_RESPONSE, VisibilityParameters
from vehicle_pf_tracker.trackers.fusion.schedule import Tasks
from vehicle_pf_tracker.trackers.fusion.state import State
from vehicle_pf_tracker.trackers.fusion.step import Observation, Prediction, Step
from vehicle_pf_tracker.trackers.fusion.verdict import Gone, Hidden, Visible, without_outlines

_LARGEST_LOG_RATIO = 6.0
"""Bound of one observation's log ratio: no single frame is believed beyond 400 to 1."""
_HIGHEST_RESPONSE = 1.2
"""Response above which more of it is no more evidence: by then the log ratio is 8.4, beyond the
bound of one observation, and only the costs of moves still decide."""
_PEAK_REACH = 6
"""Places of the response around the mean within which its peak is the estimate: a third of the
target's side."""
_MEASURED_SPREAD = 0.3
"""Factor that narrows the spread of the hypotheses once a first motion was measured, to about a px.
Without that motion drift-chicane is lost in 6 of 6 runs, and no other of 27 sequences changes."""
_WIDE_FROM = 0.5
"""Spread of the hypotheses in sizes above which a wide patch is searched. The usual patch reaches
1.6 sizes to each side, three standard deviations of this spread."""
_SAME_VEHICLE = 0.5
"""Distance in sizes from the best hypothesis within which others are of the same vehicle: centres
of two vehicles are farther apart than half of one."""
CLIMB_FREELY = (5, 3.0)
"""Places of the response to each side within which a hypothesis is moved to a better one, a choice
(a quarter of the target's side), and standard deviation that a move is paid for with."""
CLIMB_ON_PATH = (3, 1.0)
"""Reach and deviation of a move while hidden. The predicted path is trusted more than responses off
it: hypotheses would gather at clutter. The reach is a choice."""
STAY = (0, 1.0)
"""Reach and deviation of a move after a measured first motion, which is kept exactly: a standing
part of the first box answers better than the vehicle, and the filter cannot distinguish the two."""


def predict(state: State, step: Step) -> tuple[State, Prediction]:
    """Move with the camera, and predict all hypotheses; the first step measures a first motion."""
    before = state.particles
    # The camera first: all velocities are against the background, and flow too.
    state = _moved_with_camera(state, step)
    moved = _set_off(state, step) if state.frames == 0 else None
    state, mean = _predicted(moved or state, before, step)
    # By the mean before it is moved into the image: inside, no vehicle would ever leave.
    left_image = is_outside(step.frame, *mean.tolist())
    return state, Prediction(left_image, sets_off=moved is not None)


def _moved_with_camera(state: State, step: Step) -> State:
    """Move everything that is known with the background; its zoom never changes the size."""
    memory = step.memory
    # One reduced image serves both; the foreground has to know at once when the camera moves.
    small = small_grey(step.frame)
    camera = CameraMotion()
    if step.parameters.motion.camera:  # else it is taken to stand, and outlines are found
        camera = memory.camera.measure(small, state.box)
    drift = state.drift.moved_on(camera, step.elapsed, frame_size(step.frame))
    # A camera that has come to rest shows a new background, however far it came.
    stands = camera.still or drift.stands
    memory.foreground.keep(small, camera, stands=stands, elapsed=step.elapsed)
    state = state._replace(
        drift=drift,
        sightings=state.sightings.moved_on(step.elapsed, camera, stands=stands),
        surface=state.surface.moved(camera),
        whole=state.whole.moved(camera),
        sides=state.sides.moved(camera),
    )
    # Outlines are places in an image whose background is gone, and cannot be carried along.
    if not memory.foreground.is_known:
        verdict = without_outlines(state.verdict, state.whole.probability)
        state = state._replace(verdict=verdict)
    if camera.still:
        return state
    if isinstance(state.verdict, Gone):
        state = state._replace(verdict=Gone(state.verdict.departure.moved(camera)))
    position = camera.apply(state.position)
    return state._replace(position=position, particles=state.particles.moved(camera))


def _set_off(state: State, step: Step) -> State | None:
    """Set the hypotheses to the velocity of what moves in the first box; None if nothing does."""
    patch = step.memory.appearance.patch(step.frame, state.position, state.size)
    move = state.points.first_motion(patch, state.size)
    if move is None:
        return None
    particles = state.particles
    share = _MEASURED_SPREAD
    # Shrunk around the first box, from where the measured motion takes them in `_predicted`.
    positions = state.position + share * (particles.positions - state.position)
    velocities = move / step.elapsed + share * particles.velocities
    particles = particles._replace(positions=positions, velocities=velocities)
    return state._replace(particles=particles)


def _predicted(state: State, before: Hypotheses, step: Step) -> tuple[State, Array]:
    """Predict all hypotheses, and their mean (2,) in px; a hidden vehicle grows as they do.

    `before` are those of the frame before, where they were in it.
    """
    motion = step.parameters.motion
    elapsed = step.elapsed
    particles = state.particles
    size = state.size
    extent = state.extent
    visible = state.is_visible
    sigmas = motion.position_sigma * extent, motion.velocity_sigma * extent
    # No noise of the position: that of a visible vehicle covers jumps of the peak; unseen, it moves
    # by its velocity only.
    if not visible:
        sigmas = 0.0, step.hidden_velocity_sigma(state.sightings) * extent
        # One size for all, hence the mean rate; bounded, since a wrong rate would act all the time.
        grown = size * np.exp(float(particles.weights @ particles.growths) * elapsed)
        size = step.bounded(np.minimum(grown, LARGEST_GROWTH * state.whole.measured))
    across = 1.0 if visible else ACROSS_LANES
    covered = is_covered(state)
    predicted = particles.predicted(step.rng, elapsed, sigmas, across, keeps_mean=covered)
    match state.verdict:
        case Hidden(followed=Followed(share=share)):
            # As one: how far apart they are is what either guess may be off.
            predicted = predicted.held(before.mean, share)
    predicted = predicted.passed(elapsed)
    inside = predicted._replace(positions=step.inside(predicted.positions))
    return state._replace(particles=inside, size=size, frames=state.frames + 1), predicted.mean


def observe(state: State, prediction: Prediction, step: Step) -> tuple[State, Observation]:
    """Weigh the hypotheses by the filter's response, and find its peak at the best of them."""
    if isinstance(state.verdict, Gone):
        return _observe_return(state, state.verdict.departure, step)
    # Of the frame before: the verdict on this one comes after the observation.
    was_hidden = not state.is_visible
    climb = STAY if prediction.sets_off else CLIMB_ON_PATH if was_hidden else CLIMB_FREELY
    before = state.particles
    size = state.size
    state, view = _weighed(state, climb, step)
    if prediction.sets_off:
        # Their mean instead of a peak: a standing part of the box has the higher one (`STAY`).
        position = step.inside(state.particles.positions.mean(axis=0))
        response = view.at(position)
    else:
        position, response = likeliest_peak(view, state.particles, state.extent)
    if was_hidden and is_stranger(state, position, step):
        # The hypotheses have gathered at it: those of before are kept, hidden but for the prior.
        state = state._replace(particles=before.all_visible(PRIOR_DOUBT), size=size)
        position = before.mean
        response = 0.0  # of the vehicle nothing was observed, whatever the stranger answers
    tasks = _next_tasks(state, response, step)
    return state, Observation(view, step.inside(position), response, was_hidden, tasks)


def _next_tasks(state: State, response: float, step: Step) -> Tasks:
    """Choose the costly tasks of this frame."""
    # The worse of both: either alone announces an occlusion or a turn.
    level = min(state.surface.share, response) if state.surface.is_reliable else 0.0
    return step.tasks.next(state.frames, level, was_visible=isinstance(state.verdict, Visible))


def _weighed(state: State, climb: tuple[int, float], step: Step) -> tuple[State, View]:
    """Weigh the hypotheses by the response where they are, or close by.

    A hidden vehicle is looked for at other sizes too; the likeliest of them is taken over once it
    is visible.
    """
    scales = (1.0,) if state.is_visible else HIDDEN_SCALES
    # It costs time, so that it is computed where it is asked for only, and once for all sizes.
    exclusion = functools.cache(functools.partial(exclusion_of, state, step))
    results = [(*_searched(state, climb, step, scale, exclusion), scale) for scale in scales]
    # The size of the highest marginal likelihood, summed over positions and visibility: the highest
    # peak alone would prefer the size that clutter answers to best.
    best = results[0]
    if len(results) > 1:
        best = max(results, key=lambda result: state.particles.evidence(result[2]))
    view, positions, ratios, scale = best
    # What moves at the predicted position may be the vehicle, in doubt though in full view: the
    # hypotheses move to it. What answers on an occluder stands, and would hold them back.
    covered = is_covered(state)
    particles = state.particles.climbed(positions, ratios, keeps_mean=covered)
    # While hidden it stays the predicted one: taken over from clutter, it would drift.
    size = step.bounded(scale * state.size) if particles.probability_visible > 0.5 else state.size
    return state._replace(particles=particles, size=size), view


def _searched(
    state: State,
    climb: tuple[int, float],
    step: Step,
    scale: float,
    exclusion: Callable[[], Exclusion | None],
) -> tuple[View, Array, Array]:
    """Judge the hypotheses by the response to a vehicle `scale` times as large as believed.

    `exclusion` returns the positions where a hidden one cannot be.
    """
    particles = state.particles
    appearance = step.memory.appearance
    # Four times the cells: only where the usual patch would miss hypotheses.
    wide = not state.is_visible and particles.spread > _WIDE_FROM * state.extent
    patch = appearance.patch(step.frame, particles.mean, scale * state.size, wide=wide)
    view = _viewed(patch, step)
    options = step.parameters.visibility
    positions, ratios = response_evidence(
        view, particles.positions, climb, options, appearance.kernels
    )
    # What answers where it cannot be is no evidence for it, only against it.
    if (ratios > 0).any():
        excludes = exclusion()
        if excludes is not None:
            ratios = np.where(excludes(positions), np.minimum(ratios, 0.0), ratios)
    return view, positions, ratios


def _viewed(patch: Patch, step: Step) -> View:
    """Respond to a patch; the first one after a start sets the level of all responses."""
    appearance = step.memory.appearance
    if not appearance.has_level:
        appearance.learn_level(patch)
    return appearance.view(patch)


def _observe_return(state: State, departure: Departure, step: Step) -> tuple[State, Observation]:
    """Look for a vehicle that has left where it left; it is visible once that is proven."""
    appearance = step.memory.appearance
    place = step.inside(departure.position)
    patch = appearance.patch(step.frame, place, departure.size, wide=True)
    view = _viewed(patch, step)
    departure = departure.observed(view, step.elapsed)
    particles = state.particles
    position = place
    # Nothing is measured on the vehicle until its return is proven, whatever strangers answer.
    response = 0.0
    if departure.returned is not None:
        position, velocity = departure.returned
        particles = gathered(state, step, position, velocity, 1 - PRIOR_DOUBT)
        response = view.at(position)
    tasks = _next_tasks(state, response, step)
    state = state._replace(particles=particles)
    return state, Observation(view, position, response, True, tasks, departure)


def gathered(
    state: State, step: Step, position: Array, velocity: Array, visible: float
) -> Hypotheses:
    """Draw hypotheses around a position (2,), px, all of one velocity (2,), px per frame."""
    count = step.parameters.num_particles
    motion = step.parameters.motion
    spread = step.rng.normal(size=(count, 2)) * motion.position_sigma * state.extent
    velocities = np.repeat(velocity[np.newaxis], count, axis=0)
    return Hypotheses.around(step.inside(position + spread), velocities, np.zeros(count), visible)


@functools.cache
def _costs(reach: int, sigma: float) -> Array:
    """Costs (2 r + 1, 2 r + 1) of all moves in reach r, as log ratios, by [y, x]."""
    # Minus the logarithm of a Gaussian: moves are paid for as noise of the position. Cached, since
    # the costs are the same in all frames.
    offsets = np.arange(-reach, reach + 1) ** 2
    return np.asarray(0.5 * (offsets[:, np.newaxis] + offsets) / sigma**2)


def response_evidence(
    view: View,
    positions: Array,
    climb: tuple[int, float],
    parameters: VisibilityParameters,
    kernels: Kernels,
) -> tuple[Array, Array]:
    """Judge hypotheses by the filter's response close by.

    Parameters
    ----------
    view : View
        The response around the prediction.
    positions : (N, 2) array
        Positions of the hypotheses, px.
    climb : (int, float)
        Reach and standard deviation of a move, in places of the response.
    kernels : Kernels
        Implementation that searches the response.

    Returns
    -------
    positions : (N, 2) array
        Positions of the best places in reach, px.
    log_ratios : (N,) array
        Log-likelihood ratios there, less what the moves cost.
    """
    # Below 0 the filter has seen nothing, which is no stronger evidence than 0.
    seen = np.minimum(np.maximum(view.response, 0), np.float32(_HIGHEST_RESPONSE))
    ratios = seen.astype(np.float64)
    ratios -= EVEN_RESPONSE
    ratios *= parameters.response_slope
    moves, log_ratios = kernels.climbed(ratios, view.places(positions), _costs(*climb))
    # Bounded last: a move is paid for out of the whole ratio, before what is too much of it is cut.
    bounded = np.minimum(np.maximum(log_ratios, -_LARGEST_LOG_RATIO), _LARGEST_LOG_RATIO)
    return positions + moves / view.steps, bounded


def likeliest_peak(view: View, particles: Hypotheses, extent: float) -> tuple[Array, float]:
    """Peak of the response at the best of the visible hypotheses: its position in px, and height.

    Parameters
    ----------
    extent : float
        Geometric mean of the vehicle's sides, px.
    """
    votes = particles.weights * particles.visible
    # Not the mean of all: between two groups of hypotheses there is no vehicle.
    best = particles.positions[int(votes.argmax())]
    x, y = (particles.positions - best).T
    votes = votes * (np.hypot(x, y) < _SAME_VEHICLE * extent)
    return view.peak_near(votes @ particles.positions / votes.sum(), _PEAK_REACH)

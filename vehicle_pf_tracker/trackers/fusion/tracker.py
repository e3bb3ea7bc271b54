# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`: a correlation particle filter with a posterior over visibility.

Per frame: predict and observe (`observe.py`), weigh by flow (`flow_evidence.py`), judge visibility
(`visibility.py`), follow and learn (`follow.py`). `state.py` has the frozen state that they pass
on, and `step.py` the frame and the memory that they share.

- Visible: climb to the peak, follow the size, learn.
- Partly hidden: climb to the peak, predict the size, learn nothing unless flow shows a turn.
- Turning: follow the outline of what moves, learn fast.
- Hidden: predict along the road, or with the camera that follows (`followed_by_camera.py`), learn
  nothing, and wait until hypotheses gather evidence on the predicted path (`hidden_way.py`), or an
  outline appears beside it (`emergence.py`).
- Gone: learn nothing, and wait until something enters where the vehicle left.

The filter response at each hypothesis is a calibrated log-likelihood ratio of visible against
hidden; flow on the surface gives a second one, the same for all of them. docs/fusion.md draws these
steps as a chart; what it calls occluded, the code calls hidden.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.motion.small_grey import small_grey
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker, Target
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.fusion.anchoring import anchored
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.entering import Entry
from vehicle_pf_tracker.trackers.fusion.flow_evidence import weigh_by_flow
from vehicle_pf_tracker.trackers.fusion.follow import follow, learn
from vehicle_pf_tracker.trackers.fusion.hypotheses import PRIOR_DOUBT, Hypotheses
from vehicle_pf_tracker.trackers.fusion.observe import observe, predict
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.schedule import Tasks
from vehicle_pf_tracker.trackers.fusion.state import State, Wholeness
from vehicle_pf_tracker.trackers.fusion.step import Memory, Step
from vehicle_pf_tracker.trackers.fusion.verdict import Gone, Hidden
from vehicle_pf_tracker.trackers.fusion.visibility import judge

__all__ = ["FusionParameters", "FusionTracker"]

_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step at most: by then a prediction is off
by half the size (laboratory/notes/fusion_tried.md, error after 20 to 40 occluded frames)."""
_NEW_VELOCITY = 3.0
"""Spread of the first velocities in units of the change per frame: none is known yet. That is .09
of the size per frame; faster starts are measured by `SurfacePoints.first_motion`."""


class FusionTracker(ParticleTracker[FusionParameters]):
    """Tracker of one vehicle by a belief about it and what was learnt of it.

    Attributes
    ----------
    state : State or None
        Belief after the latest frame; None before the start.
    memory : Memory or None
        What was learnt up to it; None before the start.
    """

    state: State | None = None
    memory: Memory | None = None
    _tasks: Tasks = Tasks()

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `BaseTracker.start`."""
        estimate = super().start(frame, box)
        state, memory = self._track
        # The second frame is compared with this one: its corners, its patch and its flow begin
        # here.
        memory.camera.measure(small_grey(frame), box)
        patch = memory.appearance.patch(frame, state.position, state.size)
        entry = Entry.of_box(state.position, state.size, np.array(frame_size(frame)))
        self.state = state._replace(
            whole=state.whole._replace(entry=entry),
            points=state.points.kept(patch, state.position),
            surface=state.surface.kept(patch, state.position, state.size),
        )
        return estimate

    @property
    def _track(self) -> tuple[State, Memory]:
        """State and memory of a tracker that was started; raises the user's error before."""
        _ = self.target  # says what is wrong before the start
        assert self.state is not None and self.memory is not None
        return self.state, self.memory

    def _scatter(self, centre: Position) -> Array:
        """Draw the first hypotheses around `centre`; return their positions (N, 2), px."""
        box = self.target.box
        motion = self.parameters.motion
        count = self.parameters.num_particles
        position = np.array(centre, float)
        size = np.array([box.width, box.height], float)
        # Isotropic: neither heading nor speed is known. Both scale with the size, as a near vehicle
        # moves by more px than a far one.
        spread = self._rng.normal(size=(2, count, 2)) * float(np.sqrt(size.prod()))
        velocities = spread[1] * motion.velocity_sigma * _NEW_VELOCITY
        positions = np.asarray(position + spread[0] * motion.position_sigma)
        particles = Hypotheses.around(positions, velocities, np.zeros(count), 1 - PRIOR_DOUBT)
        self.state = State(particles, position, size, Wholeness.at_start(size))
        # A new target: nothing of the last one may be compared with it.
        self.memory = None
        self._tasks = Tasks()
        return positions

    def _learn(self) -> None:
        """Train a filter on the first frame's target."""
        target = self.target
        window = self.parameters.window
        size = np.array([target.box.width, target.box.height])
        # 0 stands for the whole box; a smaller window learns the part that is surely vehicle.
        learnt = np.array([window.width or size[0], window.height or size[1]])
        appearance = Appearance(self.kernels, size, learnt, self.parameters.filter.penalty)
        appearance.learn_first(target.patch, np.array(target.centre), size)
        # A new filter for the same target keeps what is known of camera and background.
        self.memory = replace(self.memory or Memory(appearance), appearance=appearance)

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `BaseTracker.reconfigure`."""
        super().reconfigure(parameters)
        if self._target is not None:
            state, memory = self._track
            # Before the next frame, so that no frame is measured by two implementations.
            memory.appearance.use_kernels(self.kernels)
            particles = state.particles.resampled(self._rng, parameters.num_particles)
            self.state = state._replace(particles=particles)

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: predict, observe, weigh by flow, judge, follow, learn, resample.

        Before it resamples it extends a first box that the image's border had cut.
        """
        state, memory = self._track
        # The order is the model's: only what was predicted can be weighed. Flow needs the peak that
        # the response found, the verdict both pieces of evidence; and nothing is learnt before the
        # verdict, as an occluder that was learnt once would answer from then on.
        elapsed = min(elapsed, _LONGEST_STEP)
        if state.frames == 0:  # the first displacement is a velocity, also where stamps repeat
            elapsed = max(elapsed, 1.0)
        step = Step(
            frame, elapsed, self.parameters, self._rng, memory, self._tasks, self.frame_period
        )
        state, prediction = predict(state, step)
        state, seen = observe(state, prediction, step)
        state = weigh_by_flow(state, seen, step)
        verdict = judge(state, seen, prediction, step)
        state = follow(state, verdict, seen, step)
        state = learn(state, seen, step)
        state, has_grown = _extend_cut_box(state, step)
        if has_grown:  # new parameters relearn the reference from it, which has to be whole
            self._target = Target(frame, state.box)
        # Last, so that the estimate and the next prediction have the same set of hypotheses.
        particles = state.particles.resampled(self._rng, self.parameters.num_particles)
        self.state = state._replace(particles=particles)
        self._tasks = seen.tasks
        has_left = prediction.left_image or isinstance(verdict, Gone)
        return _outcome(state, seen.response, step, has_left=has_left)


def _extend_cut_box(state: State, step: Step) -> tuple[State, bool]:
    """Extend a cut first box by what has come into the image; also True if it has grown."""
    entry = state.whole.entry
    if entry is None:
        return state, False
    if state.is_visible:
        seen = entry.looked(step.frame, state.position, state.size)
    else:
        seen = entry.lost()
    grown = seen.grown(state.position, state.size)
    remaining = seen.remaining(state.size)
    if grown is None:
        return state._replace(whole=state.whole._replace(entry=remaining and seen)), False
    state = anchored(state, grown, step)
    return state._replace(whole=state.whole._replace(measured=state.size, entry=remaining)), True


def _outcome(state: State, response: float, step: Step, *, has_left: bool) -> Outcome:
    """Report a state in the terms that all variants share."""
    particles = state.particles
    entry = state.whole.entry
    sides = state.sides if entry is None else entry
    centre, size = sides.box(state.position, state.size)
    x, y = step.inside(centre).tolist()
    vx, vy = particles.mean_velocity.tolist()
    width, height = size.tolist()
    match state.verdict:
        case Gone(departure=departure):
            regime = departure.reason
        case Hidden():
            regime = "occluded"
        case _:
            regime = "visible"
    values = {
        # Reported as a share of the usual response, which single frames exceed.
        "response": min(max(response, 0.0), 1.0),
        "points": state.surface.share,
        "whole": state.whole.probability,
    }
    return Outcome(
        Cloud(step.inside(particles.positions), particles.weights),
        (x, y),
        (vx, vy),
        regime,
        particles.probability_visible,
        values,
        left_image=has_left,
        size=(width, height),
    )

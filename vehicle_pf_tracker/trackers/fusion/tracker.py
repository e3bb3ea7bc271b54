# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`: a correlation particle filter with a posterior over visibility.

Per frame: predict and observe (`observe.py`), judge visibility (`visibility.py`), follow and learn
(`follow.py`). `state.py` has the frozen state that they pass on, and the memory that they share.

- Visible or partly hidden: climb to the peak, follow the size, learn.
- Turning: follow the outline of what moves, learn fast.
- Hidden: predict along the road, learn nothing, and wait until hypotheses gather evidence.
- Gone: learn nothing, and wait until something comes back from where the vehicle left.

The filter response at each hypothesis is a calibrated log-likelihood ratio of visible against
hidden; flow on the surface gives a second one for all of them. docs/fusion.md has the model.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.camera_motion import small_grey
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.follow import follow, learn
from vehicle_pf_tracker.trackers.fusion.hypotheses import DOUBT, Hypotheses
from vehicle_pf_tracker.trackers.fusion.observe import observe, predict
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.state import Memory, State, Step
from vehicle_pf_tracker.trackers.fusion.visibility import judge

__all__ = ["FusionParameters", "FusionTracker"]

_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step at most: by then a prediction is off
by half the size (laboratory/notes/fusion_tried.md, error after 20 to 40 occluded frames)."""
_NEW_VELOCITY = 3.0
"""Spread of the first velocities in units of the change per frame: none is known yet. That is .09
of the size per frame; faster starts are measured by `SurfacePoints.first_motion`."""


class FusionTracker(ParticleTracker[FusionParameters]):
    """The flagship: a belief about the vehicle, and what was learnt of it."""

    _state: State | None = None
    _memory: Memory | None = None

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `BaseTracker.start`."""
        estimate = super().start(frame, box)
        state, memory = self._track
        memory.camera.measure(small_grey(frame), box)
        patch = memory.appearance.patch(frame, state.position, state.size)
        self._state = state._replace(
            points=state.points.kept(patch, state.position),
            surface=state.surface.kept(patch, state.position, state.size),
        )
        return estimate

    @property
    def _track(self) -> tuple[State, Memory]:
        """State and memory of a tracker that was started."""
        _ = self.target  # says what is wrong before the start
        assert self._state is not None and self._memory is not None
        return self._state, self._memory

    def _scatter(self, centre: Position) -> Array:
        """Draw the first hypotheses; nothing else is known."""
        box, motion, count = self.target.box, self.parameters.motion, self.parameters.num_particles
        position, size = np.array(centre, float), np.array([box.width, box.height], float)
        spread = self._rng.normal(size=(2, count, 2)) * float(np.sqrt(size.prod()))
        velocities = spread[1] * motion.velocity_sigma * _NEW_VELOCITY
        positions = np.asarray(position + spread[0] * motion.position_sigma)
        particles = Hypotheses.around(positions, velocities, np.zeros(count), 1 - DOUBT)
        self._state, self._memory = State(particles, position, size, size), None
        return positions

    def _learn(self) -> None:
        """Train a filter on the first frame's target."""
        target, window = self.target, self.parameters.window
        size = np.array([target.box.width, target.box.height])
        learnt = np.array([window.width or size[0], window.height or size[1]])
        appearance = Appearance(self.kernels, size, learnt, self.parameters.filter.penalty)
        appearance.learn_first(target.patch, np.array(target.centre), size)
        self._memory = replace(self._memory or Memory(appearance), appearance=appearance)

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `BaseTracker.reconfigure`."""
        super().reconfigure(parameters)
        if self._target is not None:
            state, memory = self._track
            memory.appearance.use_kernels(self.kernels)
            particles = state.particles.resampled(self._rng, parameters.num_particles)
            self._state = state._replace(particles=particles)

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        state, memory = self._track
        step = Step(frame, min(elapsed, _LONGEST_STEP), self.parameters, self._rng, memory)
        state = predict(state, step)
        state, seen = observe(state, step)
        state = judge(state, seen, step)
        state = follow(state, seen, step)
        state = learn(state, seen, step)
        particles = state.particles.resampled(self._rng, self.parameters.num_particles)
        self._state = state._replace(particles=particles)
        return self._outcome(state, seen.response, step)

    def _outcome(self, state: State, response: float, step: Step) -> Outcome:
        particles, departure = state.particles, state.departure
        (x, y), (vx, vy) = state.position.tolist(), particles.mean_velocity.tolist()
        width, height = state.size.tolist()
        response = min(max(response, 0.0), 1.0)
        regime = "visible" if state.visibility.is_visible else "occluded"
        return Outcome(
            Cloud(step.inside(particles.positions), particles.weights), (x, y), (vx, vy),
            regime if departure is None else departure.reason,
            particles.probability_visible,
            {"response": response, "points": state.surface.share, "whole": state.whole},
            left_image=state.left_image or departure is not None, size=(width, height),
        )  # fmt: skip

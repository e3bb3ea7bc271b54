# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""`fusion`: a correlation particle filter with a posterior over visibility.

Per frame: move with the camera, predict, observe, judge visibility, and then either

- visible: climb to the peak, follow the size, learn; or
- hidden: predict along the road, learn nothing, and wait until hypotheses gather evidence.

The filter response at each hypothesis is a calibrated log-likelihood ratio of visible against
hidden; points on the surface give a second one for all of them. docs/fusion.md has the model.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.camera_motion import CameraFlow, CameraMotion
from vehicle_pf_tracker.image.canonical_patch import Patch
from vehicle_pf_tracker.image.small_grey import small_grey
from vehicle_pf_tracker.image.window import is_outside, keep_inside
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View
from vehicle_pf_tracker.trackers.fusion.hypotheses import (
    ACROSS_LANES,
    DOUBT,
    Hypotheses,
    hidden_hypotheses,
)
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE, Sightings
from vehicle_pf_tracker.trackers.fusion.size_search import searched_size
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints
from vehicle_pf_tracker.trackers.fusion.visibility import (
    CLIMB_FREELY,
    CLIMB_ON_PATH,
    STAY,
    likeliest_peak,
    points_evidence,
    response_evidence,
)

_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step."""
_WIDE_FROM = 0.5
"""Spread of the hypotheses, of the size, from which a wide patch is searched."""
_STRONG = 0.8
"""Probability of visibility from which the size is followed."""
_WEAK_RESPONSE = 0.6
"""Response below which sizes are not followed: a half-hidden vehicle looks smaller."""
_LEAST_LEARNT = 0.5
"""Response below which nothing is learnt: what is there differs in more than it agrees."""
_WHOLE = 0.8
"""Survival of points from which their spread tells the size: what an occluder covers, shrinks."""
_LEAST_SIDE, _LARGEST_SHARE = 3.0, 1.5
"""Bounds of the sides: px, and share of the image."""
_NEW_VELOCITY = 3.0
"""Spread of the first velocities in units of the change per frame: none is known yet."""
_MEASURED_SPREAD = 0.3
"""Spread of the hypotheses after a first motion was measured, of the one before: about a px."""


class FusionTracker(ParticleTracker[FusionParameters]):
    """The flagship."""

    _particles: Hypotheses

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `Tracker.start`."""
        self._size = np.array([box.width, box.height], float)
        self._position = np.array(box.centre, float)
        self._velocity = np.zeros(2)
        self._frames = 0
        self._set_off = False
        self._visible = True
        self._sightings = Sightings()
        self._points = SurfacePoints(self.kernels)
        self._camera = CameraFlow(self.kernels)
        self._camera.measure(small_grey(frame), box)
        estimate = super().start(frame, box)
        self._points.keep(self._appearance.patch(frame, self._position, self._size))
        return estimate

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `Tracker.reconfigure`."""
        recoloured = parameters.filter.colour != self.parameters.filter.colour
        super().reconfigure(parameters)
        if self._target is not None:
            self._appearance.kernels = self._points.kernels = self._camera.kernels = self.kernels
            self._particles = self._particles.resampled(self._rng, parameters.num_particles)
            if recoloured:
                self._learn()

    def _learn(self) -> None:
        """Train a filter on the first frame's target."""
        target, window = self.target, self.parameters.window
        box = target.box
        learnt = np.array([window.width or box.width, window.height or box.height])
        self._padding = learnt / np.array([box.width, box.height])
        options = self.parameters.filter
        self._appearance = Appearance(self.kernels, learnt, options.penalty, colour=options.colour)
        patch = self._appearance.patch(target.patch, np.array(target.centre), learnt)
        self._appearance.learn_first(patch)

    def _scatter(self, centre: Position) -> Array:
        count, motion, extent = self.parameters.num_particles, self.parameters.motion, self._extent
        spread = self._rng.normal(size=(2, count, 2)) * extent
        velocities = spread[1] * motion.velocity_sigma * _NEW_VELOCITY
        positions = np.asarray(centre) + spread[0] * motion.position_sigma
        self._particles = Hypotheses.around(positions, velocities, np.zeros(count), 1 - DOUBT)
        return np.asarray(positions)

    @property
    def _extent(self) -> float:
        """Geometric mean of the sides of the box, px."""
        return float(np.sqrt(self._size.prod()))

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        _ = self.target  # says what is wrong before the start
        elapsed = min(elapsed, _LONGEST_STEP)
        self._frames += 1
        before = self._position
        self._move_with_camera(frame, elapsed)
        self._set_off = False
        if self._frames == 1:
            self._take_first_motion(frame)
        left_image = self._predict(frame, elapsed)
        view = self._observe(frame, elapsed)
        position, response = self._locate(frame, view)
        if self._visible:
            self._judge_points(
                self._appearance.usual_patch(view.patch), position - before, position
            )
        was_visible = self._visible
        self._visible = self._particles.probability_visible > 0.5
        if self._visible:
            self._take_sighting(frame, view, position, response, elapsed, again=not was_visible)
        elif was_visible:
            self._enter_occlusion()
        if not self._visible:
            self._position = self._kept_inside(frame, self._particles.mean)
            self._velocity = self._particles.mean_velocity
        self._points.keep(self._appearance.usual_patch(view.patch))
        outcome = self._outcome(frame, response, left_image)
        count = self.parameters.num_particles
        self._particles = self._particles.resampled(self._rng, count)
        return outcome

    # Predict

    def _move_with_camera(self, frame: Frame, elapsed: float) -> None:
        """Move everything that is known with the background; its zoom never changes the size."""
        camera = CameraMotion()
        if self.parameters.motion.camera:
            box = Box.around((self._position[0], self._position[1]), *self._size.tolist())
            camera = self._camera.measure(small_grey(frame), box)
        self._sightings.pass_time(elapsed, camera)
        if not camera.still:
            self._position = camera.apply(self._position)
            self._particles = replace(
                self._particles,
                positions=camera.apply(self._particles.positions),
                velocities=camera.apply_to_velocities(self._particles.velocities),
            )

    def _take_first_motion(self, frame: Frame) -> None:
        """Give the hypotheses the velocity of what moves in the first box."""
        patch = self._appearance.patch(frame, self._position, self._learnt_size)
        move = self._points.first_motion(patch, self._size)
        if move is not None:
            self._set_off = True
            known = self._particles.narrowed(self._position, _MEASURED_SPREAD)
            self._particles = replace(known, velocities=known.velocities + move)

    def _predict(self, frame: Frame, elapsed: float) -> bool:
        """Drive all hypotheses on; tell whether their mean left the image."""
        motion, extent = self.parameters.motion, self._extent
        if self._visible:
            sigmas = motion.position_sigma * extent, motion.velocity_sigma * extent
        else:
            sigmas = motion.hidden_position_sigma * extent, motion.hidden_velocity_sigma * extent
            growth = float(self._particles.weights @ self._particles.growths)
            self._size = self._bounded(frame, self._size * np.exp(growth * elapsed))
        across = 1.0 if self._visible else ACROSS_LANES
        driven = self._particles.driven(self._rng, elapsed, sigmas, across=across)
        rates = self.parameters.visibility
        driven = driven.passed(elapsed, rates.hiding_rate, rates.return_rate)
        left_image = is_outside(frame, *driven.mean.tolist())
        self._particles = replace(driven, positions=keep_inside(frame, driven.positions))
        return left_image

    # Observe

    @property
    def _learnt_size(self) -> Array:
        """Size in px of the part that the filter has learnt, which may be padded."""
        return np.asarray(self._size * self._padding)

    def _observe(self, frame: Frame, elapsed: float) -> View:
        """Weigh the hypotheses by the filter's response where they are, or close by."""
        wide = not self._visible and self._particles.spread > _WIDE_FROM * self._extent
        patch = self._appearance.patch(frame, self._particles.mean, self._learnt_size, wide=wide)
        view = self._appearance.view(patch)
        climb = CLIMB_FREELY if self._visible else CLIMB_ON_PATH
        climb = STAY if self._set_off else climb
        positions, log_ratios = response_evidence(
            view, self._particles.positions, climb, self.parameters.visibility, self.kernels
        )
        self._particles = replace(self._particles, positions=positions).observed(log_ratios)
        return view

    def _locate(self, frame: Frame, view: View) -> tuple[Array, float]:
        """Peak of the response at the best of the visible hypotheses, and its height."""
        if self._set_off:
            position = self._kept_inside(frame, self._particles.positions.mean(axis=0))
            return position, view.at(position)
        position, response = likeliest_peak(view, self._particles, self._extent)
        return self._kept_inside(frame, position), response

    def _judge_points(self, patch: Patch, move: Array, position: Array) -> None:
        """Take the survival of points as evidence on visibility."""
        evidence = self.parameters.visibility
        if not evidence.points_slope:
            return
        survival = self._points.track(patch, move, position, self._size)
        if survival is not None:
            self._particles = self._particles.witnessed(points_evidence(survival, evidence))

    # Visible

    def _take_sighting(
        self, frame: Frame, view: View, position: Array, response: float, elapsed: float, *,
        again: bool,
    ) -> None:  # fmt: skip
        """Follow position, velocity and size to the peak, and learn."""
        self._gather(frame, position, elapsed, again=again)
        surely = self._particles.probability_visible > _STRONG
        if surely and response > _WEAK_RESPONSE:
            self._follow_size(frame, again=again)
        self._sightings.add(self._position, self._size, response)
        if again:
            self._points.restart()
        if surely and response > CLEAR_RESPONSE:
            self._points.learn_usual()
        if self.parameters.visibility.points_slope:
            self._points.renew(self._position, self._size)
        self._learn_appearance(frame, view, response)

    def _gather(self, frame: Frame, position: Array, elapsed: float, *, again: bool) -> None:
        """Centre the hypotheses on the sighting; their velocities take on the displacement."""
        particles, motion = self._particles, self.parameters.motion
        moved = (position - self._position) / max(elapsed, 1e-3)
        if again:
            count, velocity = self.parameters.num_particles, particles.mean_velocity
            spread = self._rng.normal(size=(count, 2)) * motion.position_sigma * self._extent
            still = np.zeros(count)
            velocities = np.repeat(velocity[np.newaxis], count, axis=0)
            visible = particles.probability_visible
            self._particles = Hypotheses.around(position + spread, velocities, still, visible)
        else:
            gain = 1.0 if self._frames == 1 else motion.gain
            velocities = particles.velocities + gain * (moved - particles.velocities)
            centred = particles.positions + (position - particles.mean)
            self._particles = replace(particles, positions=centred, velocities=velocities)
        inside = keep_inside(frame, self._particles.positions)
        self._particles = replace(self._particles, positions=inside)
        self._position = position
        self._velocity = self._particles.mean_velocity

    def _follow_size(self, frame: Frame, *, again: bool) -> None:
        options = self.parameters.size

        def peak(size: Array) -> float:
            return self._appearance.response_at(frame, self._position, size * self._padding)

        size = self._size
        if not again and options.step and self._points.survival > _WHOLE:
            size = size * np.exp(options.points_gain * self._points.stretch)
        self._size = self._bounded(frame, searched_size(size, self._frames, peak, options))

    def _learn_appearance(self, frame: Frame, view: View, response: float) -> None:
        """Train the filter, the less the less surely the vehicle is visible."""
        options = self.parameters.filter
        whole = self._points.survival > self.parameters.visibility.learning_points
        if response <= _LEAST_LEARNT or not whole:
            return
        visible = self._particles.probability_visible
        rate = max(options.level_rate, 1 / (self._frames + 1)) * visible
        self._appearance.learn_usual(response, rate)
        stiffness = options.stiffness / visible
        self._appearance.learn(frame, view, self._position, self._learnt_size, stiffness)

    # Hidden

    def _enter_occlusion(self) -> None:
        """Predict from the last clear sightings: the occluder has dragged later ones along."""
        fitted = self._sightings.fit(perspective=self.parameters.motion.perspective)
        if fitted is None:
            self._particles = replace(
                self._particles, visible=np.full(len(self._particles.visible), DOUBT)
            )
            return
        motion, last = fitted
        self._size = last.size * motion.scale_at(last.age)
        sigma = self.parameters.motion.hidden_velocity_sigma
        count = self.parameters.num_particles
        self._particles = hidden_hypotheses(self._rng, motion, last.age, count, self._extent, sigma)

    # Report

    def _bounded(self, frame: Frame, size: Array) -> Array:
        return np.clip(size, _LEAST_SIDE, _LARGEST_SHARE * max(frame_size(frame)))

    def _kept_inside(self, frame: Frame, position: Array) -> Array:
        return np.asarray(keep_inside(frame, position))

    def _outcome(self, frame: Frame, response: float, left_image: bool) -> Outcome:
        particles = self._particles
        positions = keep_inside(frame, particles.positions)
        (x, y), (vx, vy) = self._position.tolist(), self._velocity.tolist()
        return Outcome(
            Cloud(positions, particles.weights), (x, y), (vx, vy),
            "visible" if self._visible else "occluded", particles.probability_visible,
            {"response": min(max(response, 0.0), 1.0), "points": min(self._points.survival, 1.0)},
            left_image=left_image,
        )  # fmt: skip

    def _estimate(self, outcome: Outcome, mode: Mode, confidence: float, began: float) -> Estimate:
        width, height = self._size.tolist()
        estimate = super()._estimate(outcome, mode, confidence, began)
        return replace(estimate, box=Box.around(outcome.position, width, height))

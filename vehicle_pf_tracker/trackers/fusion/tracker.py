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

Per frame: predict, observe, judge how much of the vehicle is seen, follow, and learn.

- Visible or partly hidden: climb to the peak, follow the size, learn.
- Turning: follow the outline of what moves, learn fast.
- Hidden: predict along the road, learn nothing, and wait until hypotheses gather evidence.
- Gone: learn nothing, and wait until something comes back from where the vehicle left.

The filter response at each hypothesis is a calibrated log-likelihood ratio of visible against
hidden; flow on the surface gives a second one for all of them. docs/fusion.md has the model.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.camera_motion import CameraMotion, small_grey
from vehicle_pf_tracker.image.canonical_patch import Patch
from vehicle_pf_tracker.image.window import is_outside, keep_inside
from vehicle_pf_tracker.trackers.base import Outcome
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.departure import Departure, is_too_far
from vehicle_pf_tracker.trackers.fusion.hypotheses import (
    ACROSS_LANES,
    DOUBT,
    HIDDEN_SCALES,
    LARGEST_GROWTH,
    hidden_hypotheses,
)
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.track import Observation, Track
from vehicle_pf_tracker.trackers.fusion.visibility import (
    CLIMB_FREELY,
    CLIMB_ON_PATH,
    STAY,
    WIDE_FROM,
    Visibility,
    likeliest_peak,
    points_evidence,
    response_evidence,
)

__all__ = ["FusionParameters", "FusionTracker"]

_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step."""
_MEASURED_SPREAD = 0.3
"""Spread of the hypotheses after a first motion was measured, of the one before: about a px."""


class _Look(NamedTuple):
    """The hypotheses, judged by the response at one size; see `response_evidence`."""

    view: View
    positions: Array
    log_ratios: Array
    scale: float


class FusionTracker(Track):
    """The flagship."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        _ = self.target  # says what is wrong before the start
        elapsed = min(elapsed, _LONGEST_STEP)
        self._frames += 1
        left_image = self._predict(frame, elapsed)
        seen = self._observe(frame, elapsed)
        self._visibility = self._judge_visibility(frame, seen, elapsed, left_image=left_image)
        self._follow(frame, seen, elapsed)
        self._learn_from(frame, seen)
        outcome = self._outcome(frame, seen.response, left_image=left_image)
        count = self.parameters.num_particles
        self._particles = self._particles.resampled(self._rng, count)
        return outcome

    # Predict

    def _predict(self, frame: Frame, elapsed: float) -> bool:
        """Move with the camera, and drive all hypotheses on; tell whether their mean left."""
        self._move_with_camera(frame, elapsed)
        self._set_off = self._frames == 1 and self._take_first_motion(frame)
        return self._drive(frame, elapsed)

    def _move_with_camera(self, frame: Frame, elapsed: float) -> None:
        """Move everything that is known with the background; its zoom never changes the size."""
        camera = CameraMotion()
        if self.parameters.motion.camera:
            box = Box.around((self._position[0], self._position[1]), *self._size.tolist())
            small = small_grey(frame)
            camera = self._camera.measure(small, box)
            if self.parameters.motion.turns:
                self._turning.keep(small, still=camera.still)
        self._sightings.pass_time(elapsed, camera)
        self._surface.move_with_camera(camera)
        if not camera.still:
            self._position = camera.apply(self._position)
            self._particles = self._particles.moved(camera)

    def _take_first_motion(self, frame: Frame) -> bool:
        """Give the hypotheses the velocity of what moves in the first box; tell if it is known."""
        patch = self._appearance.patch(frame, self._position, self._learnt_size)
        move = self._points.first_motion(patch, self._size)
        if move is None:
            return False
        self._particles = self._particles.narrowed(self._position, move, _MEASURED_SPREAD)
        return True

    def _drive(self, frame: Frame, elapsed: float) -> bool:
        """Drive all hypotheses on; tell whether their mean left the image."""
        motion, extent = self.parameters.motion, self._extent
        seen = self._visibility.is_seen
        sigmas = motion.position_sigma * extent, motion.velocity_sigma * extent
        if not seen:
            sigmas = motion.hidden_position_sigma * extent, self._hidden_velocity_sigma * extent
            growth = float(self._particles.weights @ self._particles.growths)
            grown = np.minimum(self._size * np.exp(growth * elapsed), self._largest_hidden)
            self._size = self._bounded(frame, grown)
        across = 1.0 if seen else ACROSS_LANES
        driven = self._particles.driven(self._rng, elapsed, sigmas, across=across)
        rates = self.parameters.visibility
        driven = driven.passed(elapsed, rates.hiding_rate, rates.return_rate)
        left_image = is_outside(frame, *driven.mean.tolist())
        self._particles = replace(driven, positions=keep_inside(frame, driven.positions))
        return left_image

    # Observe

    def _observe(self, frame: Frame, elapsed: float) -> Observation:
        """Weigh the hypotheses by the filter's response, and find its peak at the best of them."""
        if self._departure is not None:
            return self._observe_return(frame, self._departure, elapsed)
        view = self._weigh(frame)
        if self._set_off:
            position = keep_inside(frame, self._particles.positions.mean(axis=0))
            response = view.at(position)
        else:
            position, response = likeliest_peak(view, self._particles, self._extent)
            position = keep_inside(frame, position)
        return Observation(view, position, response, again=not self._visibility.is_seen)

    def _weigh(self, frame: Frame) -> View:
        """Weigh the hypotheses by the response where they are, or close by.

        A hidden vehicle is looked for at other sizes too; the likeliest of them is taken over once
        it is visible.
        """
        scales = (1.0,) if self._visibility.is_seen else HIDDEN_SCALES
        looks = [self._look(frame, scale) for scale in scales]
        look = max(looks, key=lambda look: self._particles.evidence(look.log_ratios))
        moved = replace(self._particles, positions=look.positions)
        self._particles = moved.observed(look.log_ratios)
        if self._particles.probability_visible > 0.5:
            self._size = self._bounded(frame, look.scale * self._size)
        return look.view

    def _look(self, frame: Frame, scale: float) -> _Look:
        """Judge the hypotheses by the response to a vehicle `scale` times as large as believed."""
        particles, hidden = self._particles, not self._visibility.is_seen
        wide = hidden and particles.spread > WIDE_FROM * self._extent
        size = scale * self._learnt_size
        patch = self._appearance.patch(frame, particles.mean, size, wide=wide)
        view = self._appearance.view(patch, recall=hidden and self.parameters.filter.memory > 0)
        climb = STAY if self._set_off else CLIMB_ON_PATH if hidden else CLIMB_FREELY
        evidence = response_evidence(view, particles.positions, climb, self.parameters.visibility)
        return _Look(view, *evidence, scale)

    def _observe_return(self, frame: Frame, departure: Departure, elapsed: float) -> Observation:
        """Look for a vehicle that has left where it left; it is visible once that is proven."""
        learnt = departure.size * self._padding
        patch = self._appearance.patch(frame, departure.position, learnt, wide=True)
        view = self._appearance.view(patch)
        returned = departure.returned(view, elapsed)
        if returned is None:
            self._particles = self._particles.all_visible(0.0)
            return Observation(view, departure.position, 0.0, again=True)
        position, velocity = returned
        self._particles = self._gathered(frame, position, velocity, 1 - DOUBT)
        return Observation(view, position, view.at(position), again=True)

    # Judge

    def _judge_visibility(
        self, frame: Frame, seen: Observation, elapsed: float, *, left_image: bool
    ) -> Visibility:
        """Decide how much of the vehicle is seen."""
        self._calm = self._is_calm(seen.response)
        if not seen.again:
            self._judge_points(self._appearance.usual_patch(seen.view.patch), seen.position)
        visible = self._particles.probability_visible > 0.5
        self._departure = self._judge_departure(frame, left=left_image, visible=visible)
        if self._departure is not None:
            self._turning.end()
            return Visibility.GONE
        self._turned = self._turning.follow(elapsed, seen.view)
        if self._turned is not None:
            return Visibility.TURNING
        if not visible:
            return Visibility.HIDDEN
        self._turning.end()
        self._judge_wholeness(frame, elapsed, again=seen.again)
        return Visibility.VISIBLE if self._wholeness.is_likely else Visibility.PARTLY_HIDDEN

    def _judge_points(self, patch: Patch, position: Array) -> None:
        """Take the share of the surface that moves with the vehicle as evidence on visibility."""
        evidence = self.parameters.visibility
        if not evidence.points_slope:
            self._surface.forget_share()
            return
        if self._measures_size:
            self._points.track(patch, position, self._size)
        share: float | None = self._surface.share
        if self._learns:
            share = self._surface.judge(patch, position, self._size)
        if share is not None:
            self._particles = self._particles.witnessed(points_evidence(share, evidence))

    def _judge_departure(self, frame: Frame, *, left: bool, visible: bool) -> Departure | None:
        """Tell how a hidden vehicle has left: by a border, or too far to be seen; None: it has not.

        One that has left stays so until it is visible.
        """
        if self._visibility is Visibility.GONE:
            return None if visible else self._departure
        if self._visibility is not Visibility.HIDDEN:
            return None
        position, size = keep_inside(frame, self._particles.mean), self._size
        if left and not visible:
            return Departure.by_border(frame, position, size, self._strangers)
        if is_too_far(size, np.array([self.target.box.width, self.target.box.height])):
            heading = self._particles.mean_velocity
            return Departure.far_away(position, size, heading, self._strangers)
        return None

    # Follow

    def _follow(self, frame: Frame, seen: Observation, elapsed: float) -> None:
        """Follow a vehicle that is seen, or the prediction of one that is not."""
        if self._turned is not None:
            self._follow_outline(frame, self._turned)
        elif self._visibility.is_seen:
            self._follow_sighting(frame, seen, elapsed)
        else:
            if not seen.again:
                self._enter_occlusion()
            elif self._visibility is Visibility.GONE:
                self._particles = self._particles.all_visible(0.0)
            self._position = keep_inside(frame, self._particles.mean)
            self._velocity = self._particles.mean_velocity

    def _enter_occlusion(self) -> None:
        """Predict from the last clear sightings: the occluder has dragged later ones along."""
        self._largest_hidden = LARGEST_GROWTH * self._size
        fitted = self._sightings.fit(perspective=self.parameters.motion.perspective)
        if fitted is None:
            self._particles = self._particles.all_visible(DOUBT)
            return
        motion, last = fitted
        if self.parameters.motion.turns and not last.cut:
            self._turning.begin(motion, last)
        self._size = last.size * motion.scale_at(last.age)
        self._largest_hidden = LARGEST_GROWTH * self._size
        sigma, count = self._hidden_velocity_sigma, self.parameters.num_particles
        self._particles = hidden_hypotheses(self._rng, motion, last.age, count, self._extent, sigma)

    # Learn

    def _learn_from(self, frame: Frame, seen: Observation) -> None:
        """Learn from a vehicle that is seen; keep what the next frame is compared with."""
        if self._turned is not None:
            self._learn_turn(frame, seen.view, self._turned.position)
        elif self._visibility.is_seen:
            self._learn_sighting(frame, seen)
        patch = self._appearance.usual_patch(seen.view.patch)
        if self._measures_size:
            self._points.keep(patch, self._position)
        self._surface.keep(patch, self._position, self._size)

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

"""The track of `fusion`: what is known of the vehicle, and how a sighting changes it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.camera_motion import CameraFlow, small_grey
from vehicle_pf_tracker.image.window import keep_inside
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View, searched_size
from vehicle_pf_tracker.trackers.fusion.departure import Departure, Strangers
from vehicle_pf_tracker.trackers.fusion.hypotheses import DOUBT, FASTEST_GROWTH, Hypotheses
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE, Sightings
from vehicle_pf_tracker.trackers.fusion.surface_flow import SurfaceFlow
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints
from vehicle_pf_tracker.trackers.fusion.turning import Turned, TurningBranch
from vehicle_pf_tracker.trackers.fusion.visibility import Visibility, Wholeness

_TURNING_STIFFNESS = 0.5
"""Resistance against change while a vehicle turns, a tenth of the usual: within the 20 frames of a
turn by 90 degrees nothing that was learnt before stays right (scene `turn`, seed 100)."""
_LEAST_LEVEL, _TURNING_LEVEL_RATE = 0.3, 0.3
"""Least response that the usual one follows in a turn, and how fast: a new level in 3 frames."""
_TURNING_SHARE, _TURNING_RESPONSE = 0.85, 0.7
"""Share of the surface that still moves with a vehicle that turns, and response below which it
does: it is learnt the faster then the lower the response, as what it looked like is out of date."""
_LEAST_PLIANT = 0.2
"""Response below which learning becomes no faster: five times the usual speed."""
_CALM_RESPONSE, _CALM_SHARE = 0.9, 0.9
"""Response, and share of the surface, above which a frame is calm: the size is followed in one,
flow judged and appearance learnt in the next. That saves a quarter of the time and, over 633 runs,
costs nothing else that could be seen (laboratory/notes/fusion_tried.md)."""
_SETTLED = 10
"""Frames before which none is calm: the usual response and share are not known yet."""
_DATED_EVERY = 40
"""Frames between two filters that are kept, all of calm frames: in a second a vehicle turns."""
_STRONG = 0.8
"""Probability of visibility from which the size is followed."""
_WEAK_RESPONSE = 0.6
"""Response below which sizes are not followed: a half-hidden vehicle looks smaller."""
_LEAST_LEARNT = 0.5
"""Response below which nothing is learnt: what is there differs in more than it agrees."""
_WHOLE = 0.8
"""Share of the surface from which the spread of points tells the size: what an occluder covers,
shrinks."""
_LARGEST_PARTIAL = 1.5
"""Bound of the growth, and of the shrinking, of a partly hidden vehicle, since it became that or
came back as that. It is a tenth on the real sequences; an error of the rate must not go on for as
long as a vehicle waits behind a hedge."""
_LEAST_SIDE, _LARGEST_SHARE = 3.0, 1.5
"""Bounds of the sides: px, and share of the image."""
_NEW_VELOCITY = 3.0
"""Spread of the first velocities in units of the change per frame: none is known yet."""


class Observation(NamedTuple):
    """Vehicle as it was found in the present frame.

    Attributes
    ----------
    view : View
        The response around it.
    position : (2,) array
        Centre, px.
    response : float
        Height of the peak there, relative to the usual one.
    again : bool
        True for a vehicle that was hidden before.
    """

    view: View
    position: Array
    response: float
    again: bool


class Track(ParticleTracker[FusionParameters]):
    """Position, size, motion and appearance; the algorithm is in `tracker.py`."""

    _particles: Hypotheses

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `BaseTracker.start`."""
        self._size = np.array([box.width, box.height], float)
        self._position = np.array(box.centre, float)
        self._velocity = np.zeros(2)
        self._frames = self._searches = self._next_dated = 0
        self._visibility, self._calm = Visibility.VISIBLE, False
        self._set_off = False
        self._turned: Turned | None = None
        self._departure: Departure | None = None
        self._largest_hidden = self._size
        self._growth = self._grown = 0.0
        self._strangers = Strangers()
        self._wholeness = Wholeness()
        self._sightings = Sightings()
        self._points = SurfacePoints()
        self._surface = SurfaceFlow()
        self._turning = TurningBranch()
        self._camera = CameraFlow()
        self._camera.measure(small_grey(frame), box)
        estimate = super().start(frame, box)
        patch = self._appearance.patch(frame, self._position, self._size)
        self._points.keep(patch, self._position)
        self._surface.keep(patch, self._position, self._size)
        return estimate

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `BaseTracker.reconfigure`."""
        recoloured = parameters.filter.colour != self.parameters.filter.colour
        super().reconfigure(parameters)
        if self._target is not None:
            self._appearance.use_kernels(self.kernels)
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

    @property
    def _hidden_velocity_sigma(self) -> float:
        """Change of a hidden vehicle's velocity, of the size, per frame squared.

        Larger where sightings were carried along with a camera that moved: the background's motion
        is not quite that of the road under the vehicle.
        """
        motion = self.parameters.motion
        if self._sightings.are_steady:
            return motion.hidden_velocity_sigma
        return math.hypot(motion.hidden_velocity_sigma, motion.camera_velocity_sigma)

    @property
    def _learnt_size(self) -> Array:
        """Size in px of the part that the filter has learnt, which may be padded."""
        return np.asarray(self._size * self._padding)

    # Work that calm frames share

    def _is_calm(self, response: float) -> bool:
        """Test whether a vehicle is surely in view, and looks and moves as it did."""
        known = self._visibility.is_seen and self._surface.tells and self._frames > _SETTLED
        return known and response > _CALM_RESPONSE and self._surface.share > _CALM_SHARE

    @property
    def _measures_size(self) -> bool:
        """True in frames in which the size is followed: all but every second calm one."""
        return not self._calm or self._frames % 2 == 1

    @property
    def _learns(self) -> bool:
        """True in frames in which flow is judged and appearance learnt: the others, if calm."""
        return not self._calm or self._frames % 2 == 0

    # Judge

    def _judge_wholeness(self, frame: Frame, elapsed: float, *, again: bool) -> None:
        """Judge whether all of the vehicle is seen; predict the size of one that is partly hidden.

        It grows as it did in the sightings before: what shows of it tells no size.
        """
        was_whole = self._wholeness.is_likely
        if not again:  # until then the share is of what was there before
            self._wholeness.judge(self._surface.share, elapsed, self.parameters.visibility)
        if self._wholeness.is_likely:
            return
        if was_whole:
            fitted = self._sightings.fit(perspective=self.parameters.motion.perspective)
            rate = 0.0 if fitted is None else fitted[0].rate
            self._growth = min(max(rate, -FASTEST_GROWTH), FASTEST_GROWTH)
        before = 0.0 if was_whole or again else self._grown
        bound = math.log(_LARGEST_PARTIAL)
        self._grown = min(max(before + self._growth * elapsed, -bound), bound)
        self._size = self._bounded(frame, self._size * math.exp(self._grown - before))

    # Follow

    def _follow_sighting(self, frame: Frame, seen: Observation, elapsed: float) -> None:
        """Take position, velocity and, of a vehicle seen whole, size from the peak."""
        self._gather(frame, seen.position, elapsed, again=seen.again)
        if self._measures_size and self._is_sure and seen.response > _WEAK_RESPONSE:
            self._follow_size(frame, again=seen.again)
        self._sightings.add(self._position, self._size, seen.response)

    @property
    def _is_sure(self) -> bool:
        """True of a vehicle that is surely visible, and as a whole."""
        return self._wholeness.is_likely and self._particles.probability_visible > _STRONG

    def _gather(self, frame: Frame, position: Array, elapsed: float, *, again: bool) -> None:
        """Centre the hypotheses on the sighting; their velocities take on the displacement."""
        particles, motion = self._particles, self.parameters.motion
        moved = (position - self._position) / max(elapsed, 1e-3)
        if again:
            visible = particles.probability_visible
            self._particles = self._gathered(frame, position, particles.mean_velocity, visible)
        else:
            gain = 1.0 if self._frames == 1 else motion.gain
            velocities = particles.velocities + gain * (moved - particles.velocities)
            centred = keep_inside(frame, particles.positions + (position - particles.mean))
            self._particles = replace(particles, positions=centred, velocities=velocities)
        self._position = position
        self._velocity = self._particles.mean_velocity

    def _gathered(
        self, frame: Frame, position: Array, velocity: Array, visible: float
    ) -> Hypotheses:  # fmt: skip
        """Draw hypotheses around a position, all of one velocity."""
        count, motion = self.parameters.num_particles, self.parameters.motion
        spread = self._rng.normal(size=(count, 2)) * motion.position_sigma * self._extent
        velocities = np.repeat(velocity[np.newaxis], count, axis=0)
        inside = keep_inside(frame, position + spread)
        return Hypotheses.around(inside, velocities, np.zeros(count), visible)

    def _follow_size(self, frame: Frame, *, again: bool) -> None:
        options = self.parameters.size

        def peak(size: Array) -> float:
            return self._appearance.response_at(frame, self._position, size * self._padding)

        size = self._size
        self._searches += 1
        if not again and options.step and self._surface.share > _WHOLE:
            size = size * np.exp(options.points_gain * self._points.stretch)
        self._size = self._bounded(frame, searched_size(size, self._searches, peak, options))

    def _follow_outline(self, frame: Frame, turned: Turned) -> None:
        """Take position, size and velocity from the outline of a vehicle that turns."""
        self._calm = False
        self._position = keep_inside(frame, turned.position)
        self._size = self._bounded(frame, turned.size)
        self._particles = self._gathered(frame, self._position, turned.velocity, 1 - DOUBT)
        self._velocity = turned.velocity
        self._sightings.add(self._position, self._size, 1.0)

    # Learn

    def _learn_sighting(self, frame: Frame, seen: Observation) -> None:
        """Learn the usual values, new points, and what the vehicle and strangers look like."""
        whole = self._wholeness.is_likely
        if seen.again:
            self._points.restart()
        if self._is_sure and seen.response > CLEAR_RESPONSE:
            self._surface.learn_usual()
        if self._measures_size and self.parameters.visibility.points_slope:
            self._points.renew(self._position, self._size, whole=whole)
        self._learn_appearance(frame, seen.view, seen.response)
        if self._calm and self._frames >= self._next_dated:
            self._appearance.remember(self.parameters.filter.memory)
            self._next_dated = self._frames + _DATED_EVERY
        if whole:
            self._strangers.measure(seen.view, self._position, self._size)
        if seen.again:  # what was kept shows an occluder; until now its share bounds the learning
            self._surface.restart()

    def _learn_turn(self, frame: Frame, view: View, position: Array) -> None:
        """Learn fast what a vehicle that turns looks like now."""
        response = view.at(position)
        self._points.restart()
        if self.parameters.visibility.points_slope:
            self._points.renew(self._position, self._size)
        self._appearance.learn_usual(min(max(response, _LEAST_LEVEL), 1.0), _TURNING_LEVEL_RATE)
        # Without a spectrum the cells are measured again, at the size that the outline tells.
        bare = replace(view, spectrum=None)
        self._appearance.learn(frame, bare, self._position, self._learnt_size, _TURNING_STIFFNESS)

    def _learn_appearance(self, frame: Frame, view: View, response: float) -> None:
        """Train the filter on a whole or turning vehicle, the less the less surely it shows."""
        options = self.parameters.filter
        share = self._surface.share
        turns = self._surface.tells and share > _TURNING_SHARE and response < _TURNING_RESPONSE
        turns &= not self._turning.can_begin  # outlines tell more of a turn, size included
        if not turns and (response <= _LEAST_LEARNT or not self._wholeness.is_likely):
            return
        visible = self._particles.probability_visible
        rate = max(options.level_rate, 1 / (self._frames + 1)) * visible
        self._appearance.learn_usual(response, rate)
        if not self._learns:
            return
        stiffness = options.stiffness / visible
        if turns:
            stiffness *= max(response, _LEAST_PLIANT)
        self._appearance.learn(frame, view, self._position, self._learnt_size, stiffness)

    # Report

    def _bounded(self, frame: Frame, size: Array) -> Array:
        return np.clip(size, _LEAST_SIDE, _LARGEST_SHARE * max(frame_size(frame)))

    @property
    def _regime(self) -> str:
        """Branch of the algorithm: visible, occluded, or how the vehicle has left."""
        if self._departure is not None:
            return self._departure.reason
        return "visible" if self._visibility.is_seen else "occluded"

    def _outcome(self, frame: Frame, response: float, *, left_image: bool) -> Outcome:
        particles = self._particles
        positions = keep_inside(frame, particles.positions)
        (x, y), (vx, vy) = self._position.tolist(), self._velocity.tolist()
        return Outcome(
            Cloud(positions, particles.weights), (x, y), (vx, vy),
            self._regime, particles.probability_visible,
            {
                "response": min(max(response, 0.0), 1.0), "points": self._surface.share,
                "whole": self._wholeness.probability,
            },
            left_image=left_image or self._visibility is Visibility.GONE,
        )  # fmt: skip

    def _estimate(self, outcome: Outcome, mode: Mode, confidence: float, began: float) -> Estimate:
        width, height = self._size.tolist()
        estimate = super()._estimate(outcome, mode, confidence, began)
        return replace(estimate, box=Box.around(outcome.position, width, height))

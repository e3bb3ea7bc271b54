"""What `fusion` knows of its target, and how that is carried along with time and camera."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.image.camera_motion import CameraFlow, CameraMotion
from vehicle_pf_tracker.image.small_grey import small_grey
from vehicle_pf_tracker.image.window import keep_inside
from vehicle_pf_tracker.trackers.base import Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.background import Background
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.fine_alignment import FineAlignment
from vehicle_pf_tracker.trackers.fusion.history import History, Trend, carried
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.particles import Particles, Spread
from vehicle_pf_tracker.trackers.fusion.search import Search
from vehicle_pf_tracker.trackers.fusion.suspicion import Suspicion
from vehicle_pf_tracker.trackers.fusion.turning import Turns

_LEAST_EXTENT = 7.0
"""px that the geometric mean of the sides of the box may shrink to."""
_STANDS_STILL = 5
"""Frames without motion after which the camera is taken to stand."""


class FusionState(ParticleTracker[FusionParameters]):
    """Start, reconfiguration and bookkeeping of `fusion`; its steps are in `FusionTracker`."""

    _particles: Particles

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `Tracker.start`."""
        estimate = super().start(frame, box)
        self._place, self._scale, self._velocity = estimate.position, 1.0, (0.0, 0.0)
        self._draw_around(frame, 0.0)
        self._history = History(self._side)
        self._suspicion = Suspicion()
        self._search: Search | None = None
        self._emergence: Emergence | None = None
        self._alignment = FineAlignment()
        self._background = Background()
        self._turns = Turns()
        self._flow = CameraFlow()
        self._small = small_grey(frame)
        self._flow.measure(self._small, box)
        self._trend: Trend | None = None
        self._frames = self._still_frames = 0
        return estimate

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `Tracker.reconfigure`."""
        super().reconfigure(parameters)
        if self._target is not None:
            if not parameters.hiding.turns:
                self._turns = Turns()
            if parameters.cues != self._appearance.cues:
                self._appearance.use(parameters.cues)
            if len(self._particles.weights) != parameters.num_particles:
                self._particles = self._particles.resampled(self._rng, parameters.num_particles)

    def _learn(self) -> None:
        target, window = self.target, self.parameters.window
        self._size = target.box.width, target.box.height
        learnt = window.width or self._size[0], window.height or self._size[1]
        self._appearance = Appearance(target.patch, target.centre, learnt, self.parameters.cues)

    def _scatter(self, centre: Position) -> Array:
        return np.asarray(centre) + sample_normal(self._rng, self.parameters.num_particles, 0.5)

    @property
    def _side(self) -> float:
        """Geometric mean of the sides of the box at scale 1, px."""
        return math.sqrt(self._size[0] * self._size[1])

    @property
    def _extent(self) -> float:
        """The same of the present box."""
        return self._side * self._scale

    def _box(self, place: Position) -> Box:
        return Box.around(place, self._size[0] * self._scale, self._size[1] * self._scale)

    def _inside(self, frame: Frame, place: Position) -> Position:
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        return x, y

    def _kept(self, frame: Frame, particles: Particles) -> Particles:
        """Keep places in the image, and sizes between a few px and the image's."""
        return particles.kept(frame, self._scale_bounds(frame))

    def _scale_bounds(self, frame: Frame) -> tuple[float, float]:
        if not self.parameters.motion.scale:
            return 1.0, 1.0
        largest = 2.0 * max(frame_size(frame)) / max(self._size)
        return min(_LEAST_EXTENT / self._side, 1.0), max(largest, 1.0)

    def _draw_around(self, frame: Frame, share: float) -> None:
        """Draw all particles around the present state; `share` is their spread, of the size."""
        spread = Spread(share * self._extent, 0.0, 0.0)
        count = self.parameters.num_particles
        particles = Particles.around(
            self._rng, count, self._place, self._velocity, self._scale, spread
        )
        self._particles = self._kept(frame, particles)

    def _pass_time(self, frame: Frame, elapsed: float) -> None:
        """Take everything that is known along with the background and with time."""
        self._small = small_grey(frame)
        motion = self._camera_motion()
        self._still_frames = self._still_frames + 1 if motion.still else 0
        self._history.age(elapsed, motion)
        if self._search is not None:
            self._search.age(elapsed, motion)
        if self._trend is not None:
            self._trend = self._trend.after(elapsed)
        if not motion.still:
            self._carry(motion)
        if self.parameters.hiding.turns:
            self._turns.watch(
                frame, self._box(self._place), elapsed,
                still=self._still_frames >= _STANDS_STILL, seen=self._search is None,
            )  # fmt: skip
        self._frames += 1

    def _camera_motion(self) -> CameraMotion:
        if not self.parameters.motion.camera:
            return CameraMotion()
        return self._flow.measure(self._small, self._box(self._place))

    def _carry(self, motion: CameraMotion) -> None:
        self._background.forget()
        self._particles = self._particles.carried(motion)
        self._place = carried(self._place, motion)
        self._scale *= motion.scale
        if self._trend is not None:
            self._trend = self._trend.carried(motion)

    def _adopt(self, frame: Frame, box: Box) -> None:
        """Take a box of another shape: a vehicle that turns shows another side."""
        self._size, self._scale = (box.width, box.height), 1.0
        self._place = self._inside(frame, box.centre)
        self._appearance = self._appearance.reshaped(frame, self._place, self._size)
        self._history.reshape(self._side)
        self._suspicion.renew()
        self._alignment.forget()
        self._search = self._emergence = self._trend = None

    def _estimate(self, outcome: Outcome, mode: Mode, confidence: float, began: float) -> Estimate:
        estimate = super()._estimate(outcome, mode, confidence, began)
        box = self._box(outcome.position) if outcome.regime != "start" else self.target.box
        return replace(estimate, box=box)

"""`fusion`: a particle filter that takes the best idea of each paper and adds what they lack.

While the target is seen: camera motion, constant velocity, fused cues on a canonical region,
adaptive resampling, judgement, learning. In doubt nothing is learnt, and the particles are held
to the motion that clear frames foretell. While it is hidden: that motion goes on, particles drift
along it, and a search widens with them. docs/fusion.md tells what each part is for.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from vehicle_pf_tracker.features.box import Box
from vehicle_pf_tracker.features.camera_motion import CameraFlow, CameraMotion
from vehicle_pf_tracker.features.frame import Frame, frame_size
from vehicle_pf_tracker.features.small_grey import small_grey
from vehicle_pf_tracker.features.window import is_outside, keep_inside
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log
from vehicle_pf_tracker.trackers.base import Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Array, Estimate, Mode
from vehicle_pf_tracker.trackers.fusion_parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion_parts.appearance import Appearance, Likeness
from vehicle_pf_tracker.trackers.fusion_parts.background import Background
from vehicle_pf_tracker.trackers.fusion_parts.candidates import Chain
from vehicle_pf_tracker.trackers.fusion_parts.fine_alignment import FineAlignment
from vehicle_pf_tracker.trackers.fusion_parts.history import History, Trend, carried
from vehicle_pf_tracker.trackers.fusion_parts.likelihood import Prior, log_likelihood
from vehicle_pf_tracker.trackers.fusion_parts.particles import Particles, Spread
from vehicle_pf_tracker.trackers.fusion_parts.search import Foretold, Search
from vehicle_pf_tracker.trackers.fusion_parts.suspicion import Suspicion, Verdict
from vehicle_pf_tracker.trackers.fusion_parts.view import View

Place: TypeAlias = tuple[float, float]

_SIZES = tuple(1.07**step for step in (-1, 0, 1))
_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step."""
_LEAST_EXTENT = 7.0
"""px that the geometric mean of the sides of the box may shrink to."""
_DEGENERATE = 0.4
"""Share of the particles below which the effective sample size is too small (P3)."""
_YOUNG_FRAMES = 6
_YOUNG_SPREAD = 1.5
_DOUBTED = 4.0
"""Latest frames that no trend is fitted to in doubt: an occluder may have dragged them along."""
_ROLLED_BACK = 6.0
"""The same once the target is hidden."""
_UNSIZED = 3.0
"""Sightings before the doubt whose sizes are not believed: half covered it looks smaller."""
_RATE_IN_TURNS = 0.2


class FusionTracker(ParticleTracker[FusionParameters]):
    """The flagship."""

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `Tracker.start`."""
        estimate = super().start(frame, box)
        self._place, self._scale, self._velocity = estimate.position, 1.0, (0.0, 0.0)
        count = self.parameters.num_particles
        still = Spread(0.0, 0.0, 0.0)
        self._particles = Particles.around(self._rng, count, self._place, (0.0, 0.0), 1.0, still)
        self._history = History(self._side)
        self._suspicion = Suspicion()
        self._search: Search | None = None
        self._alignment = FineAlignment()
        self._background = Background()
        self._flow = CameraFlow()
        self._small = small_grey(frame)
        self._flow.measure(self._small, box)
        self._trend: Trend | None = None
        self._frames = 0
        return estimate

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `Tracker.reconfigure`."""
        super().reconfigure(parameters)
        if self._target is not None:
            if parameters.cues != self._appearance.cues:
                self._appearance.use(parameters.cues)
            if len(self._particles.weights) != parameters.num_particles:
                self._particles = self._particles.resampled(self._rng, parameters.num_particles)

    def _learn(self) -> None:
        target, window = self.target, self.parameters.window
        self._size = target.box.width, target.box.height
        learnt = window.width or self._size[0], window.height or self._size[1]
        self._appearance = Appearance(target.patch, target.centre, learnt, self.parameters.cues)

    def _scatter(self, centre: Place) -> Array:
        return np.asarray(centre) + sample_normal(self._rng, self.parameters.num_particles, 0.5)

    @property
    def _side(self) -> float:
        """Geometric mean of the sides of the first box, px."""
        return math.sqrt(self._size[0] * self._size[1])

    @property
    def _extent(self) -> float:
        """The same of the present box."""
        return self._side * self._scale

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        _ = self.target  # says what is wrong before the start
        elapsed = min(elapsed, _LONGEST_STEP)
        self._small = small_grey(frame)
        self._carry(self._camera_motion(), elapsed)
        self._frames += 1
        if self._search is None or self._trend is None:
            return self._follow(frame, elapsed)
        return self._look_for(frame, self._trend, self._search, elapsed)

    def _camera_motion(self) -> CameraMotion:
        if not self.parameters.motion.camera:
            return CameraMotion()
        return self._flow.measure(self._small, self._box(self._place))

    def _carry(self, motion: CameraMotion, elapsed: float) -> None:
        """Take everything that is known along with the background and with time."""
        self._history.age(elapsed, motion)
        if self._search is not None:
            self._search.age(elapsed, motion)
        if self._trend is not None:
            self._trend = self._trend.after(elapsed)
        if motion.still:
            return
        self._background.forget()
        self._particles = self._particles.carried(motion)
        self._place = carried(self._place, motion)
        self._scale *= motion.scale
        if self._trend is not None:
            self._trend = self._trend.carried(motion)

    # ---- in sight

    def _follow(self, frame: Frame, elapsed: float) -> Outcome:
        particles, left_image = self._predicted(frame, elapsed)
        expected_scale = particles.scale
        view = self._look_around(frame, particles.place, expected_scale)
        particles, sound, passes, redrawn = self._weighed(frame, view, particles)
        place, scale = self._refined(frame, view, particles, expected_scale)
        self._take(frame, particles, place, scale, elapsed)
        likeness = self._appearance.compare(view, self._place, scale)
        verdict = self._judge_looks(view, likeness)
        self._learn_from(view, likeness, verdict)
        told = self._place
        if verdict.hidden:
            self._lose_sight(frame)
            told = self._place
        elif verdict.gone and self._trend is not None:
            told = self._inside(frame, self._trend.now()[0])
        return Outcome(
            self._particles.cloud(sound=sound), told, self._velocity,
            "hidden" if verdict.hidden else "seen", self._evidence(likeness, verdict),
            _told(likeness), passes, redrawn, left_image,
        )  # fmt: skip

    def _predicted(self, frame: Frame, elapsed: float) -> tuple[Particles, bool]:
        """Resample and drive all particles on (P1 eq. 1, constant velocity)."""
        particles = self._particles.resampled(self._rng, len(self._particles.weights))
        growth = self._history.growth() if self.parameters.motion.scale else 0.0
        moved = particles.moved(self._rng, elapsed, growth, self._spread())
        left_image = is_outside(frame, *moved.positions.mean(axis=0).tolist())
        return self._kept(frame, moved), left_image

    def _spread(self) -> Spread:
        motion = self.parameters.motion
        young = _YOUNG_SPREAD if self._frames <= _YOUNG_FRAMES else 1.0
        return Spread(
            young * motion.sigma * self._extent,
            young * motion.velocity_sigma * self._extent,
            motion.scale_sigma,
        )

    def _kept(self, frame: Frame, particles: Particles) -> Particles:
        """Keep places in the image, and sizes between a few px and the image's."""
        return particles.kept(frame, self._scale_bounds(frame))

    def _scale_bounds(self, frame: Frame) -> tuple[float, float]:
        if not self.parameters.motion.scale:
            return 1.0, 1.0
        largest = 2.0 * max(frame_size(frame)) / max(self._size)
        return min(_LEAST_EXTENT / self._side, 1.0), max(largest, 1.0)

    def _look_around(self, frame: Frame, place: Place, scale: float) -> View:
        reach = 0.6 * max(self._size) * scale
        sizes = _SIZES if self.parameters.motion.scale else (1.0,)
        return self._appearance.look(frame, place, scale, reach, sizes)

    def _weighed(
        self, frame: Frame, view: View, particles: Particles
    ) -> tuple[Particles, bool, int, int]:
        """Weigh the particles; draw those of low weight anew while few carry all (P3)."""
        doubted = self._suspicion.frames and self.parameters.hiding.gate
        prior = Prior(
            particles.place, self._extent, self._trend if doubted else None,
            self._suspicion.innovation,
        )  # fmt: skip
        particles, sound = self._weigh(view, particles, prior)
        passes = redrawn = 0
        least = _DEGENERATE * len(particles.weights)
        while (
            passes < self.parameters.resampling_passes
            and effective_sample_size(particles.weights) < least
        ):
            particles, drawn = particles.renewed(self._rng, self._spread().times(0.4))
            particles, sound = self._weigh(view, self._kept(frame, particles), prior)
            passes, redrawn = passes + 1, redrawn + drawn
        return particles, sound, passes, redrawn

    def _weigh(self, view: View, particles: Particles, prior: Prior) -> tuple[Particles, bool]:
        logs = log_likelihood(view, particles, self.parameters.sharpness, prior)
        weights, sound = from_log(logs)
        return replace(particles, weights=weights), sound

    def _refined(
        self, frame: Frame, view: View, particles: Particles, expected_scale: float
    ) -> tuple[Place, float]:
        """Climb from the particles' mean to the peak, and align there while nothing is in doubt."""
        scale = particles.scale
        place = view.refine(particles.place, scale)
        if not self.parameters.cues.alignment or self._suspicion.frames:
            return place, scale
        place, scale = self._alignment.improve(self._appearance, view, place, scale, expected_scale)
        low, high = self._scale_bounds(frame)
        return place, min(max(scale, low), high)

    def _take(
        self, frame: Frame, particles: Particles, place: Place, scale: float, elapsed: float
    ) -> None:
        """Move on to the estimate; the velocity takes its share of the displacement."""
        gain, motion = self.parameters.motion.gain, self._velocity
        gain = max(gain, 0.8 / self._frames)
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        if elapsed > 0:
            moved = (x - self._place[0]) / elapsed, (y - self._place[1]) / elapsed
            self._velocity = (
                motion[0] + gain * (moved[0] - motion[0]),
                motion[1] + gain * (moved[1] - motion[1]),
            )
        drawn = particles.drawn_towards((x, y), self._velocity, scale)
        self._particles = self._kept(frame, drawn)
        self._place, self._scale = (x, y), scale

    def _judge_looks(self, view: View, likeness: Likeness) -> Verdict:
        if self._frames == 1:
            self._suspicion.settle(likeness)
        hiding = self.parameters.hiding
        background = hiding.background and self._background.shows(
            self._small, self._box(self._place)
        )
        if self._suspicion.is_clear(likeness) and not background:
            self._trend = self._history.trend(1.0, projective=hiding.projective)
        else:
            self._trend = self._history.trend(
                1.0 + _DOUBTED, projective=hiding.projective, unsized=_UNSIZED
            )
        off = 0.0 if self._trend is None else math.dist(self._trend.now()[0], self._place)
        return self._suspicion.judge(
            likeness,
            off / self._extent,
            lambda: self._appearance.best_half(view, self._place, self._scale),
            gate=hiding.gate,
            grey=self._appearance.grey,
            patience=hiding.patience,
            background=background,
        )

    def _learn_from(self, view: View, likeness: Likeness, verdict: Verdict) -> None:
        place, scale = self._place, self._scale
        if verdict.turning:
            self._appearance.learn(view, place, scale, _RATE_IN_TURNS)
        if verdict.renewed:
            self._alignment.forget()
        if verdict.clear:
            self._history.see(place, scale)
            self._background.keep(self._small, self._box(place))
            self._appearance.learn(view, place, scale, self.parameters.cues.template_rate)
            self._appearance.learn_colours(view, place, scale)
            self._appearance.weigh_cues(view, place, scale)

    def _evidence(self, likeness: Likeness, verdict: Verdict) -> float:
        """Give what the mode is judged by: the looks, of their clear level, unless in doubt."""
        share = self._suspicion.share(likeness)
        if verdict.gone or self._suspicion.doubtful:
            return min(share, self._ceiling)
        return max(share, self.parameters.evidence.clear_above)

    @property
    def _ceiling(self) -> float:
        """Evidence that no mode but `TRACKING` is left with."""
        return 0.99 * self.parameters.evidence.occluded_below * self._judge.level

    # ---- hidden

    def _lose_sight(self, frame: Frame) -> None:
        """Go back to the confident frames, and foretell the motion from them."""
        hiding = self.parameters.hiding
        back = _ROLLED_BACK if hiding.retrospect else 0.0
        unsized = _UNSIZED if hiding.retrospect else 0.0
        self._trend = (
            self._history.trend(back, projective=hiding.projective, unsized=unsized)
            or self._history.trend(0.0, projective=hiding.projective)
            or Trend.still(self._place, self._scale)
        )
        self._search = Search(self._appearance, self._suspicion, self._background)
        self._suspicion.reset()
        self._scatter_on(frame, self._trend)
        self._foretell(frame, self._trend)

    def _scatter_on(self, frame: Frame, trend: Trend) -> None:
        place, scale = trend.now()
        spread = Spread(0.1 * self._side * scale, 0.0, 0.0)
        count = self.parameters.num_particles
        particles = Particles.around(self._rng, count, place, trend.velocity(), scale, spread)
        self._particles = self._kept(frame, particles)

    def _foretell(self, frame: Frame, trend: Trend) -> bool:
        """Move on to the foretold state; tells whether its place is in the image."""
        place, scale = trend.now()
        low, high = self._scale_bounds(frame)
        self._scale = min(max(scale, low), high)
        self._velocity = trend.velocity()
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        self._place = x, y
        return not is_outside(frame, *place)

    def _inside(self, frame: Frame, place: Place) -> Place:
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        return x, y

    def _look_for(self, frame: Frame, trend: Trend, search: Search, elapsed: float) -> Outcome:
        """Let the particles drift on, and look for the target where they are."""
        inside = self._foretell(frame, trend)
        self._particles = self._particles.drifted(
            self._rng, elapsed, self._velocity, self._scale, 0.03 * self._extent,
            along=self.parameters.hiding.drift,
        )  # fmt: skip
        self._particles = self._kept(frame, self._particles)
        parameters = self.parameters
        foretold = Foretold(
            self._place, self._velocity, self._scale, self._extent, self._particles.width
        )
        share = search.look(
            frame, self._small, foretold,
            wide=parameters.hiding.search, sizes=parameters.motion.scale,
        )  # fmt: skip
        chain = search.proof(foretold, parameters.hiding.confirm)
        if chain is not None:
            return self._come_back(frame, chain)
        return Outcome(
            self._particles.cloud(), self._place, self._velocity, "hidden",
            min(share, self._ceiling), {}, left_image=not inside,
        )  # fmt: skip

    def _come_back(self, frame: Frame, chain: Chain) -> Outcome:
        """Follow a candidate from now on."""
        found = chain.links[-1]
        x, y = keep_inside(frame, np.asarray(found.place)).tolist()
        self._place, self._scale = (x, y), found.scale
        self._velocity = (
            0.5 * (self._velocity[0] + chain.velocity[0]),
            0.5 * (self._velocity[1] + chain.velocity[1]),
        )
        spread = Spread(0.05 * self._extent, 0.0, 0.0)
        count = self.parameters.num_particles
        particles = Particles.around(
            self._rng, count, self._place, self._velocity, self._scale, spread
        )
        self._particles = self._kept(frame, particles)
        for one in chain.links:
            self._history.see(one.place, one.scale, one.age)
        self._search = self._trend = None
        self._suspicion.reset()
        cloud = self._particles.cloud()
        return Outcome(cloud, self._place, self._velocity, "found", 1.0, {})

    def _box(self, place: Place) -> Box:
        return Box.around(place, self._size[0] * self._scale, self._size[1] * self._scale)

    def _estimate(self, outcome: Outcome, mode: Mode, confidence: float, began: float) -> Estimate:
        estimate = super()._estimate(outcome, mode, confidence, began)
        box = self._box(outcome.position) if outcome.regime != "start" else self.target.box
        return replace(estimate, box=box)


def _told(likeness: Likeness) -> dict[str, float]:
    return {
        "anchor": likeness.anchor,
        "following": likeness.following,
        "colour": likeness.colour,
    }

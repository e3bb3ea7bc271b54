"""`fusion`: a particle filter that takes the best idea of each paper and adds what they lack.

While the target is seen: camera motion, constant velocity, fused cues on a canonical region,
adaptive resampling, judgement, learning. While it is hidden: its projective motion foretold from
confident frames, particles that drift along it, and a search that widens with them.
docs/fusion.md tells what each part is for.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from vehicle_pf_tracker.features.box import Box
from vehicle_pf_tracker.features.camera_motion import CameraFlow, CameraMotion
from vehicle_pf_tracker.features.frame import Frame, frame_size
from vehicle_pf_tracker.features.window import is_outside, keep_inside
from vehicle_pf_tracker.filtering.motion import (
    RAYLEIGH_MEAN,
    sample_normal,
    sample_normal_rayleigh,
)
from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log
from vehicle_pf_tracker.trackers.base import Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.estimate import Array, Estimate, Mode
from vehicle_pf_tracker.trackers.fusion_parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion_parts.appearance import Appearance, Likeness
from vehicle_pf_tracker.trackers.fusion_parts.candidates import Candidate, Candidates
from vehicle_pf_tracker.trackers.fusion_parts.conviction import Conviction, Verdict
from vehicle_pf_tracker.trackers.fusion_parts.history import History, Sighting, carried
from vehicle_pf_tracker.trackers.fusion_parts.projective_motion import ProjectiveMotion
from vehicle_pf_tracker.trackers.fusion_parts.swarm import Spread, Swarm
from vehicle_pf_tracker.trackers.fusion_parts.view import View

Place: TypeAlias = tuple[float, float]

_SIZES = (1 / 1.06, 1.0, 1.06)
_SIZES_OF_SEARCH = (1 / 1.3, 1 / 1.14, 1.0, 1.14, 1.3)
_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step."""
_LEAST_SIDE = 6.0
"""px that the longer side of the box may shrink to."""
_DEGENERATE = 0.4
"""Share of the particles below which the effective sample size is too small (P3)."""
_RATE_IN_TURNS = 0.25
_SIGHTINGS_IN_TURNS = 10


class FusionTracker(ParticleTracker[FusionParameters]):
    """The flagship."""

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target; see `Tracker.start`."""
        self._swarm = Swarm.around(self._rng, 1, box.centre, (0.0, 0.0), 1.0, 1.0)
        estimate = super().start(frame, box)
        self._place, self._scale, self._velocity = estimate.position, 1.0, (0.0, 0.0)
        self._begin(self._place, 1.0, (0.0, 0.0))
        self._conviction = Conviction()
        self._flow = CameraFlow()
        self._flow.measure(frame, box)
        return estimate

    def reconfigure(self, parameters: FusionParameters) -> None:
        """Take new parameters; see `Tracker.reconfigure`."""
        super().reconfigure(parameters)
        if self._target is not None:
            self._appearance.cues = parameters.cues
            if len(self._swarm.weights) != parameters.num_particles:
                self._swarm = self._swarm.resampled(self._rng, parameters.num_particles)

    def _learn(self) -> None:
        target, cues = self.target, self.parameters.cues
        window = self.parameters.window
        self._size = target.box.width, target.box.height
        learnt = window.width or self._size[0], window.height or self._size[1]
        self._appearance = Appearance(target.patch, target.centre, learnt, cues.side, cues)

    def _scatter(self, centre: Place) -> Array:
        return np.asarray(centre) + sample_normal(self._rng, self.parameters.num_particles, 0.5)

    def _begin(self, place: Place, scale: float, velocity: Place) -> None:
        """Begin to follow what is seen here."""
        self._history = History().restarted(Sighting(place, scale))
        self._swarm = Swarm.around(
            self._rng, self.parameters.num_particles, place, velocity, scale, self._side * scale
        )
        self._path: ProjectiveMotion | None = None
        self._frames = 0
        self._candidates = Candidates()

    @property
    def _side(self) -> float:
        """Geometric mean of the sides of the first box, px."""
        return math.sqrt(self._size[0] * self._size[1])

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        _ = self.target  # says what is wrong before the start
        elapsed = min(elapsed, _LONGEST_STEP)
        motion = self._camera_motion(frame)
        self._carry(motion, elapsed)
        if self._path is None:
            return self._follow(frame, elapsed)
        return self._search(frame, self._path, elapsed)

    def _camera_motion(self, frame: Frame) -> CameraMotion:
        if not self.parameters.motion.camera:
            return CameraMotion()
        return self._flow.measure(frame, self._box(self._place))

    def _carry(self, motion: CameraMotion, elapsed: float) -> None:
        """Take everything that is known along with the background."""
        self._history.age(elapsed, motion)
        if motion.still:
            return
        self._swarm = self._swarm.carried(motion)
        self._place = carried(self._place, motion)
        self._scale *= motion.scale
        self._candidates.carry(motion)
        if self._path is not None:
            self._path = self._path.moved(motion.shift, motion.scale)

    # ---- in sight

    def _follow(self, frame: Frame, elapsed: float) -> Outcome:
        swarm, left_image = self._predicted(frame, elapsed)
        view = self._look_around(frame, swarm)
        swarm, sound, passes, redrawn = self._weighed(frame, view, swarm, elapsed)
        place, scale = swarm.place, swarm.scale
        likeness = self._appearance.compare(view, place, scale)
        verdict = self._conviction.judge(
            likeness, place, scale, self._history, self._side, self.parameters.evidence,
            gate=self.parameters.hiding.gate,
        )  # fmt: skip
        if not verdict.holds:
            return self._search(frame, self._lose_sight(), 0.0)
        self._swarm, self._place, self._scale = swarm, place, scale
        self._velocity = swarm.velocity
        self._learn_from(view, likeness, verdict)
        share = self._conviction.levels.share(likeness.evidence)
        return Outcome(
            swarm.cloud(sound=sound), place, self._velocity, "seen", share, _told(likeness),
            passes, redrawn, left_image,
        )  # fmt: skip

    def _predicted(self, frame: Frame, elapsed: float) -> tuple[Swarm, bool]:
        """Drive all particles on; in doubt they keep closer to their motion."""
        settings, young = self.parameters.motion, 1.0 + 3.0 / (1.0 + self._frames) ** 1.5
        calm = 0.5 if self._conviction.doubted else 1.0
        spread = Spread(
            calm * young * settings.sigma * self._side * self._scale,
            0.6 * calm * settings.scale_sigma if self._conviction.doubted else settings.scale_sigma,
            max(settings.gain * calm, 1.0 / (1.0 + self._frames)),
        )
        self._frames += 1
        swarm = self._swarm.resampled(self._rng, len(self._swarm.weights))
        moved = swarm.moved(self._rng, elapsed, spread)
        left_image = is_outside(frame, *moved.positions.mean(axis=0).tolist())
        return self._kept(frame, moved), left_image

    def _kept(self, frame: Frame, swarm: Swarm) -> Swarm:
        """Keep positions in the image, and sizes between a few px and the image's."""
        scales = np.clip(swarm.scales, *self._scale_bounds(frame))
        if not self.parameters.motion.scale:
            scales = np.ones_like(scales)
        return replace(swarm, positions=keep_inside(frame, swarm.positions), scales=scales)

    def _scale_bounds(self, frame: Frame) -> tuple[float, float]:
        longer = max(self._size)
        return min(_LEAST_SIDE / longer, 1.0), max(2.0 * max(frame_size(frame)) / longer, 1.0)

    def _look_around(self, frame: Frame, swarm: Swarm) -> View:
        scale = swarm.scale
        reach = 0.6 * self._size[0] * scale + 4.0, 0.6 * self._size[1] * scale + 4.0
        sizes = _SIZES if self.parameters.motion.scale else (1.0,)
        return self._appearance.look(frame, swarm.place, scale, reach, sizes)

    def _weighed(
        self, frame: Frame, view: View, swarm: Swarm, elapsed: float
    ) -> tuple[Swarm, bool, int, int]:
        """Weigh the particles; draw those of low weight anew while few carry all (P3)."""
        if self._frames <= 3:
            swarm = self._with_peak(frame, view, swarm, elapsed)
        motion = self.parameters.motion
        spread = Spread(motion.sigma * self._side * self._scale, motion.scale_sigma, motion.gain)
        passes = redrawn = 0
        swarm, sound = self._weigh(view, swarm)
        least = _DEGENERATE * len(swarm.weights)
        while (
            passes < self.parameters.resampling_passes
            and effective_sample_size(swarm.weights) < least
        ):
            kept = swarm.weights >= min(1.0 / len(swarm.weights), swarm.weights.max())
            drawn = swarm.jittered(self._rng, kept, elapsed, spread.times(0.4))
            swarm, sound = self._weigh(view, self._kept(frame, drawn))
            passes, redrawn = passes + 1, redrawn + int((~kept).sum())
        return swarm, sound, passes, redrawn

    def _weigh(self, view: View, swarm: Swarm) -> tuple[Swarm, bool]:
        fused = view.fused(swarm.positions, swarm.scales)
        weights, sound = from_log(self.parameters.sharpness * fused)
        return replace(swarm, weights=weights), sound

    def _with_peak(self, frame: Frame, view: View, swarm: Swarm, elapsed: float) -> Swarm:
        """Put half of the particles where the image is most alike: the speed is not known yet."""
        far = 1e3 * self._side * self._scale
        peak = view.peaks(1, swarm.place, far, 1.0)[0]
        half = len(swarm.weights) // 2
        positions, velocities = swarm.positions.copy(), swarm.velocities.copy()
        jumps = np.asarray(peak.place) - positions[:half]
        positions[:half] += jumps + sample_normal(self._rng, half, 0.02 * self._side * self._scale)
        velocities[:half] += jumps / max(elapsed, 0.5) / (1.0 + self._frames) * 2
        return self._kept(frame, replace(swarm, positions=positions, velocities=velocities))

    def _learn_from(self, view: View, likeness: Likeness, verdict: Verdict) -> None:
        if verdict.sure:
            self._history.see(self._place, self._scale)
        if not verdict.learns:
            return
        cues = self.parameters.cues
        if verdict.fluent:
            self._history.forget_all_but(_SIGHTINGS_IN_TURNS)
            self._appearance.learn(view, self._place, self._scale, _RATE_IN_TURNS, 0)
        else:
            self._conviction.levels.follow(likeness, self.parameters.evidence.level_rate)
            self._appearance.learn(view, self._place, self._scale, cues.template_rate, cues.delay)
        self._appearance.weigh_cues(view, self._place, self._scale)

    # ---- hidden

    def _lose_sight(self) -> ProjectiveMotion:
        """Go back to the confident frames, and foretell the motion from them."""
        hiding = self.parameters.hiding
        path, self._hidden_for = self._history.fit(
            self._side, retrospect=hiding.retrospect, projective=hiding.projective
        )
        self._candidates = Candidates()
        self._appearance.forget_pending()
        self._conviction.doubted = 0
        self._path = path
        count = self.parameters.num_particles
        place, scale = path.at(self._hidden_for)
        self._swarm = Swarm.around(
            self._rng, count, place, path.velocity, scale, self._side * scale
        )
        return path

    def _search(self, frame: Frame, path: ProjectiveMotion, elapsed: float) -> Outcome:
        self._hidden_for += elapsed
        place, scale = path.at(self._hidden_for)
        velocity = path.velocity_at(self._hidden_for)
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        low, high = self._scale_bounds(frame)
        self._scale = min(max(scale, low), high) if self.parameters.motion.scale else 1.0
        self._place, self._velocity = (x, y), velocity
        self._drift(frame, velocity, elapsed)
        uncertainty = 0.3 * self._side * self._scale + 1.0 + 0.5 * self._swarm.width
        found = self._find(frame, uncertainty)
        followed = self._candidates.follow(found, velocity, elapsed, self._side * self._scale)
        evidence, hiding = self.parameters.evidence, self.parameters.hiding
        least = max(evidence.clear_above, evidence.minimum)
        certain = [
            one for one in followed if one.is_certain((x, y), uncertainty, hiding.confirm, least)
        ]
        if certain:
            return self._come_back(frame, max(certain, key=lambda one: one.share))
        share = max((one.share for one in followed), default=0.0)
        ceiling = 0.99 * evidence.occluded_below * self._judge.level
        left_image = is_outside(frame, *place)
        return Outcome(
            self._swarm.cloud(), (x, y), velocity, "hidden", min(share, ceiling), {},
            left_image=left_image,
        )  # fmt: skip

    def _drift(self, frame: Frame, velocity: Place, elapsed: float) -> None:
        """Move hidden particles along the motion (P1 eq. 11), or evenly around it."""
        count, speed = len(self._swarm.weights), math.hypot(*velocity)
        across = 0.03 * self._side * self._scale * math.sqrt(elapsed)
        if self.parameters.hiding.drift:
            along = speed * elapsed / RAYLEIGH_MEAN
            moves = sample_normal_rayleigh(self._rng, count, velocity, along, across)
        else:
            moves = np.asarray(velocity) * elapsed + sample_normal(self._rng, count, across)
        self._swarm = replace(
            self._swarm,
            positions=keep_inside(frame, self._swarm.positions + moves),
            velocities=np.tile(velocity, (count, 1)),
            scales=np.full(count, self._scale),
        )

    def _find(self, frame: Frame, uncertainty: float) -> list[Candidate]:
        """Places that look like the target, by a dense search around the foretold place."""
        reach = 4.0 * uncertainty if self.parameters.hiding.search else 0.5 * uncertainty
        sizes = _SIZES_OF_SEARCH if self.parameters.motion.scale else (1.0,)
        limit = max(frame_size(frame))
        within = min(reach, limit), min(reach, limit)
        look = self._appearance
        view = look.look(frame, self._place, self._scale, within, sizes)
        levels, evidence = self._conviction.levels, self.parameters.evidence
        found = []
        for peak in view.peaks(4, self._place, reach, 0.4 * look.inner_side):
            likeness = look.compare(view, peak.place, peak.scale)
            share = levels.share(likeness.template)
            if likeness.whole >= 0.75 * levels.whole and share >= 0.9 * evidence.clear_above:
                found.append(Candidate(peak.place, peak.place, peak.scale, share))
        return found

    def _come_back(self, frame: Frame, found: Candidate) -> Outcome:
        """Follow a candidate from now on."""
        x, y = keep_inside(frame, np.asarray(found.place)).tolist()
        measured = found.velocity or self._velocity
        velocity = (
            0.5 * (self._velocity[0] + measured[0]),
            0.5 * (self._velocity[1] + measured[1]),
        )
        self._place, self._scale, self._velocity = (x, y), found.scale, velocity
        self._begin((x, y), found.scale, velocity)
        self._swarm = self._kept(frame, self._swarm)
        self._frames = 3
        return Outcome(self._swarm.cloud(), (x, y), velocity, "found", found.share, {})

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
        "part": likeness.part,
        "colour": likeness.colour,
    }

"""`fusion`: a particle filter that takes the best idea of each paper and adds what they lack.

While the target is seen: camera motion, constant velocity, fused cues on a canonical region,
adaptive resampling, judgement, learning. In doubt nothing is learnt, and the particles are held
to the motion that clear frames foretell. While it is hidden: that motion goes on, particles drift
along it, and a search widens with them. In a turn before a still camera its blob is followed.
docs/fusion.md tells what each part is for.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log
from vehicle_pf_tracker.image.window import is_outside, keep_inside
from vehicle_pf_tracker.trackers.base import Outcome
from vehicle_pf_tracker.trackers.fusion.appearance import Likeness
from vehicle_pf_tracker.trackers.fusion.candidates import Chain
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.history import History, Trend
from vehicle_pf_tracker.trackers.fusion.likelihood import Prior, log_likelihood
from vehicle_pf_tracker.trackers.fusion.particles import Particles, Spread
from vehicle_pf_tracker.trackers.fusion.search import Foretold, Search
from vehicle_pf_tracker.trackers.fusion.state import FusionState
from vehicle_pf_tracker.trackers.fusion.suspicion import Sight, Verdict
from vehicle_pf_tracker.trackers.fusion.view import View

_SIZES = tuple(1.07**step for step in (-1, 0, 1))
_LONGEST_STEP = 30.0
"""Frame periods that motion is extrapolated over in one step."""
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
_LOOKED_EVERY = 3
"""Clear frames between two looks at the target's blob."""
_SIGHTINGS_IN_TURNS = 6


class FusionTracker(FusionState):
    """The flagship."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        _ = self.target  # says what is wrong before the start
        elapsed = min(elapsed, _LONGEST_STEP)
        self._pass_time(frame, elapsed)
        if self._search is not None and self._trend is not None:
            return self._look_for(frame, self._trend, self._search, elapsed)
        turned = self._turn(frame, elapsed) if self._turns.active else None
        return turned or self._follow(frame, elapsed)

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
        if self._begins_to_turn(frame, verdict):
            return self._turned(frame)
        told = self._place
        hidden = verdict.hidden and not self._turns.undecided
        if hidden:
            self._lose_sight(frame)
            told = self._place
        elif verdict.gone and self._trend is not None:
            told = self._inside(frame, self._trend.now()[0])
        return Outcome(
            self._particles.cloud(sound=sound), told, self._velocity,
            "hidden" if hidden else "seen", self._evidence(likeness, verdict),
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

    def _look_around(self, frame: Frame, place: Position, scale: float) -> View:
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
    ) -> tuple[Position, float]:
        """Climb from the particles' mean to the peak, and align there while nothing is in doubt."""
        scale = particles.scale
        place = view.refine(particles.place, scale)
        if not self.parameters.cues.alignment or self._suspicion.frames:
            return place, scale
        place, scale = self._alignment.improve(self._appearance, view, place, scale, expected_scale)
        low, high = self._scale_bounds(frame)
        return place, min(max(scale, low), high)

    def _take(
        self, frame: Frame, particles: Particles, place: Position, scale: float, elapsed: float
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
        sight = Sight(
            likeness,
            off / self._extent,
            lambda: self._appearance.best_half(view, self._place, self._scale),
            background,
            self._appearance.grey,
        )
        return self._suspicion.judge(sight, gate=hiding.gate, patience=hiding.patience)

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

    # ---- in a turn

    def _begins_to_turn(self, frame: Frame, verdict: Verdict) -> bool:
        """Look now and then how the target's blob lies; in doubt, whether it leaves its path."""
        if not self.parameters.hiding.turns or (verdict.clear and self._frames % _LOOKED_EVERY):
            return False
        box = self._turns.notice(
            frame, self._box(self._place), self._appearance.mean_share, clear=verdict.clear
        )
        if box is not None:
            self._adopt(frame, box)
        return box is not None

    def _turn(self, frame: Frame, elapsed: float) -> Outcome | None:
        """Follow the blob of a turning target; None where it is lost."""
        (x, y), (u, v) = self._place, self._velocity
        ahead = self._inside(frame, (x + u * elapsed, y + v * elapsed))
        box = self._turns.follow(frame, self._box(ahead), self._appearance.mean_share)
        if box is not None:
            self._adopt(frame, box)
            if elapsed > 0:
                moved = (self._place[0] - x) / elapsed, (self._place[1] - y) / elapsed
                self._velocity = 0.5 * (u + moved[0]), 0.5 * (v + moved[1])
            self._history.keep(_SIGHTINGS_IN_TURNS)
            self._history.see(self._place, 1.0)
        elif self._turns.active:
            self._place = ahead
        else:
            return None
        return self._turned(frame)

    def _turned(self, frame: Frame) -> Outcome:
        self._draw_around(frame, 0.05)
        evidence = max(self._judge.level, self.parameters.evidence.clear_above)
        cloud = self._particles.cloud()
        return Outcome(cloud, self._place, self._velocity, "turning", evidence, {})

    def _emerges(self, frame: Frame, trend: Trend, elapsed: float) -> bool:
        """Look whether the hidden target comes out of a turn, off its foretold path."""
        if self._emergence is None or not self.parameters.hiding.turns:
            return False
        colour = self._appearance.mean_share
        emerged = self._emergence.look(frame, trend, elapsed, colour)
        if emerged is None:
            return False
        self._turns.begin(emerged.blob.area)
        self._adopt(frame, self._turns.box_of(emerged.blob))
        self._velocity = emerged.velocity
        self._history = History(self._side)
        return True

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
        self._foretell(frame, self._trend)
        self._draw_around(frame, 0.1)
        self._emergence = Emergence(self._turns, self._extent)

    def _foretell(self, frame: Frame, trend: Trend) -> bool:
        """Move on to the foretold state; tells whether its place is in the image."""
        place, scale = trend.now()
        low, high = self._scale_bounds(frame)
        self._scale = min(max(scale, low), high)
        self._velocity = trend.velocity()
        x, y = keep_inside(frame, np.asarray(place)).tolist()
        self._place = x, y
        return not is_outside(frame, *place)

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
        if self._emerges(frame, trend, elapsed):
            return self._turned(frame)
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
        self._draw_around(frame, 0.05)
        for one in chain.links:
            self._history.see(one.place, one.scale, one.age)
        self._search = self._emergence = self._trend = None
        self._suspicion.reset()
        cloud = self._particles.cloud()
        return Outcome(cloud, self._place, self._velocity, "found", 1.0, {})


def _told(likeness: Likeness) -> dict[str, float]:
    return {
        "anchor": likeness.anchor,
        "following": likeness.following,
        "colour": likeness.colour,
    }

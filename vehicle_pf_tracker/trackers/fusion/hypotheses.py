# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The particles: position, velocity, growth and visibility of the vehicle, and their weights.

`filtering` gives the Normal density of their noise, the normalisation of their weights, and
systematic resampling.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.filtering.resampling import systematic
from vehicle_pf_tracker.filtering.weights import effective_sample_size, normalise
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.perspective import FASTEST_GROWTH, PerspectiveMotion

LARGEST_GROWTH = 3.0
"""Bound of the growth in one occlusion, of all or a part of it: the vehicles of real sequences that
drive towards a fixed camera grow fivefold from where they are first seen to where they leave the
image."""
HIDDEN_SCALES = (1.0, 1.2, 1 / 1.2)
"""Sizes that a hidden vehicle is searched at, relative to the predicted one: behind painted walls
that is a fifth too low in the median when the vehicle comes out, as the wall has cut the last
sightings."""
_DEGENERATE = 0.5
"""Share of the particles below which the effective sample size asks for resampling: the usual half,
a choice between few distinct hypotheses and the noise of drawing them in every frame."""
PRIOR_DOUBT = 0.02
"""Probability of the other state, where a vehicle is declared visible or hidden: log odds -3.9, and
by the returns of the chain -2.6 a frame later. Then one frame of the usual response, log ratio 6,
makes it visible if one of thirty hypotheses is in place; of .8 of it (3.6), if two of five are."""
_FRAMES_BEFORE = 2.0
"""Frames over which the velocity may have changed already when an occlusion begins: the vehicle is
judged hidden a frame or two after the last clear sighting."""
_PREDICTION_SIGMA = 0.04, 0.01
"""Spread in sizes of the positions predicted from the last clear sighting, at once and per frame
since: about the residual of the fit to sightings of real vehicles."""
ACROSS_LANES = 0.3
"""Noise of a hidden vehicle's velocity across its heading, of that along it: it brakes more than it
leaves its lane. Equal noise covers the next lane within 30 frames, and its cars are taken for the
target (scenes `bus`, `bridge` and `braking`, seeds 100 to 104)."""
_SPEED_SIGMA = 0.05
"""Spread of the predicted velocities, of the speed; about the error of the fit."""
_GROWTH_SIGMA = 0.004
"""Spread of the predicted rates of growth per frame; a step of the fit's grid is 0.0025."""
HIDING = 0.02
"""Probability per frame that a visible vehicle is hidden: an occlusion begins every 50 frames, a
choice, as in traffic vehicles are visible for most of the time."""
RETURN = 0.05
"""Probability per frame that a hidden vehicle is visible: an occlusion lasts 20 frames in the mean
(13 of the ten total ones in 27 sequences)."""


def chain(elapsed: float) -> tuple[float, float]:
    """Probabilities of being visible after `elapsed` frames, of a visible and of a hidden one."""
    return (1 - HIDING) ** elapsed, 1 - (1 - RETURN) ** elapsed


class Hypotheses(NamedTuple):
    """A weighted set of hypotheses.

    The visibility of each is a Markov chain, {visible, hidden}, that is summed out
    (Rao-Blackwell): a hypothesis gains weight by evidence only in so far as it says "visible".

    Attributes
    ----------
    positions : (N, 2) array
        Centres, px.
    velocities : (N, 2) array
        Velocities, px per frame.
    growths : (N,) array
        Change of the logarithm of the size per frame.
    visible : (N,) array
        Probability that the vehicle is visible, given that this hypothesis is right.
    weights : (N,) array
        Weights, whose sum is 1.
    """

    positions: Array
    velocities: Array
    growths: Array
    visible: Array
    weights: Array

    @classmethod
    def around(
        cls, positions: Array, velocities: Array, growths: Array, visible: float
    ) -> Hypotheses:
        """Make hypotheses of equal weights."""
        equal = np.full(len(positions), 1 / len(positions))
        count = len(positions)
        return cls(positions, velocities, growths, np.full(count, visible), equal)

    @property
    def probability_visible(self) -> float:
        """Posterior probability that the vehicle is visible."""
        return float(self.weights @ self.visible)

    @property
    def mean(self) -> Array:
        """Mean position, px."""
        return np.asarray(self.weights @ self.positions)

    @property
    def mean_velocity(self) -> Array:
        """Mean velocity, px per frame."""
        return np.asarray(self.weights @ self.velocities)

    @property
    def spread(self) -> float:
        """Standard deviation of the positions along the axis where it is larger, px."""
        variance = self.weights @ (self.positions - self.mean) ** 2
        return float(np.sqrt(variance.max()))

    def moved(self, camera: CameraMotion) -> Hypotheses:
        """Move positions and velocities with the background."""
        velocities = camera.apply_to_velocities(self.velocities)
        return self._replace(positions=camera.apply(self.positions), velocities=velocities)

    def predicted(
        self,
        rng: np.random.Generator,
        elapsed: float,
        sigmas: tuple[float, float],
        across: float,
        *,
        keeps_mean: bool = False,
    ) -> Hypotheses:
        """Move on for `elapsed` frames at constant velocity on the road.

        In the image the velocity of a vehicle whose size grows at rate r grows at 2 r, and r at r
        (`perspective.PerspectiveMotion`, differentiated).

        Parameters
        ----------
        sigmas : (float, float)
            Standard deviations of position (px) and velocity (px per frame), per frame.
        across : float
            Share of the velocity's noise across the heading.
        keeps_mean : bool
            The noise leaves their mean velocity as it is.
        """
        # Changes of independent frames add in variance.
        root = math.sqrt(elapsed)
        count = len(self.positions)
        growths = self.growths
        velocities = self.velocities
        # None grows before the first occlusion; then there is nothing to compute.
        if growths.any():
            # From p' = V / (1 - r t)^2 and the growth g = r / (1 - r t): p'' = 2 g p', g' = g^2.
            velocities = velocities * np.exp(2 * growths * elapsed)[:, np.newaxis]
            growths = growths * (1 + growths * elapsed)
            # g' = g^2 reaches infinity in finite time: a vehicle would fill the image behind a
            # wall.
            growths = np.minimum(np.maximum(growths, -FASTEST_GROWTH), FASTEST_GROWTH)
        noise = sample_normal(rng, count, 1.0)
        # Of so few draws the mean alone would be off by a tenth of the size after 40 frames.
        if keeps_mean:
            noise -= noise.mean(axis=0)
        if across != 1.0:
            # One common heading: where the vehicle stands, those of single ones would be noise.
            noise = along_heading(noise, self.mean_velocity, across)
        velocities = velocities + noise * (sigmas[1] * root)
        positions = self.positions + velocities * elapsed
        positions += sample_normal(rng, count, sigmas[0] * root)
        return self._replace(positions=positions, velocities=velocities, growths=growths)

    def held(self, place: Array, share: float) -> Hypotheses:
        """Move all by a share of the way of their mean to a place (2,), px."""
        return self._replace(positions=self.positions + share * (place - self.mean))

    def passed(self, elapsed: float) -> Hypotheses:
        """Let the chain of visibility pass `elapsed` frames."""
        # One step of a two-state Markov chain: what stays visible, and what returns.
        stays, returns = chain(elapsed)
        return self._replace(visible=self.visible * stays + (1 - self.visible) * returns)

    def all_visible(self, probability: float) -> Hypotheses:
        """Take the vehicle to be visible with one probability; 0 for one that has left."""
        return self._replace(visible=np.full(len(self.visible), probability))

    def evidence(self, log_ratios: Array) -> float:
        """Likelihood ratio, of this set against a hidden vehicle, of what gave these log ratios."""
        # A hypothesis that says "visible" with probability v has the ratio v L + (1 - v), which is
        # 1 + v (L - 1): in this form the sum stays exact where L is close to 1.
        return float(self.weights @ (self.visible * np.expm1(log_ratios))) + 1

    def weighed(self, log_ratios: Array) -> Hypotheses:
        """Weigh by log-likelihood ratios (N,) of visible against hidden (Bayes' rule)."""
        # The likelihood of a hidden vehicle is 1, as all are ratios to it: what says "hidden"
        # neither gains nor loses by what is seen at its position.
        seen = self.visible * np.exp(log_ratios)
        total = seen + (1 - self.visible)  # in this order never below `seen`
        weights, _ = normalise(self.weights * total)
        return self._replace(visible=seen / total, weights=weights)

    def climbed(self, positions: Array, log_ratios: Array, *, keeps_mean: bool) -> Hypotheses:
        """Move to positions (N, 2), px, weighed by their log ratios (N,); see `weighed`.

        With `keeps_mean` they gather around their mean, which moves only as far as the vehicle is
        likely visible.
        """
        particles = self._replace(positions=positions).weighed(log_ratios)
        if not keeps_mean:
            return particles
        drift = self.weights @ (positions - self.positions)
        back = (1 - particles.probability_visible) * drift
        return particles._replace(positions=positions - back)

    def weighed_alike(self, log_ratio: float) -> Hypotheses:
        """Take evidence on visibility that is the same for all hypotheses; weights stay."""
        # By Bayes' rule those that are likelier visible would gain weight, too. But flow is
        # measured at one position, and does not show which of them is right.
        seen = self.visible * np.exp(log_ratio)
        return self._replace(visible=seen / (seen + (1 - self.visible)))

    def resampled(self, rng: np.random.Generator, count: int) -> Hypotheses:
        """Draw `count` hypotheses by weight, where few carry most of it or their number differs."""
        enough = effective_sample_size(self.weights) >= _DEGENERATE * len(self.weights)
        if enough and count == len(self.weights):
            return self
        # Systematic: the least variance of the counts, and one random number a frame.
        chosen = systematic(self.weights, count, rng)
        drawn = Hypotheses(*(values.take(chosen, axis=0) for values in self))
        return drawn._replace(weights=np.full(count, 1 / count))


def along_heading(noise: Array, heading: Array, across: float) -> Array:
    """Shrink the part of `noise` (N, 2) that is across the heading (2,) to the share `across`."""
    speed = math.hypot(*heading.tolist())
    if not speed:
        return noise
    # The part along the heading is a projection; what is left is across.
    unit = heading / speed
    along = (noise @ unit)[:, np.newaxis] * unit
    return np.asarray(along + across * (noise - along))


def corrected_velocities(velocities: Array, moved: Array, elapsed: float, gain: float) -> Array:
    """Let velocities (..., 2), px per frame, take on a displacement (2,), px, by a gain.

    Within less than a period they take on what was not predicted, and no speed is divided by a time
    that may be none: stamps repeat, and jitter.

    Parameters
    ----------
    elapsed : float
        Periods that the displacement took.
    gain : float
        Share of the error that is taken on within a period or more.
    """
    # Two images of one stamp, of a camera that moves on: at the second the velocity takes on the
    # displacement, and at the next one gives back what it has moved too little.
    error = moved / max(elapsed, 1.0) - velocities * min(elapsed, 1.0)
    return np.asarray(velocities + gain * error)


def hidden_hypotheses(
    rng: np.random.Generator,
    motion: PerspectiveMotion,
    age: float,
    count: int,
    extent: float,
    velocity_sigma: float,
) -> Hypotheses:
    """Draw hypotheses about a vehicle that has just been hidden.

    Parameters
    ----------
    motion : PerspectiveMotion
        Fitted to clear sightings, the last of which is at time 0.
    age : float
        Frames since that one.
    count : int
        Number N of hypotheses.
    extent : float
        Geometric mean of the vehicle's sides, px.
    velocity_sigma : float
        Standard deviation of the velocity's change while hidden, sizes per frame squared.
    """
    # 1. Positions: the fitted path, with an error that grows since the last clear sighting.
    velocity = motion.velocity_at(age)
    draws = rng.normal(size=(2, count, 2))
    spread = (_PREDICTION_SIGMA[0] + _PREDICTION_SIGMA[1] * age) * extent
    positions = motion.position_at(age) + draws[0] * spread
    # 2. Velocities: it may have braked as it was hidden, in proportion to its size; and the fit
    # errs in proportion to the speed. Both may hold at once, so that they add.
    speed_sigma = _FRAMES_BEFORE * velocity_sigma * extent
    speed_sigma += _SPEED_SIGMA * float(np.hypot(*velocity))
    # 3. Growth: none where none was fitted, since noise alone would let it grow in each occlusion.
    growths = np.zeros(count)
    if motion.rate:
        growths = motion.growth_at(age) + rng.normal(size=count) * _GROWTH_SIGMA
    growths = np.clip(growths, -FASTEST_GROWTH, FASTEST_GROWTH)
    # 4. Across the heading there is less noise than along it.
    velocities = velocity + along_heading(draws[1], velocity, ACROSS_LANES) * speed_sigma
    return Hypotheses.around(positions, velocities, growths, PRIOR_DOUBT)

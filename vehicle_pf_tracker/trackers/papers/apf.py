# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`apf`: the adaptive particle filter of Scharcanski et al. 2011 (P1, Algorithms 1 and 2).

In the regular regime particles are resampled and propagated with a Normal density; while the
histogram at the estimate differs from the first or the last one, they drift with a Normal-Rayleigh
density along the mean motion instead. Step numbers are those of Algorithm 1. Speeds and spreads
are per nominal frame period, so that all of them scale with the elapsed time.

`occlusion.rule: fixed` is the paper's step 4. `relative` is an extension of ours, with a level
test, an alpha and a delay of its own; parameters that only it has name it as their source.

Symbols of the paper: the particles s and weights pi are a `Cloud`, the estimate S is `position`,
and V the mean velocity. Of the histograms Phi*_t is `histogram`, Phi_t `blended`, Phi_(t-1)
`reference`, and Phi_0 `first_histogram`; d_B is the Hellinger distance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import RAYLEIGH_MEAN, sample_normal, sample_normal_rayleigh
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.image.windows.colour import JointColour
from vehicle_pf_tracker.image.windows.similarity import Histogram, Reference, hellinger_similarity
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.papers import shared
from vehicle_pf_tracker.trackers.papers.clear_level import (
    RELATIVE_RULE,
    ClearLevel,
    ClearLevelParameters,
)
from vehicle_pf_tracker.trackers.parameters import ParticleParameters, share


@dataclass(frozen=True, slots=True)
class ApfMotionParameters:
    """Propagation of particles in the two regimes."""

    sigma_w: float = parameter(
        6.0, "About the vehicle's speed: less loses fast vehicles, more follows similar vehicles.",
        bounds=(0.01, 1000.0), unit="px/frame", source="P1 eq. 7, interpretation 11", tuned=True,
    )  # fmt: skip
    sigma_n: float = parameter(
        0.0, "Larger: occluded particles spread further across the motion; 0 takes sigma_w.",
        bounds=(0.0, 1000.0), unit="px/frame", source="P1 eq. 10",
    )  # fmt: skip
    sigma_r: float = parameter(
        0.0, "Larger: occluded particles drift faster along the motion; 0 takes sigma_w. "
        "Counts with drift_from_velocity off.",
        bounds=(0.0, 1000.0), unit="px/frame", source="P1 eq. 9",
    )  # fmt: skip
    drift_from_velocity: bool = parameter(
        True,
        "Drift at the vehicle's own mean speed, sigma_R = |V| / sqrt(pi / 2); off takes sigma_r.",
        source="P1 eq. 20, interpretation 11",
    )


@dataclass(frozen=True, slots=True)
class ApfReferenceParameters:
    """Adaptation of the reference histogram to the vehicle."""

    alpha: float = share(
        0.01, "Higher: the reference follows changes of appearance faster. Counts with the fixed "
        "occlusion rule.",
        source="P1 Algorithm 1 step 15 (no value printed)",
    )  # fmt: skip
    steady_alpha: float = share(
        0.01,
        "Higher: as alpha, with the relative occlusion rule, which is regular in more frames.",
        source=RELATIVE_RULE,
    )
    steady_above: float = parameter(
        0.95,
        "Higher: with the relative rule, the reference follows in fewer and better frames only.",
        bounds=(0.0, 2.0), unit="of Pi's clear level", source=RELATIVE_RULE,
    )  # fmt: skip
    frozen_while_occluded: bool = parameter(
        True,
        "Keep the reference while occluded; off lets it learn the occluder, as printed. Counts "
        "with the fixed occlusion rule.",
        source="P1 Algorithm 1 step 15, interpretation 6",
    )


@dataclass(frozen=True, slots=True)
class ApfOcclusionParameters:
    """Conditions of the occlusion regime."""

    rule: str = parameter(
        "relative",
        "fixed compares the similarities with tau, as the paper does, which takes most of a real "
        "video for an occlusion; relative, our extension, with their own clear level.",
        choices=("fixed", "relative"), source="P1 Algorithm 1 step 4, interpretation 27",
    )  # fmt: skip
    tau: float = share(
        0.8,
        "Higher: smaller changes of the histogram switch to the occlusion regime. Counts with the "
        "fixed rule.",
        source="P1 Algorithm 1 step 4, interpretation 8",
    )
    raw_histogram: bool = parameter(
        True, "Judge the window's own histogram; off judges the blended reference, as printed.",
        source="P1 Algorithm 1 step 16, interpretation 7",
    )  # fmt: skip
    level: ClearLevelParameters = group(ClearLevelParameters)


@dataclass(frozen=True, slots=True)
class ApfVelocityParameters:
    """Mean velocity that gives the direction of the drift."""

    window: int = parameter(
        16, "Longer: a steadier direction that follows turns later; 0 takes all estimates.",
        bounds=(0, 10_000), unit="frames", source="P1 section III-B, interpretation 5", tuned=True,
    )  # fmt: skip
    delay: int = parameter(
        12,
        "Longer: more of the estimates that an occlusion drags along before it is noticed are kept "
        "out of the drift. Counts with the relative rule, which notices later.",
        bounds=(0, 1000), unit="frames", source=RELATIVE_RULE,
    )  # fmt: skip
    from_origin: bool = parameter(
        False, "Count the first displacement from (0, 0), as printed.",
        source="P1 section III-B, interpretation 5",
    )  # fmt: skip
    frozen_while_occluded: bool = parameter(
        True, "Leave estimates of the occlusion regime out of the mean.", source="interpretation 5",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class ApfParameters(ParticleParameters):
    """Parameters of `apf`."""

    as_printed: bool = shared.as_printed_switch(source="interpretations 1, 5, 6, 7, 11 and 27")
    histogram_bits: int = shared.histogram_bits_parameter()
    resampling: str = shared.resampling_parameter(source="P1 Algorithm 2")
    motion: ApfMotionParameters = group(ApfMotionParameters)
    likelihood: shared.LikelihoodParameters = group(shared.LikelihoodParameters)
    reference: ApfReferenceParameters = group(ApfReferenceParameters)
    occlusion: ApfOcclusionParameters = group(ApfOcclusionParameters)
    velocity: ApfVelocityParameters = group(ApfVelocityParameters)

    @property
    def drift_delay(self) -> int:
        """Newest displacements that the drift leaves out, in frames."""
        return self.velocity.delay if self.occlusion.rule == "relative" else 0

    def printed(self) -> ApfParameters:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(
            self,
            histogram_bits=3,
            resampling="multinomial",
            likelihood=shared.LikelihoodParameters(sigma_v=1.5, squared_distance=False),
            motion=replace(self.motion, sigma_n=0.0, sigma_r=0.0, drift_from_velocity=False),
            reference=replace(self.reference, frozen_while_occluded=False),
            occlusion=replace(self.occlusion, rule="fixed", tau=0.8, raw_histogram=False),
            velocity=ApfVelocityParameters(
                window=0, delay=0, from_origin=True, frozen_while_occluded=False
            ),
        )


class ApfTracker(ParticleTracker[ApfParameters]):
    """Algorithm 1 of P1."""

    def __init__(self, parameters: ApfParameters) -> None:
        super().__init__(parameters)
        self.first_histogram: Histogram = np.zeros(0)
        """Histogram of the target in the first frame."""
        self.reference = Reference(np.zeros(0))
        """Histogram that particles are compared with; it follows the vehicle (step 15)."""
        self._velocity = shared.MeanVelocity(0)
        """Mean velocity of the estimates, along which occluded particles drift."""
        self._position = (0.0, 0.0)
        """Estimate of the frame before, px."""
        self._pi = self._pi_up = 1.0
        """Similarities Pi and Pi_up to the first and the last reference (step 16), 0 to 1."""
        self._levels = ClearLevel(), ClearLevel()
        """Clear levels of Pi and Pi_up, for the relative rule."""

    def reconfigure(self, parameters: ApfParameters) -> None:
        """Take new parameters; a new velocity window applies to the same history."""
        before = self._settings
        settings = parameters.effective()
        self._velocity = self._velocity.resized(settings.velocity.window, settings.drift_delay)
        if before.occlusion.raw_histogram != settings.occlusion.raw_histogram:
            # Blended histograms are the more similar ones: no raw one would reach their level.
            self._levels = ClearLevel(), ClearLevel()
        super().reconfigure(parameters)

    def _learn(self) -> None:
        bits = self._settings.histogram_bits
        if self._is_clear(self._settings):  # else the new levels would be those of the occluder
            self._levels = ClearLevel(), ClearLevel()
        self.first_histogram = self.target.joint_histogram(self.window, bits)
        self.reference = Reference(self.first_histogram)

    def _scatter(self, centre: tuple[float, float]) -> Array:
        settings = self._settings
        self._pi = self._pi_up = 1.0  # step 2
        self._levels = ClearLevel(), ClearLevel()
        self._velocity = shared.MeanVelocity(settings.velocity.window, settings.drift_delay)
        self._position = (0.0, 0.0) if settings.velocity.from_origin else centre
        # Step 1. Its Sigma is not printed; that of equation 7 stands for it (interpretation 37).
        moves = sample_normal(self._rng, settings.num_particles, settings.motion.sigma_w)
        return np.asarray(centre) + moves

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame by steps 4 to 16: resample or drift, weigh, estimate, compare, learn."""
        settings = self._settings
        bits = settings.histogram_bits
        window = self.window
        regular = self._is_clear(settings)  # step 4
        if regular:
            # Nothing is known of where the vehicle turns, so the density is symmetric (eq. 7).
            ancestors = self._draw(self._cloud.weights, settings.resampling)
            # Steps 5 and 6 (Algorithm 2).
            parents = self._cloud.positions.take(ancestors, axis=0)
            moves = sample_normal(
                self._rng, len(parents), settings.motion.sigma_w * elapsed
            )  # step 7
        else:
            # No resampling: by the cover's colour it would gather the particles where they are.
            parents = self._cloud.positions
            moves = self._drift(settings, len(parents), elapsed)  # step 9
        particles, left_image = self._move(frame, parents, moves)
        feature = JointColour(bits)
        rho = self.kernels.similarity(feature, frame, particles, window, self.reference)
        # Weights of this frame alone, in both regimes: no recursion is printed (interpretation 10).
        weights = from_log(shared.log_likelihood(rho, settings.likelihood))  # steps 11 and 12
        cloud = Cloud(particles, *weights)
        position = cloud.mean()  # step 13
        histogram = self.kernels.histogram(feature, frame, position, window)  # step 14
        evidence = hellinger_similarity(histogram, self.reference.histogram)
        self._compare_and_learn(settings, histogram, evidence)  # steps 15 and 16
        # Estimates under a cover drift with this very mean: they would only confirm it.
        if regular or not settings.velocity.frozen_while_occluded:
            self._velocity.add(self._position, position, elapsed)
        self._position = position
        return Outcome(
            cloud,
            position,
            self._velocity.value,
            "regular" if regular else "occlusion",
            evidence,
            {"pi": self._pi, "pi_up": self._pi_up},
            resampling_passes=int(regular),
            resampled_particles=len(particles) if regular else 0,
            left_image=left_image,
        )

    def _is_clear(self, settings: ApfParameters) -> bool:
        """Test for the regular regime: both similarities at their clear levels, or tau (step 4)."""
        if settings.occlusion.rule == "relative":
            return all(level.clear for level in self._levels)
        return min(self._pi, self._pi_up) >= settings.occlusion.tau

    def _drift(self, settings: ApfParameters, count: int, elapsed: float) -> Array:
        """Draw moves along the mean velocity (count, 2), px, by equations 11, 13 and 14."""
        motion = settings.motion
        velocity = self._velocity.settled
        if motion.drift_from_velocity:
            # The mean step is sqrt(pi / 2) sigma_R (eq. 20): so the cloud keeps the vehicle's pace.
            sigma_r = float(np.hypot(*velocity)) / RAYLEIGH_MEAN
        else:
            sigma_r = motion.sigma_r or motion.sigma_w
        # Section IV sets one sigma for all three densities.
        sigma_n = motion.sigma_n or motion.sigma_w
        return sample_normal_rayleigh(
            self._rng, count, velocity, sigma_r * elapsed, sigma_n * elapsed
        )

    def _compare_and_learn(
        self, settings: ApfParameters, histogram: Histogram, to_last: float
    ) -> None:
        """Update Pi, Pi_up and the reference (steps 15 and 16).

        `to_last` is the similarity of the histogram to the reference.
        """
        to_first = hellinger_similarity(histogram, self.first_histogram)
        alpha = self._follow_rate(settings, to_first)
        blended = alpha * histogram + (1 - alpha) * self.reference.histogram
        # The blend is nearly the reference itself, and lags behind a cover (interpretation 7).
        if settings.occlusion.raw_histogram:
            self._pi = to_first
            self._pi_up = to_last
        else:
            self._pi = hellinger_similarity(blended, self.first_histogram)
            self._pi_up = hellinger_similarity(blended, self.reference.histogram)
        self._update_levels(settings)
        # Last, as step 16 compares with the reference of the frame before.
        if self._is_clear(settings) or not settings.reference.frozen_while_occluded:
            self.reference = Reference(blended)

    def _follow_rate(self, settings: ApfParameters, to_first: float) -> float:
        """Return alpha of step 15; with the relative rule only good frames have one."""
        if settings.occlusion.rule == "fixed":
            return settings.reference.alpha
        # A vehicle that is half covered still counts as clear, and must not be learnt.
        good = settings.reference.steady_above * self._levels[0].value
        return settings.reference.steady_alpha * (to_first >= good)

    def _update_levels(self, settings: ApfParameters) -> None:
        """Judge Pi and Pi_up by their clear levels, which follow in frames where both are clear."""
        level = settings.occlusion.level
        similarities = self._pi, self._pi_up
        for running, similarity in zip(self._levels, similarities, strict=True):
            running.judge(similarity, level)
        # Both, since a fall of either says that the other is of a covered window too.
        if all(running.clear for running in self._levels):
            for running, similarity in zip(self._levels, similarities, strict=True):
                running.add(similarity, level.rate)

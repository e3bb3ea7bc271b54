# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`conventional` and `adaptive`: repeated resampling within a frame (P3, Khong et al.).

Particles are weighted, and while their effective sample size is too small they are replaced and
weighted again. `conventional` (Table I) replaces every particle by a jittered copy drawn from the
weighted ones. `adaptive` (Table II) replaces only the particles of low weight; under occlusion all
but the best one, by copies around it. Step numbers are those of the tables. Equation 6 has a
particle's previous weight as a factor, the tables have not (interpretation 28). As in the tables,
the next frame starts without it also where no pass has run: what was measured in such a frame
counts for its own estimate alone (interpretation 40).

Symbols of the paper: N_s is `num_particles` and N_eff the effective sample size; b_dist is the
Hellinger distance, phi_c the likelihood and w the weights of a `Cloud`; T_thres is
`occlusion.n_eff`, and the N_s of step 13 `criterion` times the number of particles.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log
from vehicle_pf_tracker.image.windows.similarity import hellinger_distance
from vehicle_pf_tracker.image.windows.window import keep_inside
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import (
    LikelihoodParameters,
    as_printed_switch,
    histogram_bits_parameter,
    log_likelihood,
    resampling_parameter,
    sigma_v_parameter,
    squared_distance_parameter,
)
from vehicle_pf_tracker.trackers.parameters import share

RepeatedParametersT = TypeVar("RepeatedParametersT", bound="RepeatedResamplingParameters")


@dataclass(frozen=True, slots=True)
class RepeatedLikelihoodParameters(LikelihoodParameters):
    """Decrease of the weights with the distance of the histograms, as P3 has it."""

    sigma_v: float = sigma_v_parameter(
        0.2, source="P3 eq. 10, interpretation 23 (no value printed)"
    )
    squared_distance: bool = squared_distance_parameter(source="P3 eq. 10 (printed squared)")


@dataclass(frozen=True, slots=True)
class RepeatedResamplingParameters(ColourParameters):
    """Parameters of both filters of P3."""

    as_printed: bool = as_printed_switch(source="interpretations 21, 22, 28, 29 and 40")
    histogram_bits: int = histogram_bits_parameter(source="P3 section III-B", tuned=True)
    resampling: str = resampling_parameter(source="P3 section IV-B (four are named)")
    sigma: float = parameter(
        14.0,
        "About 1.75 times the speed: less loses fast vehicles, more follows similar vehicles.",
        bounds=(0.01, 1000.0), unit="px/frame", source="P3 Table I step 5, interpretation 23",
        tuned=True,
    )  # fmt: skip
    jitter: float = parameter(
        0.5, "Larger: regenerated particles lie further from the ones they are copies of.",
        bounds=(0.0, 10.0), unit="share of sigma", source="P3 Table I step 16, interpretation 23",
        tuned=True,
    )  # fmt: skip
    criterion: float = share(
        0.7,
        "Higher: more passes a frame until the effective sample size is reached; 1, as printed, "
        "never is.",
        unit="share of the particles", source="P3 Table I step 13, interpretation 21", tuned=True,
    )  # fmt: skip
    most_passes: int = parameter(
        20, "Lower: a frame takes less time at most.", bounds=(0, 1000), unit="passes/frame",
        source="P3 section VI",
    )  # fmt: skip
    weighted_mean: bool = parameter(
        True, "Weigh particles in the estimate; off takes their plain mean, as printed.",
        source="P3 section V, interpretation 29",
    )  # fmt: skip
    weight_recursion: bool = parameter(
        False, "On: a particle's previous weight is a factor of its next, so that frames without "
        "a pass count too; off as in the tables.",
        source="P3 eq. 6, interpretations 28 and 40",
    )  # fmt: skip
    likelihood: RepeatedLikelihoodParameters = group(RepeatedLikelihoodParameters)

    def printed(self: RepeatedParametersT) -> RepeatedParametersT:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(
            self,
            histogram_bits=3,
            criterion=1.0,
            most_passes=20,
            weighted_mean=False,
            weight_recursion=False,
            likelihood=replace(self.likelihood, squared_distance=True),
        )


@dataclass(frozen=True, slots=True)
class WeighedParticles:
    """Particles with their similarities and weights.

    Attributes
    ----------
    coefficients : (N,) array
        Bhattacharyya coefficients with the reference.
    cloud : Cloud
        Positions in px with their normalised weights.
    """

    coefficients: Array
    cloud: Cloud


class Replacement(NamedTuple):
    """Choice of the particles that a pass of resampling replaces, and of how.

    Attributes
    ----------
    replaced : (N,) array of bool
        True for the particles to replace.
    parent_weights : (N,) array
        Weights by which their parents are drawn.
    jitter : float
        Spread of the copies around these, as a share of sigma.
    regime : str
        Branch of the algorithm that was taken.
    """

    replaced: npt.NDArray[np.bool_]
    parent_weights: Array
    jitter: float
    regime: str


class RepeatedResampling(ColourTracker[RepeatedParametersT]):
    """Tables I and II of P3 but for the pass of resampling."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame by the tables: propagate, weigh, resample while few particles count."""
        settings = self._settings
        # Every particle moves on: what was drawn within the last frame is its resampling.
        parents = self._cloud.positions
        moved, left_image = self._diffuse(frame, parents, settings.sigma * elapsed)  # steps 3 to 7
        prior = self._cloud.weights if settings.weight_recursion else None  # eq. 6
        particles = self.weigh(moved, self.similarity(frame, moved), prior)  # steps 8 to 11
        # The criterion may never be met, as by printed values: a frame's time has to have a bound.
        passes = 0
        replaced = 0
        regime = "regular"
        while passes < settings.most_passes and self._is_degenerate(particles):  # steps 12 and 13
            particles, count, regime = self.resample_once(frame, particles, elapsed)
            passes += 1
            replaced += count
        cloud = particles.cloud
        reported = cloud if settings.weighted_mean else Cloud.uniform(cloud.positions)
        outcome = self._report(frame, reported, elapsed, left_image=left_image)  # step 21
        best = float(1.0 - hellinger_distance(particles.coefficients.max()))
        return replace(
            outcome,
            cloud=cloud,
            regime=regime,
            similarities={**outcome.similarities, "best": best},
            resampling_passes=passes,
            resampled_particles=replaced,
        )

    def weigh(
        self, positions: Array, coefficients: Array, prior: Array | None = None
    ) -> WeighedParticles:
        """Weigh particles by their Bhattacharyya coefficients, and by `prior`; each (N,)."""
        logs = log_likelihood(coefficients, self._settings.likelihood)
        if prior is not None:
            logs = logs + np.log(np.maximum(prior, np.finfo(np.float64).tiny))
        return WeighedParticles(coefficients, Cloud(positions, *from_log(logs)))

    def _is_degenerate(self, particles: WeighedParticles) -> bool:
        """Test whether the effective sample size is below the criterion (step 13)."""
        limit = self._settings.criterion * len(particles.cloud.positions)
        return effective_sample_size(particles.cloud.weights) < limit

    def resample_once(
        self, frame: Frame, particles: WeighedParticles, elapsed: float
    ) -> tuple[WeighedParticles, int, str]:
        """Replace particles once; also returns their number, and the branch taken."""
        choice = self._choose(particles)
        count = int(choice.replaced.sum())
        if count == 0:
            return particles, 0, choice.regime
        # Jittered, as copies in one place would weigh the same again and end no degeneracy.
        draw = RESAMPLING_SCHEMES[self._settings.resampling]
        ancestors = draw(choice.parent_weights, count, self._rng)
        spread = choice.jitter * self._settings.sigma * elapsed
        parents = particles.cloud.positions.take(ancestors, axis=0)
        copies = keep_inside(frame, parents + sample_normal(self._rng, count, spread))
        rho = self.similarity(frame, copies)
        if count == len(choice.replaced):  # `conventional`: nothing of the old cloud is left
            return self.weigh(copies, rho), count, choice.regime
        positions = particles.cloud.positions.copy()
        coefficients = particles.coefficients.copy()
        positions[choice.replaced] = copies
        coefficients[choice.replaced] = rho
        return self.weigh(positions, coefficients), count, choice.regime

    @abstractmethod
    def _choose(self, particles: WeighedParticles) -> Replacement:
        """Choose the particles to replace, and how."""


@dataclass(frozen=True, slots=True)
class ConventionalParameters(RepeatedResamplingParameters):
    """Parameters of `conventional`."""


class ConventionalTracker(RepeatedResampling[ConventionalParameters]):
    """Table I of P3."""

    def _choose(self, particles: WeighedParticles) -> Replacement:
        """Replace all (steps 15 to 17)."""
        weights = particles.cloud.weights
        everyone = np.ones(len(weights), bool)
        return Replacement(everyone, weights, self._settings.jitter, "regular")


OCCLUSION_TESTS = ("n_eff", "similarity")
"""Tests for an occlusion, by the word that the parameter takes."""


@dataclass(frozen=True, slots=True)
class OcclusionTestParameters:
    """Occlusion test, and the regeneration around the best particle that follows it."""

    test: str = parameter(
        "n_eff", "Take a small effective sample size as occlusion, as printed, or a low similarity "
        "of the best particle.",
        choices=OCCLUSION_TESTS, source="P3 Table II step 15, interpretation 22",
    )  # fmt: skip
    n_eff: float = share(
        0.3, "Higher: more peaked weights count as occlusion.", unit="share of the particles",
        source="P3 T_thres, interpretation 22", tuned=True,
    )  # fmt: skip
    similarity: float = share(
        0.7, "Higher: smaller losses of the best particle's similarity count as occlusion.",
        unit="share of the clear level", source="interpretation 22",
    )  # fmt: skip
    jitter: float = parameter(
        0.25, "Larger: searches further around the best particle.", bounds=(0.0, 10.0),
        unit="share of sigma", source="P3 Table II step 17, interpretation 23",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class AdaptiveParameters(RepeatedResamplingParameters):
    """Parameters of `adaptive`."""

    low_weight: float = parameter(
        1.0, "Higher: more particles are replaced in each pass.", bounds=(0.0, 100.0),
        unit="of the mean weight 1/N", source="P3 Table II step 19, interpretation 23", tuned=True,
    )  # fmt: skip
    occlusion: OcclusionTestParameters = group(OcclusionTestParameters)

    def printed(self) -> AdaptiveParameters:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        occlusion = replace(self.occlusion, test="n_eff")
        return replace(RepeatedResamplingParameters.printed(self), occlusion=occlusion)


class AdaptiveTracker(RepeatedResampling[AdaptiveParameters]):
    """Table II of P3."""

    def _choose(self, particles: WeighedParticles) -> Replacement:
        """Replace low weights, or all but the best, by copies of the rest (steps 17, 20 and 22)."""
        settings = self._settings
        weights = particles.cloud.weights
        if self._is_occluded(particles):  # step 15
            # The cover takes most windows: only the most similar one may still show the vehicle.
            kept = np.arange(len(weights)) == weights.argmax()  # step 16
            jitter = settings.occlusion.jitter
            regime = "occlusion"
        else:
            # At least the best is kept, whatever `low_weight` is: copies need a parent.
            kept = weights >= min(settings.low_weight / len(weights), weights.max())  # step 19
            jitter = settings.jitter
            regime = "regular"
        return Replacement(~kept, np.where(kept, weights, 0.0), jitter, regime)

    def _is_occluded(self, particles: WeighedParticles) -> bool:
        """Test for an occlusion (step 15), by effective sample size or by similarity."""
        test = self._settings.occlusion
        if test.test == "n_eff":
            limit = test.n_eff * len(particles.cloud.positions)
            return effective_sample_size(particles.cloud.weights) < limit
        best = 1.0 - hellinger_distance(particles.coefficients.max())
        return bool(best < test.similarity * self._judge.level)

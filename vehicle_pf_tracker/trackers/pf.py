"""`pf`: the colour particle filter of Perez et al. 2002, as P1 compares itself with it (its [5]).

Resample, propagate with a Normal density, weight by the distance to the first histogram, take the
mean. It has no occlusion branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.features.colour import Histogram
from vehicle_pf_tracker.features.colour_kernel import joint_similarity
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.similarity import hellinger_distance
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.filtering.resampling import SCHEMES
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.contract import ParticleParameters
from vehicle_pf_tracker.trackers.estimate import Array
from vehicle_pf_tracker.trackers.likelihood import LikelihoodParameters, log_likelihood
from vehicle_pf_tracker.trackers.mean_velocity import MeanVelocity
from vehicle_pf_tracker.trackers.parameters import group, parameter

_VELOCITY_WINDOW = 8
"""Displacements in the reported velocity; the filter itself does not use it."""


@dataclass(frozen=True, slots=True)
class PfParameters(ParticleParameters):
    """Parameters of `pf`."""

    sigma: float = parameter(
        8.0,
        "About the vehicle's speed: less loses fast vehicles, more follows look-alikes.",
        minimum=0.01,
        maximum=1000.0,
        unit="px/frame",
        source="P1 eq. 7",
    )
    histogram_bits: int = parameter(
        3,
        "More: finer colours, more easily upset by light and noise.",
        minimum=1,
        maximum=5,
        unit="bits/channel",
        source="P1 section III-C",
        effect="relearns",
    )
    resampling: str = parameter(
        "multinomial",
        "How ancestors are drawn; systematic and stratified vary less.",
        choices=SCHEMES,
        source="P1 Algorithm 2",
    )
    # 0.158 is Perez's lambda of 20.
    likelihood: LikelihoodParameters = group(LikelihoodParameters, sigma_v=0.158)


class PfTracker(ParticleTracker[PfParameters]):
    """The colour particle filter."""

    def __init__(self, parameters: PfParameters) -> None:
        super().__init__(parameters)
        self._reference: Histogram = np.zeros(0)
        self._velocity = MeanVelocity(_VELOCITY_WINDOW)
        self._position = (0.0, 0.0)

    def _learn(self) -> None:
        self._reference = self.target.joint_histogram(self.window, self.parameters.histogram_bits)

    def _scatter(self, centre: tuple[float, float]) -> Array:
        self._velocity, self._position = MeanVelocity(_VELOCITY_WINDOW), centre
        settings = self.parameters
        return np.asarray(centre) + sample_normal(self._rng, settings.num_particles, settings.sigma)

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        settings, count = self.parameters, self.parameters.num_particles
        ancestors = SCHEMES[settings.resampling](self._cloud.weights, count, self._rng)
        parents = self._cloud.positions[ancestors]
        moves = sample_normal(self._rng, count, settings.sigma * elapsed)
        particles, left_image = self._move(frame, parents, moves)
        rho = self._similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        position = cloud.mean()
        similarity = float(
            1.0 - hellinger_distance(self._similarity(frame, np.asarray([position])))[0]
        )
        self._velocity.add(self._position, position, elapsed)
        self._position = position
        return Outcome(
            cloud,
            position,
            self._velocity.value,
            "regular",
            similarity,
            {"pi": similarity},
            resampling_passes=1,
            resampled_particles=count,
            left_image=left_image,
        )

    def _similarity(self, frame: Frame, positions: Array) -> Array:
        """Bhattacharyya coefficient of each window with the reference, shape (N,)."""
        bits = self.parameters.histogram_bits
        return joint_similarity(frame, positions, self.window, self._reference, bits)

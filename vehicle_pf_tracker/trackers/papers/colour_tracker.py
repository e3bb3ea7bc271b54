# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The steps that colour particle filters have in common: what they learn, draw, measure and report.

All compare windows with the colour histogram of the first frame. A filter puts these steps in order
in its `_advance` (`pf`, `sapf`, `hpfms`, `pfcl`; `conventional` and `adaptive`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.image.windows.colour import JointColour
from vehicle_pf_tracker.image.windows.similarity import Reference, hellinger_distance
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.papers import shared
from vehicle_pf_tracker.trackers.parameters import ParticleParameters

VELOCITY_WINDOW = 8
"""Displacements in the reported velocity where the filter itself does not use it: steadier than the
last one alone, and within a third of a second at 25 frames/s."""


@dataclass(frozen=True, slots=True)
class ColourParameters(ParticleParameters):
    """Parameters of every colour particle filter."""

    sigma: float = parameter(
        8.0, "About the vehicle's speed: less loses fast vehicles, more follows similar vehicles.",
        bounds=(0.01, 1000.0), unit="px/frame", source="P1 eq. 7", tuned=True,
    )  # fmt: skip
    histogram_bits: int = shared.histogram_bits_parameter(tuned=True)
    resampling: str = shared.resampling_parameter(source="P1 Algorithm 2")
    # 0.158 is Perez's lambda of 20.
    likelihood: shared.LikelihoodParameters = group(shared.LikelihoodParameters, sigma_v=0.158)


ColourParametersT = TypeVar("ColourParametersT", bound=ColourParameters)


class ColourTracker(ParticleTracker[ColourParametersT]):
    """The steps of a colour particle filter, for `_advance` to put in order."""

    def __init__(self, parameters: ColourParametersT) -> None:
        super().__init__(parameters)
        self.reference = Reference(np.zeros(0))
        self._velocity = shared.MeanVelocity(VELOCITY_WINDOW)
        self._position = (0.0, 0.0)

    def _learn(self) -> None:
        histogram = self.target.joint_histogram(self.window, self._settings.histogram_bits)
        self.reference = Reference(histogram)

    def _scatter(self, centre: tuple[float, float]) -> Array:
        self._velocity = shared.MeanVelocity(VELOCITY_WINDOW)
        self._position = centre
        settings = self._settings
        return np.asarray(centre) + sample_normal(self._rng, settings.num_particles, settings.sigma)

    def _resample(self, cloud: Cloud) -> Array:
        """Draw the positions that the next particles come from."""
        return cloud.positions[self._draw(cloud.weights, self._settings.resampling)]

    def _diffuse(self, frame: Frame, parents: Array, sigma: float) -> tuple[Array, bool]:
        """Propagate with a Normal density (P1 eq. 7); the result is that of `_move`."""
        # Normal in every direction: nothing is known of the turn that the vehicle takes.
        return self._move(frame, parents, sample_normal(self._rng, len(parents), sigma))

    def similarity(self, frame: Frame, positions: Array) -> Array:
        """Bhattacharyya coefficient of each window with the reference, shape (N,)."""
        feature = JointColour(self._settings.histogram_bits)
        return self.kernels.similarity(feature, frame, positions, self.window, self.reference)

    def _report(
        self, frame: Frame, cloud: Cloud, elapsed: float, *, left_image: bool, passes: int = 1
    ) -> Outcome:
        """Take the cloud's mean as the estimate, with the similarity there as evidence."""
        # The window at the estimate is measured by itself: a mean of particles on both sides of an
        # occluder is on it, which the windows of the particles do not show.
        position = cloud.mean()
        coefficient = self.similarity(frame, np.asarray([position]))
        similarity = float(1.0 - hellinger_distance(coefficient)[0])
        self._velocity.add(self._position, position, elapsed)
        self._position = position
        return Outcome(
            cloud,
            position,
            self._velocity.value,
            "regular",
            similarity,
            {"pi": similarity},
            resampling_passes=passes,
            resampled_particles=passes * len(cloud.weights),
            left_image=left_image,
        )

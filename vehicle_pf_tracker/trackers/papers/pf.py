# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`pf`: the colour particle filter of Perez et al. 2002, as P1 compares itself with it (its [5]).

Resample, propagate with a Normal density, weight by the distance to the first histogram, take the
mean. It has no occlusion branch. P1 propagates it as its own filter; Perez et al. have second-order
dynamics, which are an option.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import log_likelihood


@dataclass(frozen=True, slots=True)
class PfParameters(ColourParameters):
    """Parameters of `pf`."""

    dynamics: str = parameter(
        "random_walk",
        "second_order lets each particle keep its own last displacement, and spreads by changes of "
        "speed: less sigma is enough, and a particle that is off course leaves sooner.",
        choices=("random_walk", "second_order"),
        source="P1 eq. 7; Perez 2002, second-order dynamics",
    )


class PfTracker(ColourTracker[PfParameters]):
    """The colour particle filter."""

    def __init__(self, parameters: PfParameters) -> None:
        super().__init__(parameters)
        self._speeds: Array = np.zeros((1, 2))
        """Last displacement of every particle, (N, 2), px per nominal frame."""

    def reconfigure(self, parameters: PfParameters) -> None:
        """Take new parameters; another number of particles all get the mean speed."""
        super().reconfigure(parameters)
        if len(self._speeds) != parameters.num_particles:
            self._speeds = np.tile(self._speeds.mean(axis=0), (parameters.num_particles, 1))

    def _scatter(self, centre: tuple[float, float]) -> Array:
        particles = super()._scatter(centre)
        self._speeds = np.zeros_like(particles)
        return particles

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: resample, propagate, weigh, and report the mean."""
        settings = self._settings
        # Resampling opens the frame, so that the estimate before it is taken from the weights.
        ancestors = self._draw(self._cloud.weights, settings.resampling)
        parents = self._cloud.positions.take(ancestors, axis=0)
        speeds = self._speeds[ancestors]
        expected = parents
        if settings.dynamics == "second_order":
            expected = parents + speeds * elapsed
        particles, left_image = self._diffuse(frame, expected, settings.sigma * elapsed)
        # In one instant nothing has a speed: particles keep the one that they had.
        self._speeds = (particles - parents) / elapsed if elapsed > 0 else speeds
        # As logarithms: with a small sigma_v most weights are below the least float.
        rho = self.similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        return self._report(frame, cloud, elapsed, left_image=left_image)

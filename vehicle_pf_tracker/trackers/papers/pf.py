# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
from vehicle_pf_tracker.trackers.papers.likelihood import log_likelihood


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
        settings = self.parameters
        ancestors = self._draw(self._cloud)
        parents, speeds = self._cloud.positions[ancestors], self._speeds[ancestors]
        expected = parents
        if settings.dynamics == "second_order":
            expected = parents + speeds * elapsed
        particles, left_image = self._diffuse(frame, expected, settings.sigma * elapsed)
        self._speeds = (particles - parents) / elapsed if elapsed > 0 else speeds
        rho = self.similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        return self._report(frame, cloud, elapsed, left_image=left_image)

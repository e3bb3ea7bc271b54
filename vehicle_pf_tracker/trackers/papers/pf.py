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
mean. It has no occlusion branch.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.likelihood import log_likelihood


@dataclass(frozen=True, slots=True)
class PfParameters(ColourParameters):
    """Parameters of `pf`."""


class PfTracker(ColourTracker[PfParameters]):
    """The colour particle filter."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        settings = self.parameters
        parents = self._resample(self._cloud)
        particles, left_image = self._diffuse(frame, parents, settings.sigma * elapsed)
        rho = self._similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        return self._report(frame, cloud, elapsed, left_image=left_image)

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

"""`conventional`: the particle filter that P3 improves on (Khong et al., Table I).

While the effective sample size is too small, every particle is replaced by a jittered copy drawn
from the weighted ones, and weighted again. Step numbers are those of Table I.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.papers.repeated_resampling import (
    RepeatedResampling,
    RepeatedResamplingParameters,
    WeighedParticles,
    common_print,
)


@dataclass(frozen=True, slots=True)
class ConventionalParameters(RepeatedResamplingParameters):
    """Parameters of `conventional`."""

    def effective(self) -> ConventionalParameters:
        """Return the effective parameters: as printed where `as_printed` is set."""
        return common_print(self) if self.as_printed else self


class ConventionalTracker(RepeatedResampling[ConventionalParameters]):
    """Table I of P3."""

    @property
    def _settings(self) -> ConventionalParameters:
        return self.parameters.effective()

    def resample_once(
        self, frame: Frame, particles: WeighedParticles, elapsed: float
    ) -> tuple[WeighedParticles, int, str]:
        """Replace particles once; see `RepeatedResampling.resample_once`."""
        settings = self._settings
        parents = self._resample(particles.cloud)  # step 15
        spread = settings.jitter * settings.sigma * elapsed
        copies = self._scattered(frame, parents, spread)  # step 16
        weighed = self.weigh(copies, self.similarity(frame, copies))  # step 17
        return weighed, len(copies), "regular"

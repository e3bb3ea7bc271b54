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

"""`adaptive`: the particle filter with adaptive resampling of P3 (Khong et al., Table II).

While the effective sample size is too small, only the particles of low weight are replaced; under
occlusion all but the best one are, by copies around it. Step numbers are those of Table II.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.resampling import SCHEMES
from vehicle_pf_tracker.filtering.weights import effective_sample_size
from vehicle_pf_tracker.image.similarity import hellinger_distance
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.papers.conventional import (
    RepeatedResampling,
    RepeatedResamplingParameters,
    WeighedParticles,
    common_print,
)
from vehicle_pf_tracker.trackers.parameters import share

OCCLUSION_TESTS = ("n_eff", "similarity")


@dataclass(frozen=True, slots=True)
class OcclusionTestParameters:
    """Occlusion test, and the regeneration around the best particle that follows it."""

    test: str = parameter(
        "n_eff",
        "Take a small effective sample size as occlusion, as printed, or a low similarity "
        "of the best particle.",
        choices=OCCLUSION_TESTS,
        source="P3 Table II step 15, interpretation 22",
    )
    n_eff: float = share(
        0.3,
        "Higher: more peaked weights count as occlusion.",
        unit="share of the particles",
        source="P3 T_thres, interpretation 22",
        tuned=True,
    )
    similarity: float = share(
        0.7,
        "Higher: smaller losses of the best particle's similarity count as occlusion.",
        unit="share of the clear level",
        source="interpretation 22",
    )
    jitter: float = parameter(
        0.25,
        "Larger: searches further around the best particle.",
        minimum=0.0,
        maximum=10.0,
        unit="share of sigma",
        source="P3 Table II step 17, interpretation 23",
    )


@dataclass(frozen=True, slots=True)
class AdaptiveParameters(RepeatedResamplingParameters):
    """Parameters of `adaptive`."""

    low_weight: float = parameter(
        1.0,
        "Higher: more particles are replaced in each pass.",
        minimum=0.0,
        maximum=100.0,
        unit="of the mean weight 1/N",
        source="P3 Table II step 19, interpretation 23",
        tuned=True,
    )
    occlusion: OcclusionTestParameters = group(OcclusionTestParameters)

    def effective(self) -> AdaptiveParameters:
        """Return the effective parameters: as printed where `as_printed` is set."""
        if not self.as_printed:
            return self
        return replace(common_print(self), occlusion=replace(self.occlusion, test="n_eff"))


class AdaptiveTracker(RepeatedResampling[AdaptiveParameters]):
    """Table II of P3."""

    @property
    def _settings(self) -> AdaptiveParameters:
        return self.parameters.effective()

    def resample_once(
        self, frame: Frame, particles: WeighedParticles, elapsed: float
    ) -> tuple[WeighedParticles, int, str]:
        """Replace particles once; see `RepeatedResampling.resample_once`."""
        settings = self._settings
        weights, count = particles.cloud.weights, len(particles.positions)
        occluded = self._is_occluded(particles)  # step 15
        if occluded:
            kept = np.arange(count) == weights.argmax()  # step 16
            spread = settings.occlusion.jitter * settings.sigma * elapsed
        else:
            kept = weights >= min(settings.low_weight / count, weights.max())  # step 19
            spread = settings.jitter * settings.sigma * elapsed
        weighed = self._regenerate(frame, particles, kept, spread)  # steps 17, 20 and 22
        return weighed, count - int(kept.sum()), "occlusion" if occluded else "regular"

    def _is_occluded(self, particles: WeighedParticles) -> bool:
        test = self._settings.occlusion
        if test.test == "n_eff":
            limit = test.n_eff * len(particles.positions)
            return effective_sample_size(particles.cloud.weights) < limit
        best = 1.0 - hellinger_distance(particles.coefficients.max())
        return bool(best < test.similarity * self._judge.level)

    def _regenerate(
        self,
        frame: Frame,
        particles: WeighedParticles,
        kept: npt.NDArray[np.bool_],
        spread: float,
    ) -> WeighedParticles:
        """Replace all particles but the kept ones by copies of those; only these are weighed."""
        missing = len(kept) - int(kept.sum())
        if missing == 0:
            return particles
        scheme = SCHEMES[self._settings.resampling]
        ancestors = scheme(np.where(kept, particles.cloud.weights, 0.0), missing, self._rng)
        copies = self._scattered(frame, particles.positions[ancestors], spread)
        positions, coefficients = particles.positions.copy(), particles.coefficients.copy()
        positions[~kept] = copies
        coefficients[~kept] = self.similarity(frame, copies)
        return self.weigh(positions, coefficients)

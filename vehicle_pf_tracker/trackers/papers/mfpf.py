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

"""`mfpf`: the triple-feature particle filter of Abdulla et al. 2022 (P2, section IV).

Each feature compares every particle's window with its own reference and finds its own position.
The positions are averaged by how well each feature does against its first frame; a feature that
does badly drops out. Where all have dropped out the vehicle is predicted and the particles are
dispersed again around the prediction. Step numbers are those of the list in section IV. Speeds and
radii are per nominal frame period, so that all of them scale with the elapsed time.
"""

from __future__ import annotations

import statistics
from abc import abstractmethod
from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import sample_disc
from vehicle_pf_tracker.filtering.resampling import SCHEMES, Ancestors
from vehicle_pf_tracker.filtering.weights import Weights, effective_sample_size, from_log
from vehicle_pf_tracker.image.colour import RgbMarginals
from vehicle_pf_tracker.image.gradients import GradientDirections
from vehicle_pf_tracker.image.similarity import (
    Reference,
    bhattacharyya_coefficient,
    hellinger_distance,
)
from vehicle_pf_tracker.image.window import keep_inside
from vehicle_pf_tracker.image.window_feature import Histograms, WindowFeature
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.papers.feature_weighting import (
    FeatureWeighting,
    average_similarities,
    common_survivors,
    weigh_features,
)
from vehicle_pf_tracker.trackers.papers.likelihood import log_likelihood
from vehicle_pf_tracker.trackers.papers.mean_velocity import MeanVelocity
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    TEXTURES,
    EdgeParameters,
    FeatureFilterParameters,
    MfpfParameters,
)

FilterParametersT = TypeVar("FilterParametersT", bound=FeatureFilterParameters)


class FeatureFilter(ParticleTracker[FilterParametersT]):
    """The algorithm of P2 for any number of features; with one it is the single-feature filter."""

    def __init__(self, parameters: FilterParametersT) -> None:
        super().__init__(parameters)
        self._features: Mapping[str, WindowFeature] = {}
        self._first: list[Histograms] = []
        self._references: list[Reference] = []
        self._initial: Array | None = None
        self._weights: Array | None = None
        self._velocity = MeanVelocity(1)
        self._position = (0.0, 0.0)
        self._searching: float | None = None

    @abstractmethod
    def _make_features(self) -> Mapping[str, WindowFeature]:
        """Make the features by name from the effective parameters."""

    @property
    def _is_joint(self) -> bool:
        return True

    @property
    @abstractmethod
    def _settings(self) -> FilterParametersT:
        """Effective parameters."""

    def reconfigure(self, parameters: FilterParametersT) -> None:
        """Take new parameters; see `Tracker.reconfigure`."""
        if parameters.num_particles != self.parameters.num_particles:
            self._weights = None
        super().reconfigure(parameters)
        self._velocity = self._velocity.resized(self._settings.velocity_window)

    def _learn(self) -> None:
        self._features = self._make_features()
        centre = np.asarray([self.target.centre])
        self._first = [
            feature.histograms(self.target.patch, centre, self.window)[0]
            for feature in self._features.values()
        ]
        self._references = [Reference(first) for first in self._first]
        if self._initial is not None:
            # The frame after the start is no longer available; the start itself is closest to it.
            radius, count = self._search_radius(1.0), self.parameters.num_particles
            around = centre + sample_disc(self._rng, count, radius)
            self._initial = self._averages(self._measure(self.target.patch, around))

    def _scatter(self, centre: tuple[float, float]) -> Array:
        """Disperse the first particles (step 1)."""
        settings = self._settings
        self._velocity, self._position = MeanVelocity(settings.velocity_window), centre
        self._searching, self._weights, self._initial = 0.0, None, None
        return centre + sample_disc(self._rng, settings.num_particles, self._search_radius(1.0))

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        settings = self._settings
        resample = self._searching is None and self._is_degenerate()
        particles, prior, left_image = self._predict(frame, elapsed, resample=resample)  # step 3
        rho = self._measure(frame, particles)  # step 2
        averages = self._averages(rho)
        if self._initial is None:
            self._initial = averages
        weighting = weigh_features(averages, self._initial, settings.confidence.threshold)  # step 4
        if weighting.full_occlusion:
            cloud, position = Cloud.uniform(particles), self._predict_position(frame, elapsed)
        else:
            cloud = self._weigh(particles, prior, rho, weighting)
            position = self._locate(particles, weighting)
        histograms = self._describe(frame, position)
        similarities = self._similarities(histograms)
        self._follow(weighting, histograms, position, elapsed)
        return Outcome(
            cloud,
            position,
            self._velocity.value,
            "prediction" if weighting.full_occlusion else "estimation",
            # The median: one feature that fails, or is misled, does not decide.
            statistics.median(similarities.tolist()),
            self._report(weighting),
            resampling_passes=int(resample),
            resampled_particles=len(particles) if resample else 0,
            left_image=left_image,
        )

    def _is_degenerate(self) -> bool:
        limit = self._settings.resample_below * len(self._cloud.weights)
        return effective_sample_size(self._cloud.weights) < limit

    def _predict(
        self, frame: Frame, elapsed: float, *, resample: bool
    ) -> tuple[Array, Array, bool]:
        """Move the particles by equation 5, or disperse them again around the prediction.

        Returns
        -------
        particles (N, 2), their weights before this frame's measurement (N,), and as `_move` does
        """
        settings = self._settings
        count, weights = settings.num_particles, self._cloud.weights
        parents, radius = self._cloud.positions, settings.dispersion.radius * elapsed
        if self._searching is not None:
            parents, radius = np.tile(self._position, (count, 1)), self._search_radius(elapsed)
        elif resample:
            parents = self._resample()
        if self._searching is not None or resample:
            weights = Cloud.uniform(parents).weights
        moves = np.asarray(self._velocity.value) * elapsed + sample_disc(self._rng, count, radius)
        particles, left_image = self._move(frame, parents, moves)
        return particles, weights, left_image

    def _search_radius(self, elapsed: float) -> float:
        dispersion = self._settings.dispersion
        nominal = dispersion.uncertain_factor * dispersion.radius * elapsed
        grown = nominal + dispersion.growth * (self._searching or 0.0)
        return min(grown, max(nominal, dispersion.largest))

    def _resample(self) -> Array:
        """Draw the positions that the next particles come from (step 5)."""
        ancestors = self._draw(self._cloud.weights)
        if self._weights is not None and not self._is_joint:
            sets = [self._draw(weights) for weights in self._weights]
            ancestors = common_survivors(sets, len(ancestors), otherwise=ancestors)
        return self._cloud.positions[ancestors]

    def _draw(self, weights: Weights) -> Ancestors:
        settings = self._settings
        return SCHEMES[settings.resampling](weights, settings.num_particles, self._rng)

    def _measure(self, frame: Frame, particles: Array) -> Array:
        """Bhattacharyya coefficient of every particle by every feature, shape (F, N)."""
        window = self.window
        return np.stack(
            [
                self.kernels.similarity(feature, frame, particles, window, reference)
                for feature, reference in zip(
                    self._features.values(), self._references, strict=True
                )
            ]
        )

    def _averages(self, rho: Array) -> Array:
        best_share = self._settings.confidence.best_share
        return average_similarities(hellinger_distance(rho), best_share)

    def _weigh(
        self, particles: Array, prior: Array, rho: Array, weighting: FeatureWeighting
    ) -> Cloud:
        """Weigh by each feature alone (eq. 10 and 11) and by all in use together."""
        logs = log_likelihood(rho, self._settings.likelihood)
        log_prior = np.log(np.maximum(prior, np.finfo(np.float64).tiny))
        self._weights = np.stack([from_log(log_prior + row)[0] for row in logs])
        return Cloud(particles, *from_log(log_prior + (weighting.factors > 0) @ logs))

    def _locate(self, particles: Array, weighting: FeatureWeighting) -> tuple[float, float]:
        """Position by equation 18, from each feature's own by equation 12 or 13."""
        assert self._weights is not None
        if self._settings.estimate == "best":
            candidates = particles[self._weights.argmax(axis=1)]
        else:
            candidates = self._weights @ particles
        x, y = weighting.combine(candidates)
        return float(x), float(y)

    def _predict_position(self, frame: Frame, elapsed: float) -> tuple[float, float]:
        """Position by equation 5 with the last increments before the occlusion."""
        moved = np.asarray(self._position) + np.asarray(self._velocity.value) * elapsed
        x, y = keep_inside(frame, moved)
        return float(x), float(y)

    def _describe(self, frame: Frame, position: tuple[float, float]) -> list[Histograms]:
        at, window = np.asarray([position]), self.window
        return [
            self.kernels.histograms(feature, frame, at, window)[0]
            for feature in self._features.values()
        ]

    def _similarities(self, histograms: list[Histograms]) -> Array:
        """``1 - BD`` of histograms to the references, shape (F,)."""
        rho = [
            bhattacharyya_coefficient(found, reference.histogram)
            for found, reference in zip(histograms, self._references, strict=True)
        ]
        return np.asarray(1.0 - hellinger_distance(np.asarray(rho)))

    def _follow(
        self,
        weighting: FeatureWeighting,
        histograms: list[Histograms],
        position: tuple[float, float],
        elapsed: float,
    ) -> None:
        """Update references (eq. 9) and increments, but for what is occluded."""
        weight = self._settings.reference_weight
        for number in np.flatnonzero(weighting.factors):
            found = histograms[number]
            blended = weight * self._first[number] + (1 - weight) * found
            self._references[number] = Reference(blended)
        if weighting.full_occlusion:
            self._searching = (self._searching or 0.0) + elapsed
        else:
            self._searching = None
            self._velocity.add(self._position, position, elapsed)
        self._position = position

    def _report(self, weighting: FeatureWeighting) -> dict[str, float]:
        """AS, LC and WF of every feature, and which are in use, for `~/mode`."""
        columns = {
            "as": weighting.averages,
            "lc": weighting.confidences,
            "wf": weighting.factors,
            "used": weighting.factors > 0,
        }
        return {
            f"{column}_{name}": float(value)
            for column, values in columns.items()
            for name, value in zip(self._features, values, strict=True)
        }


class MfpfTracker(FeatureFilter[MfpfParameters]):
    """Colour, edges and texture together."""

    @property
    def _settings(self) -> MfpfParameters:
        return self.parameters.effective()

    @property
    def _is_joint(self) -> bool:
        return self._settings.joint_resampling

    def _make_features(self) -> Mapping[str, WindowFeature]:
        settings = self._settings
        return {
            "color": RgbMarginals(),
            "edge": edge_feature(settings.edges),
            "texture": TEXTURES[settings.texture](),
        }


def edge_feature(parameters: EdgeParameters) -> GradientDirections:
    """Make the edge feature of these parameters."""
    return GradientDirections(
        parameters.threshold, parameters.in_frame, parameters.signed, parameters.floor
    )

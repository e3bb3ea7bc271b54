# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`mfpf`: the triple-feature particle filter of Abdulla et al. 2022 (P2, section IV).

Each feature compares every particle's window with its own reference and finds its own position.
The positions are averaged by how well each feature does against its first frame; a feature that
does badly drops out. Where all have dropped out the vehicle is predicted and the particles are
dispersed again around the prediction.

Steps 1 to 5 are those of the list in section IV, in its order: initialization, measurements,
prediction, updating, resampling. Only the particles' own move of step 3 (eq. 5) opens the next
frame instead, because how long it takes is not known before that frame arrives. Speeds and radii
are per nominal frame period, so that all of them scale with the elapsed time.

Symbols of the paper: BD are Hellinger distances; AS, LC and WF the averages, confidences and
factors of a `FeatureWeighting`, and I_Focc its `full_occlusion`; DR is `dispersion.radius`, and
alpha of equation 9 `reference_weight`.
"""

from __future__ import annotations

import statistics
from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import DISC_SIGMA, sample_disc, sample_normal
from vehicle_pf_tracker.filtering.resampling import Ancestors
from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log
from vehicle_pf_tracker.image.windows.colour import RgbMarginals
from vehicle_pf_tracker.image.windows.similarity import (
    Reference,
    hellinger_distance,
    hellinger_similarity,
)
from vehicle_pf_tracker.image.windows.window import Histograms, WindowFeature, keep_inside
from vehicle_pf_tracker.trackers.base import Cloud, Outcome, ParticleTracker
from vehicle_pf_tracker.trackers.papers.feature_weighting import (
    FeatureWeighting,
    average_similarities,
    common_survivors,
    unweighted,
    weigh_features,
)
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    TEXTURE_FEATURES,
    FilterParametersT,
    MfpfParameters,
    edge_feature,
)
from vehicle_pf_tracker.trackers.papers.shared import MeanVelocity, log_likelihood


class FeatureFilter(ParticleTracker[FilterParametersT]):
    """The algorithm of P2 for any number of features; with one it is the single-feature filter."""

    def __init__(self, parameters: FilterParametersT) -> None:
        super().__init__(parameters)
        self.features: Mapping[str, WindowFeature] = {}
        self.first_histograms: list[Histograms] = []
        """Histogram of each feature in the first frame, hist(0)."""
        self._latest: list[Histograms] = []
        """Histogram of each feature at the last estimate, hist(k - 1)."""
        self.references: list[Reference] = []
        """Reference of each feature, hist_ref."""
        self._initial: Array | None = None
        """Average similarity of each feature in the first measured frame, AS(1)."""
        self._velocity = MeanVelocity(1)
        self._position = (0.0, 0.0)
        self._searching = True
        """True after the start and after predictions: particles are dispersed anew."""
        self._predicted_for = 0.0
        """Time in prediction mode since the last estimate, nominal frames."""
        self._age = 0.0
        """Time since the start, nominal frames."""
        self._ancestors: Ancestors | None = None
        """Particles that step 5 chose, as indices; None where it did not resample."""

    @abstractmethod
    def _make_features(self) -> Mapping[str, WindowFeature]:
        """Make the features by name from the effective parameters."""

    def reconfigure(self, parameters: FilterParametersT) -> None:
        """Take new parameters; see `BaseTracker.reconfigure`."""
        if parameters.num_particles != self.parameters.num_particles:
            self._ancestors = None  # the particles themselves are drawn again
        super().reconfigure(parameters)
        self._velocity = self._velocity.resized(self._settings.velocity_window)

    def _learn(self) -> None:
        """Describe the selected window by every feature (step 1)."""
        self.features = self._make_features()
        centre = np.asarray([self.target.centre])
        self.first_histograms = [
            feature.histograms(self.target.patch, centre, self.window)[0]
            for feature in self.features.values()
        ]
        self._latest = list(self.first_histograms)
        self.references = [Reference(first) for first in self.first_histograms]
        if self._initial is not None:
            # The frame after the start is no longer available; the start itself is closest to it.
            # Predictions since widen the search, but not the one that gave this similarity.
            around = centre + self._noise(self._search_radius(1.0, 0.0))
            self._initial = self._averages(self._compare(self.target.patch, around))

    def _scatter(self, centre: tuple[float, float]) -> Array:
        """Disperse the first particles (step 1)."""
        self._velocity = MeanVelocity(self._settings.velocity_window)
        self._position = centre
        # The first measured frame is searched widely: the vehicle's speed is not known yet.
        self._searching = self._settings.extended
        self._predicted_for = 0.0
        self._age = 0.0
        self._initial = None
        self._ancestors = None
        return centre + self._noise(self._search_radius(1.0, self._predicted_for))

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: the particles' move of step 3, and steps 2 to 5 of section IV."""
        particles, prior, left_image = self._disperse(frame, elapsed)
        rho = self._compare(frame, particles)  # step 2
        averages = self._averages(rho)
        if self._initial is None:
            # AS(1): what the features reach while the whole vehicle is visible. Later frames are
            # judged by their share of it, since features differ in how similar they ever get.
            self._initial = averages
        # Step 3: the object's position by equation 5 with the last increments. It is the estimate
        # only where no feature is in use; else step 4 finds one from the particles.
        moved = np.asarray(self._position) + np.asarray(self._velocity.value) * elapsed
        x, y = keep_inside(frame, moved).tolist()
        weighting = self._weigh_features(averages, self._initial)  # step 4, to its update
        is_hidden = weighting.full_occlusion
        weights, cloud = self.weigh(particles, prior, rho, weighting)
        position = (x, y) if is_hidden else self._locate(particles, weights, weighting)
        # At the estimate, not averaged over particles: the reference learns one window (eq. 9).
        histograms = [
            self.kernels.histogram(feature, frame, position, self.window)
            for feature in self.features.values()
        ]
        similarities = [
            hellinger_similarity(found, reference.histogram)
            for found, reference in zip(histograms, self.references, strict=True)
        ]
        self._update(weighting, histograms, position, elapsed)
        # Step 5. Hidden particles all weigh the same, and are dispersed anew in the next frame.
        passes = 0 if is_hidden else self._resample(cloud, weights)
        return Outcome(
            cloud,
            position,
            self._velocity.value,
            "prediction" if is_hidden else "estimation",
            # The median: one feature that fails, or is misled, does not decide.
            statistics.median(similarities),
            self._report(weighting),
            resampling_passes=passes,
            resampled_particles=passes * len(particles),
            left_image=left_image,
        )

    def _disperse(self, frame: Frame, elapsed: float) -> tuple[Array, Array, bool]:
        """Move the particles by equation 5, or disperse them again around the last position.

        Returns
        -------
        particles (N, 2), their weights before this frame's measurement (N,), and as `_move` does
        """
        settings = self._settings
        cloud = self._cloud
        dispersion = settings.dispersion
        # The first step is a search anyway.
        is_starting = 0 < self._age < dispersion.start
        radius = dispersion.radius * elapsed
        radius *= settings.search_factor if is_starting else 1.0
        self._age += elapsed
        if self._searching:
            # After a prediction the old particles stand where the vehicle was last seen.
            cloud = Cloud.uniform(np.tile(self._position, (settings.num_particles, 1)))
            radius = self._search_radius(elapsed, self._predicted_for)
        elif self._ancestors is not None:
            # Copies of one particle part here, by the noise that each draws for itself.
            cloud = Cloud.uniform(cloud.positions[self._ancestors])
        elif not settings.weight_recursion:
            cloud = Cloud.uniform(cloud.positions)
        self._ancestors = None
        moves = np.asarray(self._velocity.value) * elapsed + self._noise(radius)
        particles, left_image = self._move(frame, cloud.positions, moves)
        return particles, cloud.weights, left_image

    def _noise(self, radius: float) -> Array:
        """Draw the noise of equation 5, which has one variance in both forms."""
        count = self._settings.num_particles
        if self._settings.dispersion.noise == "gaussian":
            return sample_normal(self._rng, count, radius * DISC_SIGMA)
        return sample_disc(self._rng, count, radius)

    def _search_radius(self, elapsed: float, predicted_for: float) -> float:
        """Return the radius of a search, px, after `predicted_for` nominal frames of prediction."""
        # The longer the vehicle is predicted, the less is known of where it is; the largest radius
        # bounds the search where windows would share no pixels, and cost the most.
        dispersion = self._settings.dispersion
        nominal = self._settings.search_factor * dispersion.radius * elapsed
        grown = nominal + dispersion.growth * predicted_for
        return min(grown, max(nominal, dispersion.largest))

    def _compare(self, frame: Frame, particles: Array) -> Array:
        """Bhattacharyya coefficients (F, N) of the particles with the references (eq. 8)."""
        window = self.window
        references = self.references
        return np.stack(
            [
                self.kernels.similarity(feature, frame, particles, window, reference)
                for feature, reference in zip(self.features.values(), references, strict=True)
            ]
        )

    def _averages(self, rho: Array) -> Array:
        """Average similarity of each feature (F,) (eq. 16)."""
        best_share = self._settings.confidence.best_share
        return average_similarities(hellinger_distance(rho), best_share)

    def _weigh_features(self, averages: Array, initial: Array) -> FeatureWeighting:
        """Weigh the features by their confidence (eq. 17), or all alike in the basic filter."""
        if not self._settings.extended:
            return unweighted(averages)
        return weigh_features(averages, initial, self._settings.confidence.threshold)

    def weigh(
        self, particles: Array, prior: Array, rho: Array, weighting: FeatureWeighting
    ) -> tuple[Array, Cloud]:
        """Weigh the particles by each feature alone, and by all in use together.

        Returns
        -------
        weights by each feature (F, N; eq. 10 and 11), and the particles with their joint weights
        (interpretation 18), which are equal where no feature is in use
        """
        logs = log_likelihood(rho, self._settings.likelihood)
        # The weight so far is a factor (eq. 3, interpretation 35), 1/N where step 5 has resampled.
        log_prior = np.log(np.maximum(prior, np.finfo(np.float64).tiny))
        weights = np.stack([from_log(log_prior + row)[0] for row in logs])
        if weighting.full_occlusion:
            return weights, Cloud.uniform(particles)
        joint = from_log(log_prior + (weighting.factors > 0) @ logs)
        return weights, Cloud(particles, *joint)

    def _locate(
        self, particles: Array, weights: Array, weighting: FeatureWeighting
    ) -> tuple[float, float]:
        """Position by equation 18, from each feature's own by equation 12 or 13 (step 4)."""
        if self._settings.estimate == "best":
            candidates = particles[weights.argmax(axis=1)]  # eq. 12
        else:
            # Equation 13: steadier than the best of few particles (interpretation 17).
            candidates = weights @ particles
        x, y = weighting.factors @ candidates
        return float(x), float(y)

    def _update(
        self,
        weighting: FeatureWeighting,
        histograms: list[Histograms],
        position: tuple[float, float],
        elapsed: float,
    ) -> None:
        """Update references (eq. 9) and increments; both stay in a full occlusion (step 4)."""
        settings = self._settings
        if weighting.full_occlusion:
            self._predicted_for += elapsed
        else:
            self._predicted_for = 0.0
            self._velocity.add(self._position, position, elapsed)
            for number, (first, found) in enumerate(
                zip(self.first_histograms, histograms, strict=True)
            ):
                if weighting.factors[number] > 0 or settings.update_unused:
                    weight = settings.reference_weight
                    last = self._latest[number] if settings.delayed_reference else found
                    self.references[number] = Reference(weight * first + (1 - weight) * last)
                    self._latest[number] = found
        self._searching = weighting.full_occlusion
        self._position = position

    def _resample(self, cloud: Cloud, weights: Array) -> int:
        """Choose the particles that go on where too few of them count (step 5).

        `weights` are those by each feature alone. Returns the number of resamplings, 0 or 1.
        """
        settings = self._settings
        limit = settings.resample_below * len(cloud.weights)
        if effective_sample_size(cloud.weights) >= limit:
            return 0
        self._ancestors = self._draw(cloud.weights, settings.resampling)
        if not settings.joint_resampling:
            sets = [self._draw(own, settings.resampling) for own in weights]
            count = len(self._ancestors)
            self._ancestors = common_survivors(sets, count, otherwise=self._ancestors)
        return 1

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
            for name, value in zip(self.features, values, strict=True)
        }


class MfpfTracker(FeatureFilter[MfpfParameters]):
    """Colour, edges and texture together."""

    def _make_features(self) -> Mapping[str, WindowFeature]:
        settings = self._settings
        return {
            "color": RgbMarginals(),
            "edge": edge_feature(settings.edges),
            "texture": TEXTURE_FEATURES[settings.texture](),
        }

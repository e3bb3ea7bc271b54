# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Weighting of P2's features by their confidence: AS, LC and WF (section IV, eq. 16 to 18).

Arrays have one row or entry for each feature, in the tracker's order.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.filtering.resampling import Ancestors


def average_similarities(distances: Array, best_share: float) -> Array:
    """Average similarity AS of each feature over the particles most similar to its reference.

    Parameters
    ----------
    distances : (F, N) array
        Bhattacharyya distances of the particles (eq. 8), 0 to 1.
    best_share : float
        Share of the particles that count; 1 is all of them, as printed (interpretation 19).

    Returns
    -------
    (F,) array
        Mean of ``1 - BD`` (eq. 16), 0 to 1.
    """
    # Far particles say how wide the cloud is, and not whether the vehicle is visible.
    count = max(math.ceil(best_share * distances.shape[1]), 1)
    best = np.partition(distances, count - 1, axis=1)[:, :count]
    return np.asarray(1.0 - best.mean(axis=1))


@dataclass(frozen=True, slots=True)
class FeatureWeighting:
    """Confidence and weight of the features in one frame; arrays of shape (F,).

    Attributes
    ----------
    averages : array
        Average similarity AS, 0 to 1.
    confidences : array
        Level of confidence LC, AS over its value in the first frame after the start; 0 for a
        feature below its threshold. May exceed 1.
    factors : array
        Weighting factor WF (eq. 17), 0 to 1; all 0 if no feature is in use.
    """

    averages: Array
    confidences: Array
    factors: Array

    @property
    def full_occlusion(self) -> bool:
        """True if every feature is below its threshold."""
        return not self.factors.any()


def weigh_features(averages: Array, initial: Array, threshold: float) -> FeatureWeighting:
    """Compare each feature's average similarity with its initial one.

    Parameters
    ----------
    averages, initial : (F,) arrays
        AS now, and in the first frame after the start.
    threshold : float
        Share of `initial` below which a feature drops out.
    """
    # A feature that drops out has no weight at all: a part of an occluder that happens to be
    # similar would pull the position as strongly as the vehicle.
    useful = (averages > 0) & (averages >= threshold * initial)
    # A first similarity of 0 has no share: such a feature never counts.
    ratios = averages / np.where(initial > 0, initial, 1.0)
    confidences = np.where(useful & (initial > 0), ratios, 0.0)
    total = confidences.sum()
    # Equation 17; without a feature in use its denominator is 0, and so are the factors.
    return FeatureWeighting(
        averages, confidences, confidences / total if total > 0 else confidences
    )


def unweighted(averages: Array) -> FeatureWeighting:
    """Use every feature alike, whatever its average similarity: the basic filter of section III."""
    alike = np.ones(len(averages))
    return FeatureWeighting(averages, alike, alike / len(averages))


def common_survivors(sets: Sequence[Ancestors], count: int, otherwise: Ancestors) -> Ancestors:
    """Keep the particles that survive in every feature's own resampling, as printed.

    The paper does not define how the set is filled up again (interpretation 18); here its members
    are repeated in turn.

    Parameters
    ----------
    sets : sequence of arrays of ancestor indices
        Survivors of each feature's resampling.
    count : int
        Number of indices to return.
    otherwise : array of ancestor indices
        Result where no particle survives in all sets.
    """
    # Random draws of three sets seldom agree: the fewer survive, the more often each is repeated.
    common = functools.reduce(np.intersect1d, sets)
    return np.resize(common, count) if len(common) else otherwise

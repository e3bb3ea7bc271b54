# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""P2 section IV: AS, LC, WF and the printed resampling, by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vehicle_pf_tracker.trackers.papers.feature_weighting import (
    average_similarities,
    common_survivors,
    weigh_features,
)


def test_average_similarity_of_all_particles_as_printed():
    distances = np.array([[0.1, 0.2, 0.6], [0.5, 0.5, 0.5]])
    assert average_similarities(distances, 1.0) == pytest.approx([0.7, 0.5])


def test_interpretation_19_average_similarity_of_the_best():
    distances = np.linspace(0.0, 0.95, 20)[np.newaxis, ::-1]
    # A tenth of 20 particles: 1 - 0.00 and 1 - 0.05.
    assert average_similarities(distances, 0.1) == pytest.approx([0.975])
    assert average_similarities(distances, 0.0) == pytest.approx([1.0])


def test_confidences_and_factors_by_hand():
    weighting = weigh_features(np.array([0.6, 0.4, 0.3]), np.array([0.5, 0.5, 0.5]), 0.7)
    # Ratios 1.2, 0.8 and 0.6; the last is below the threshold.
    assert weighting.confidences == pytest.approx([1.2, 0.8, 0.0])
    assert weighting.factors == pytest.approx([0.6, 0.4, 0.0])
    assert not weighting.full_occlusion


def test_all_below_their_thresholds_is_full_occlusion():
    weighting = weigh_features(np.array([0.2, 0.3]), np.array([0.5, 0.5]), 0.7)
    assert weighting.full_occlusion
    assert weighting.factors.tolist() == [0, 0]


@given(
    hnp.arrays(float, 3, elements=st.just(0.0) | st.floats(0.001, 1)),
    hnp.arrays(float, 3, elements=st.just(0.0) | st.floats(0.001, 1)),
    st.floats(0, 1),
)
def test_factors_are_shares_or_all_zero(averages, initial, threshold):
    factors = weigh_features(averages, initial, threshold).factors
    assert np.all(factors >= 0)
    assert factors.sum() == pytest.approx(1.0) or not factors.any()


def test_printed_resampling_keeps_what_survives_everywhere_and_repeats_it():
    sets = [np.array([0, 1, 1, 3]), np.array([3, 1, 2, 2]), np.array([1, 1, 3, 0])]
    assert common_survivors(sets, 5, np.zeros(5, int)).tolist() == [1, 3, 1, 3, 1]


def test_printed_resampling_without_a_common_survivor():
    sets = [np.array([0, 0]), np.array([1, 1])]
    assert common_survivors(sets, 2, np.array([7, 8])).tolist() == [7, 8]


def test_a_feature_that_was_never_there_is_never_used():
    weighting = weigh_features(np.array([0.0, 0.9, 0.4]), np.array([0.0, 0.0, 0.4]), 0.0)
    assert weighting.factors.tolist() == [0, 0, 1]


def test_the_best_share_is_rounded_up_to_a_particle():
    assert average_similarities(np.array([[0.1, 0.3, 0.9]]), 0.5) == pytest.approx([0.8])

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detections of one frame: which of them can be used."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.detections import MOST_DETECTIONS, Detections


def test_usable_detections_are_few_finite_distinct_and_in_the_image():
    rng = np.random.default_rng(0)
    flood = np.hstack([rng.uniform(0, 200, (10_000, 2)), rng.uniform(5, 30, (10_000, 2))])
    kept = Detections.make(flood, rng.uniform(size=10_000)).usable(320, 240)
    assert len(kept) == MOST_DETECTIONS
    bad = [(np.nan, 0, 5, 5), (0, 0, -3, 5), (900, 0, 5, 5), (0, 0, 1e5, 5), (1, 1, 5, 5)]
    assert len(Detections.make([*bad, bad[-1]]).usable(320, 240)) == 1


def test_there_is_a_score_for_each_box_or_for_none():
    with pytest.raises(ValueError, match="as many"):
        Detections.make([(1, 1, 5, 5)], [1.0, 2.0])

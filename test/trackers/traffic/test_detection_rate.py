# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Share of the vehicles that a detector finds."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.detection_rate import DetectionRate


@pytest.mark.parametrize("found", [True, False])
def test_a_detector_that_became_worse_or_better_is_known_to_after_minutes(found):
    rate = DetectionRate()
    asked = np.ones(5, np.bool_)
    for _ in range(4000):
        rate.learn(asked, np.full(5, found))
    for _ in range(1000):
        shares = rate.learn(asked, np.full(5, not found))
    assert abs(rate.share - found) > 0.8
    assert 0 < shares[-1] < 1

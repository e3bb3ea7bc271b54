# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from estimate_samples import estimate

from vehicle_pf_tracker.trackers.estimate import START_REGIME, Mode
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.uncertainty import (
    Calibration,
    Spread,
    Uncertainty,
    cloud_covariance,
)
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS

SECOND = 1_000_000_000
NOTHING = Spread(0.0, 0.0, 0.0, 0.0)


def test_covariance_of_a_cloud_by_hand():
    # Weights 1/2, 1/4, 1/4 at 0, 4 and 8: mean 3, variance 9/2 + 1/4 + 25/4 = 11.
    found = cloud_covariance(
        estimate(particles=[[0, 0], [4, 0], [8, 0]], weights=[0.5, 0.25, 0.25])
    )
    assert found == pytest.approx(np.diag([11.0, 0.0]))
    apart = estimate(particles=[[-1, -1], [1, 1]])
    assert cloud_covariance(apart) == pytest.approx(np.ones((2, 2)))


@pytest.mark.parametrize(
    ("spread", "expected"),
    [
        # The box has 20 x 10 px: an area of 200 px².
        (Spread(3.0, 0.0, 0.0, 0.0), [[9.0, 9.0], [9.0, 9.0]]),
        (Spread(0.0, 0.1, 0.0, 0.0), np.eye(2) * 2),
        (Spread(0.0, 0.0, 0.2, 0.0), np.eye(2) * 0.01 * 200),  # half of the confidence is missing
        (Spread(0.0, 0.0, 0.0, 0.1), np.eye(2) * 0.01 * 200 * np.log(2) ** 2),
        (Spread(0.0, 0.0, 0.0, 0.0, 0.1), np.eye(2) * 0.01 * 200 * 9),  # for 3 s
        (Spread(0.0, 0.0, 0.0, 0.0, 0.0, 0.1), [[2.25, 3.0], [3.0, 4.0]]),  # 15, 20 px in 3 s
        (Spread(0.0, 0.1, 0.2, 0.0), np.eye(2) * 4),  # parts add up
    ],
)
def test_each_part_by_hand(spread, expected):
    one = estimate(particles=[[-1, -1], [1, 1]], velocity=(0.5, 2 / 3), confidence=0.5)
    found = spread.covariance(one, 0.1, 3.0, first_area=50.0)  # the side was half as long
    assert found == pytest.approx(np.asarray(expected, float))


def test_it_grows_while_hidden_and_no_longer_when_seen_again():
    track = Uncertainty(Calibration(Spread(0.0, 0.1, 0.0, 0.0), Spread(0.0, 0.1, 0.0, 0.0, 0.5)))
    modes = [Mode.TRACKING, Mode.OCCLUDED, Mode.OCCLUDED, Mode.LOST, Mode.TRACKING]
    variances = []
    for index, mode in enumerate(modes):
        one = estimate(mode=mode)
        track.follow(one, index * SECOND)
        variances.append(track.covariance(one, 1.0)[0, 0])
    assert variances == pytest.approx([200 * (0.01 + 0.25 * t**2) for t in (0, 1, 2, 3, 0)])


def test_a_new_start_forgets_size_and_time():
    track = Uncertainty(Calibration(Spread(0.0, 0.0, 0.0, 1.0), NOTHING))
    large = estimate(size=(40.0, 20.0))
    for index, one in enumerate([estimate(regime=START_REGIME), large]):
        track.follow(one, index)
    assert track.covariance(large, 1.0)[0, 0] == pytest.approx(800 * np.log(2) ** 2)
    again = estimate(size=(40.0, 20.0), regime=START_REGIME)
    track.follow(again, 2)
    assert track.covariance(again, 1.0)[0, 0] == 0


def test_calibrations_are_of_variants_and_of_all_others():
    assert {"*", "fusion"} <= set(CALIBRATIONS) <= {"*", *VARIANTS}


def test_time_that_goes_back_is_not_negative():
    track = Uncertainty(Calibration(NOTHING, Spread(0.0, 0.0, 0.0, 0.0, 1.0)))
    hidden = estimate(mode=Mode.OCCLUDED)
    for stamp in (10 * SECOND, 2 * SECOND, 3 * SECOND):
        track.follow(hidden, stamp)
    assert track.covariance(hidden, 1.0)[0, 0] == pytest.approx(200.0)

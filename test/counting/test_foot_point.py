# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The point at which a vehicle stands, by hand."""

import math
from dataclasses import replace

import pytest
from traffic_samples import vehicle

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.counting.foot_point import FootPoint, foot_of
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode


def foot(mode=TrackMode.TRACKING, size=(40.0, 20.0), covariance=(4.0, 1.0, 9.0)):
    return FootPoint((10.0, 50.0), 1000, mode, size, covariance)


def test_the_point_is_the_middle_of_the_lower_edge():
    assert foot_of(Box(10.0, 20.0, 40.0, 30.0)) == (30.0, 50.0)


@pytest.mark.parametrize(
    ("normal", "variance"),
    [((1.0, 0.0), 4.0), ((0.0, 1.0), 9.0), ((0.6, 0.8), 1.44 + 0.96 + 5.76)],
)
def test_deviation_along_a_direction(normal, variance):
    assert foot().deviation(normal) == pytest.approx(math.sqrt(variance))


def test_a_covariance_that_rounding_made_negative_has_no_deviation():
    assert foot(covariance=(1.0, -1.0, 1.0 - 1e-12)).deviation((0.5**0.5, 0.5**0.5)) == 0.0


@pytest.mark.parametrize(
    ("normal", "length"), [((1.0, 0.0), 40.0), ((0.0, -1.0), 20.0), ((-0.6, 0.8), 24.0 + 16.0)]
)
def test_extent_of_the_box_along_a_direction(normal, length):
    assert foot().extent(normal) == pytest.approx(length)


@pytest.mark.parametrize(("height", "rounding"), [(5.0, 1.0), (10.0, 1.0), (30.0, 3.0)])
def test_borders_are_rounded_to_a_pixel_or_a_tenth_of_the_height(height, rounding):
    assert foot(size=(40.0, height)).rounding == pytest.approx(rounding)


@pytest.mark.parametrize(
    ("mode", "covariance", "margin"),
    [
        (TrackMode.TRACKING, (4.0, 0.0, 9.0), 6.0),  # twice the larger deviation
        (TrackMode.TRACKING, (16.0, 0.0, 9.0), 8.0),
        (TrackMode.TRACKING, (0.25, 0.0, 0.25), 2.0),  # a tenth of 20 px
        (TrackMode.OCCLUDED, (4.0, 0.0, 9.0), 2.0),  # what is predicted becomes no surer so
    ],
)
def test_the_margin_is_the_larger_of_rounding_and_spread(mode, covariance, margin):
    assert foot(mode, covariance=covariance).margin == pytest.approx(margin)


def test_a_point_of_the_way_has_the_later_facts():
    later = FootPoint((30.0, 90.0), 2001, TrackMode.OCCLUDED, (44.0, 22.0))
    quarter = foot().towards(later, 0.25)
    assert (quarter.point, quarter.stamp_ns) == ((15.0, 60.0), 1250)
    assert (quarter.mode, quarter.size) == (TrackMode.OCCLUDED, (44.0, 22.0))
    assert foot().is_seen and not quarter.is_seen


def test_an_estimate_stands_where_its_box_does_with_its_own_covariance():
    estimate = replace(
        vehicle(1, 30.0, 50.0, TrackMode.OCCLUDED, size=(40.0, 20.0)),
        foot_covariance=(4.0, 1.0, 9.0),
    )
    assert FootPoint.of(estimate, 1000) == FootPoint(
        (30.0, 50.0), 1000, TrackMode.OCCLUDED, (40.0, 20.0), (4.0, 1.0, 9.0)
    )

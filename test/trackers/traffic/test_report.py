# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates of a frame: modes, confidence, what hides a vehicle, and their order."""

import math

import numpy as np
import pytest
from traffic_samples import changed, together, track

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.traffic.estimate import BORDER_OCCLUDER, SCENE_OCCLUDER, TrackMode
from vehicle_pf_tracker.trackers.traffic.report import estimates_of


@pytest.mark.parametrize(
    ("facts", "mode", "hidden_by"),
    [
        ({}, TrackMode.TENTATIVE, None),
        ({"confirmed": True}, TrackMode.TRACKING, None),
        ({"confirmed": True, "unseen": 1.9}, TrackMode.TRACKING, None),
        ({"confirmed": True, "unseen": 2.0}, TrackMode.OCCLUDED, SCENE_OCCLUDER),
        ({"confirmed": True, "unseen": 2.0, "inside": 0.49}, TrackMode.OCCLUDED, BORDER_OCCLUDER),
        ({"confirmed": True, "unseen": 2.0, "hidden_by": 7, "inside": 0.1}, TrackMode.OCCLUDED, 7),
        ({"confirmed": True, "lost": True}, TrackMode.LOST, SCENE_OCCLUDER),
        ({"unseen": 9.0, "lost": True}, TrackMode.TENTATIVE, None),
    ],
)
def test_a_mode_says_what_is_known_and_a_hidden_vehicle_what_hides_it(facts, mode, hidden_by):
    (one,) = estimates_of(track(1, 100.0, **facts))
    assert (one.mode, one.hidden_by) == (mode, hidden_by)


def test_the_confidence_is_the_probability_of_a_vehicle_and_half_of_it_where_it_is_predicted():
    even, seen = (track(1, 100.0, confirmed=True, log_odds=odds) for odds in (0.0, math.log(4)))
    assert estimates_of(even)[0].confidence == pytest.approx(0.5)
    assert estimates_of(seen)[0].confidence == pytest.approx(0.8)
    assert estimates_of(changed(seen, unseen=5.0))[0].confidence == pytest.approx(0.4)


def test_vehicles_come_by_number_and_tentative_ones_last():
    ninth = changed(track(1, 99.0), identity=9)
    tracks = together(track(5, 10.0), track(4, 50.0, confirmed=True), track(3, 90.0), ninth)
    numbers = [(one.identity, one.serial) for one in estimates_of(tracks)]
    assert numbers == [(4, 4), (9, 1), (0, 3), (0, 5)]


def test_a_box_is_where_the_detection_is_ahead_of_the_state_and_has_a_size():
    lag = np.array([[1.0, 2.0, 3.0, 4.0]])
    (one,) = estimates_of(changed(track(1, 100.0), lag=lag))
    assert one.box == Box(101.0, 102.0, 42.0, 32.0)
    (thin,) = estimates_of(changed(track(1, 100.0), lag=np.array([[0.0, 0.0, -60.0, 0.0]])))
    assert thin.box == Box(100.0, 100.0, 1.0, 30.0)


def test_the_class_with_the_most_votes_is_reported_of_equally_many_the_first():
    labels = {}
    for votes in ({}, {"car": 1, "bus": 2}, {"van": 2, "car": 2}):
        one = track(1, 100.0)
        one.names.votes[0] = votes
        labels[len(labels)] = estimates_of(one)[0].label
    assert labels == {0: "", 1: "bus", 2: "van"}

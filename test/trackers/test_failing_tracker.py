# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trackers that fail on good images, in both sessions."""

from dataclasses import replace

import numpy as np
import pytest
from failing import ERROR, failing
from session_samples import PERIOD_NS, session
from street import Street, error

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.attempts import TrackerError
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

ANEW = f"the tracker failed twice in a row and has started anew: {ERROR}"


def fail(of, method: str, at, reason=ZeroDivisionError):
    """Have a method of a session's tracker raise in the calls of these numbers, from 0."""
    setattr(of.tracker, method, failing(getattr(of.tracker, method), at, reason))


def outcomes(of, frames, first: int):
    """Feed frames; an estimate, or the error, for each."""
    return [outcome(of, frame, (first + at) * PERIOD_NS) for at, frame in enumerate(frames, 1)]


def outcome(of, frame, stamp_ns: int):
    try:
        return of.feed(frame, stamp_ns)
    except (TrackerError, InputError) as raised:
        return raised


@pytest.fixture
def street():
    return Street()


@pytest.fixture
def tracking(street):
    """Return a session that was given its target by hand, and has followed it for 10 images."""
    of = session()
    of.set_target(street.box(0))
    outcomes(of, map(street.frame, range(10)), 0)
    return of


@pytest.fixture
def traffic():
    """Return a session of an image with a vehicle that was given by hand, and one that was not."""
    of = TrafficSession(MultiVehicleTracker())
    of.feed(SCENE, PERIOD_NS)
    of.tracker.add(Box(8, 8, 20, 12))
    of.add(Box(60, 40, 30, 20), "van")
    for index in range(1, 6):
        of.feed(scene(index), (index + 1) * PERIOD_NS)
    return of


def scene(index: int):
    """Return an image in which everything has moved to the right by 2 px since the one before."""
    return np.roll(SCENE, 2 * index, axis=1)


SCENE = np.random.default_rng(1).integers(0, 256, (96, 128, 3), np.uint8)


def test_one_error_costs_one_image(street, tracking):
    fail(tracking, "step", {0, 2})
    found = outcomes(tracking, map(street.frame, range(10, 14)), 10)
    for raised in found[::2]:
        assert str(raised) == ERROR
        assert isinstance(raised.__cause__, ZeroDivisionError)
        assert not raised.persists
    assert [one.regime == "start" for one in found[1::2]] == [False, False]
    assert not tracking.recovered


def test_the_second_error_in_a_row_starts_anew_where_the_target_was_seen(street, tracking):
    fail(tracking, "step", {0, 1})
    failed, anew = outcomes(tracking, map(street.frame, (10, 11)), 10)
    assert isinstance(failed, TrackerError)
    assert anew.regime == "start"
    assert error(anew, street, 11) < 10
    assert tracking.recovered
    assert tracking.events == [ANEW]
    (after,) = outcomes(tracking, [street.frame(12)], 12)
    assert error(after, street, 12) < 10
    assert (tracking.recovered, tracking.events) == (False, [])


def test_a_start_that_fails_is_tried_again(street):
    of = session()
    of.set_target(street.box(0))
    fail(of, "start", {0})
    failed, started = outcomes(of, map(street.frame, range(2)), 0)
    assert isinstance(failed, TrackerError)
    assert started.regime == "start"
    assert of.events == []


def test_a_tracker_that_fails_as_soon_as_it_starts_anew_is_broken(street, tracking):
    fail(tracking, "step", range(100))
    fail(tracking, "start", range(100))
    found = outcomes(tracking, map(street.frame, range(10, 15)), 10)
    assert [raised.persists for raised in found] == [False, True, True, True, True]


def test_mistakes_of_users_are_no_failures_of_the_tracker(street, tracking):
    fail(tracking, "step", range(3), InputError)
    found = outcomes(tracking, map(street.frame, range(10, 14)), 10)
    assert [type(one) for one in found[:3]] == [InputError] * 3
    assert found[3].regime != "start"


def test_vehicles_given_by_hand_are_kept(traffic):
    fail(traffic, "step", {0, 1})
    before = traffic.estimates
    failed, anew = outcomes(traffic, map(scene, (6, 7)), 6)
    assert isinstance(failed, TrackerError)
    assert len(before) == 2
    (kept,) = anew
    assert traffic.successors == {before[1].identity: kept.identity}
    assert kept.identity > before[1].identity
    assert kept.label == "van"
    assert kept.position == pytest.approx(before[1].position, abs=5)
    assert kept.box.x > 60 + 5
    assert traffic.recovered
    assert traffic.events == [ANEW]
    assert traffic.restarts == 1
    outcomes(traffic, [scene(8)], 8)
    assert (traffic.recovered, traffic.events) == (False, [])


def test_what_was_removed_by_hand_stays_removed(traffic):
    traffic.remove(traffic.estimates[1].identity)
    fail(traffic, "step", {0, 1})
    assert outcomes(traffic, map(scene, (6, 7)), 6)[1] == ()


def test_a_detector_that_fails_is_made_anew():
    class Eye:
        made = 0

        def __init__(self):
            Eye.made += 1
            self.disturbed = self.is_blind = False

        def detect(self, frame, tracks=(), period=0.0):
            if Eye.made == 1:
                raise ZeroDivisionError
            self.is_blind = True

    of = TrafficSession(MultiVehicleTracker(), Eye)
    failed, anew = outcomes(of, [SCENE] * 2, 0)
    assert isinstance(failed, TrackerError)
    assert (anew, Eye.made) == ((), 2)


def test_broken_traffic_says_so(traffic):
    fail(traffic, "step", range(100))
    found = outcomes(traffic, map(scene, range(6, 10)), 6)
    assert [raised.persists for raised in found] == [False, True, True, True]


@pytest.mark.parametrize("part", ["positions", "weights"])
def test_numbers_that_are_not_finite_are_an_error_of_the_tracker(street, tracking, part):
    good = tracking.tracker._advance

    def broken(frame, elapsed):
        outcome = good(frame, elapsed)
        values = getattr(outcome.cloud, part).copy()
        values[0] = np.nan
        return replace(outcome, cloud=replace(outcome.cloud, **{part: values}))

    tracking.tracker._advance = broken
    first = outcome(tracking, street.frame(10), 11 * PERIOD_NS)
    assert "ApfTracker gave particles, weights or a position that are not finite" in str(first)
    tracking.tracker._advance = good
    assert error(outcome(tracking, street.frame(11), 12 * PERIOD_NS), street, 11) < 10

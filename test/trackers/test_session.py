# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import contextlib
import functools

import numpy as np
import pytest
from session_samples import APF, PERIOD_NS, configured, feed, positions, session
from street import Street, error

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import StampEvent
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.continuity import ODD_STAMP_PATIENCE, StrayImageError
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.papers.apf import ApfParameters
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.session import Session, TargetError


def test_waits_until_there_is_a_target():
    street, waiting = Street(), session()
    assert waiting.waiting
    assert feed(waiting, street, range(3)) == [None] * 3
    waiting.set_target(street.box(3))
    started, *rest = feed(waiting, street, range(3, 8))
    assert started.regime == "start"
    assert not waiting.waiting
    assert error(rest[-1], street, 7) < 10


def test_a_recording_that_loops_gives_the_same_again():
    street = Street()
    looped = session(street.box(0))
    # Uneven times at first, which count as one period each until the period is known.
    times = [0, 2, 3, 6, *range(7, 30)]
    first = feed(looped, street, times)
    with pytest.raises(StrayImageError, match=r"stamp goes back by 1\.160 s"):
        feed(looped, street, times[:1])
    assert positions(feed(looped, street, times[1:])) == positions(first[1:])


def test_the_jump_back_is_told_and_can_be_ridden_over():
    street = Street()
    steady = session(street.box(0), reset_on_time_jump=False)
    feed(steady, street, range(5), offset=100)
    with pytest.raises(StrayImageError):
        feed(steady, street, [5])
    estimate = feed(steady, street, [6])[0]
    assert steady.events == ["time jumped back"]
    assert estimate.regime != "start"
    assert error(estimate, street, 6) < 10


def test_a_clock_that_is_set_back_by_less_than_a_second_loses_no_target():
    street = Street()
    waits_for_target = session(None)
    waits_for_target.set_target(street.box(0))
    feed(waits_for_target, street, range(10))
    with pytest.raises(StrayImageError):
        waits_for_target.feed(street.frame(10), 9 * PERIOD_NS - 1)
    estimate = waits_for_target.feed(street.frame(11), 10 * PERIOD_NS - 1)
    assert waits_for_target.events == [
        "time went back by less than a second, as if the clock was set"
    ]
    assert error(estimate, street, 11) < 10


# Strays: the same estimates as if they had never been there.

DAY_NS = 86_400_000_000_000


def believes(of, street, time, stamp_ns):
    """Feed a frame; tells whether it was believed."""
    try:
        of.feed(street.frame(time), stamp_ns)
    except StrayImageError:
        return False
    return True


def feed_with_strays(of, street, strays):
    """Feed thirty frames; before the frame `i`, the images of `strays[i]`, which are rejected."""
    estimates = []
    for t in range(30):
        for frame, stamp in strays.get(t, []):
            with pytest.raises(StrayImageError):
                of.feed(frame, stamp)
        estimates += feed(of, street, [t])
    return estimates


def other(size=20):
    return np.zeros((size, size, 3), np.uint8)


@pytest.mark.parametrize("stamp", [0, 2 * PERIOD_NS, DAY_NS])
@pytest.mark.parametrize("times", [[8, 9, 15], [*range(5, 30)]])
def test_a_stray_stamp_costs_the_track_nothing(stamp, times):
    street = Street()
    strays = {t: [(street.frame(t), stamp)] for t in times}
    plain = feed(session(street.box(0)), street, range(30))
    assert positions(feed_with_strays(session(street.box(0)), street, strays)) == positions(plain)


def feed_with_one_ahead(of, street, at, ahead_ns, size=30):
    """Feed frames of which one has a stamp that is ahead; it may cost its own estimate alone."""
    estimates = []
    for t in range(size):
        if t == at:
            with contextlib.suppress(StrayImageError):
                of.feed(street.frame(t), (t + 1) * PERIOD_NS + ahead_ns)
        else:
            estimates += feed(of, street, [t])
    return estimates


def session_of(variant, box):
    kind = VARIANTS[variant]
    return Session(kind, kind.parameters(), configured(box))


@functools.cache
def positions_without(variant, at):
    """Positions where one of the images never comes."""
    street = Street()
    of = session_of(variant, street.box(0))
    return positions(feed(of, street, [t for t in range(30) if t != at]))


@pytest.mark.parametrize("ahead", [1.05, 4, 124, 10**6])
@pytest.mark.parametrize("at", [1, 2, 12])
@pytest.mark.parametrize("variant", ["apf", "fusion"])
def test_one_stamp_ahead_costs_its_own_estimate_alone(variant, at, ahead):
    """As if the image had never come, whether its stamp passes for a gap or not."""
    street = Street()
    of = session_of(variant, street.box(0))
    odd = feed_with_one_ahead(of, street, at, round(ahead * PERIOD_NS))
    assert positions(odd) == positions_without(variant, at)


@pytest.mark.parametrize("ahead", [3, 100, 10**6])
def test_a_first_stamp_ahead_costs_nothing(ahead):
    street = Street()
    odd = session(street.box(0))
    odd.feed(street.frame(0), (1 + ahead) * PERIOD_NS)
    estimates = feed(odd, street, range(1, 30))
    assert all(error(e, street, t) < 10 for t, e in enumerate(estimates, start=1))


def test_one_stamp_ahead_drops_no_target_that_was_set_by_hand():
    street, hand = Street(), session()
    hand.set_target(street.box(0))
    estimates = feed_with_one_ahead(hand, street, 12, 3 * PERIOD_NS)
    assert all(estimates)
    assert hand.events == []


def test_one_stamp_ahead_after_dropped_images_costs_the_track_nothing():
    street = Street()
    of = session(street.box(0))
    feed(of, street, range(10))
    of.feed(street.frame(15), 16 * PERIOD_NS)
    of.feed(street.frame(16), 20 * PERIOD_NS)
    (estimate,) = feed(of, street, [17])
    assert of.events == ["the last image's stamp was ahead"]
    assert error(estimate, street, 17) < 10


def test_what_is_set_after_a_stamp_ahead_is_kept():
    street = Street()
    of = session(street.box(0))
    feed(of, street, range(10))
    of.feed(street.frame(10), 14 * PERIOD_NS)
    of.reconfigure(from_mapping(ApfParameters, {"num_particles": 50}), of.settings)
    (estimate,) = feed(of, street, [11])
    assert len(estimate.weights) == 50


def test_a_target_that_is_set_in_an_image_ahead_is_kept():
    street = Street()
    of = session()
    feed(of, street, range(10))
    of.set_target(street.box(10))
    of.feed(street.frame(10), 14 * PERIOD_NS)
    assert error(feed(of, street, [11, 12])[-1], street, 12) < 10


def test_two_stamps_ahead_that_agree_are_a_change():
    street = Street()
    of = session(street.box(0))
    feed(of, street, range(10))
    feed(of, street, [10, 11], offset=30)
    with pytest.raises(StrayImageError, match="goes back"):
        feed(of, street, [12])


def test_stray_sizes_cost_the_track_nothing():
    street = Street()
    strays = {
        t: [(other(20 + 7 * i + t), (t + 1) * PERIOD_NS) for i in range(3)] for t in (4, 5, 6, 20)
    }
    plain = feed(session(street.box(0)), street, range(30))
    assert positions(feed_with_strays(session(street.box(0)), street, strays)) == positions(plain)


def test_a_target_waits_for_an_image_of_the_stream():
    street, at_work = Street(), session()
    feed(at_work, street, range(3))
    at_work.set_target(street.box(3))
    with pytest.raises(StrayImageError, match="20x20 px among images of 200x120 px"):
        at_work.feed(other(), 4 * PERIOD_NS)
    assert feed(at_work, street, [3])[0].regime == "start"


def test_what_comes_back_from_a_gap_is_believed_at_the_second_image():
    street = Street(speed=0.0)
    at_work = Session(
        APF, from_mapping(ApfParameters, {"frame_rate": 25.0}), configured(street.box(0))
    )
    feed(at_work, street, range(5))
    with pytest.raises(StrayImageError, match=r"leaps ahead by 40\.0"):
        feed(at_work, street, [5], offset=1000)
    assert feed(at_work, street, [6], offset=1000)[0].regime != "start"
    assert at_work.events == ["gap in time"]
    feed(at_work, street, [7], offset=1000)
    assert at_work.events == []


def test_a_slow_camera_is_believed_after_its_second_image():
    street = Street(speed=0.0)
    at_work = session(street.box(0))
    answers = [believes(at_work, street, t, (t + 1) * PERIOD_NS) for t in range(0, 4000, 400)]
    assert answers == [True, False] + [True] * 8  # 16 s apart


def test_a_camera_without_a_clock_is_followed():
    street, at_work = Street(), session(Street().box(0))
    estimates = [at_work.feed(street.frame(t), 0) for t in range(20)]
    assert error(estimates[-1], street, 19) < 12


def test_a_clock_that_is_lost_starts_again_once():
    street, at_work = Street(speed=0.0), session(Street().box(0))
    feed(at_work, street, range(10))
    with pytest.raises(StrayImageError):
        at_work.feed(street.frame(10), 0)
    regimes = [at_work.feed(street.frame(t), 0).regime for t in range(11, 20)]
    assert regimes.count("start") == 0  # the image put aside was the one started on
    assert "repeated stamp" in at_work.events


def test_stamps_that_never_agree_are_counted_by_images():
    street, at_work = Street(speed=1.0), session(Street().box(0))
    feed(at_work, street, range(3))
    # A recording played backwards.
    answers = [believes(at_work, street, t, -t * DAY_NS) for t in range(3, 40)]
    assert answers == [False] * ODD_STAMP_PATIENCE + [True] * (37 - ODD_STAMP_PATIENCE)
    assert at_work.events == [StampEvent.UNUSABLE.value]
    # A stamp that continues the old ones is believed at once.
    estimate = feed(at_work, street, [40])[0]
    assert at_work.events == []
    assert estimate.regime != "start"
    assert error(estimate, street, 40) < 12


def test_a_reset_forgets_size_time_and_doubts():
    street, at_work = Street(), session(Street().box(0))
    feed(at_work, street, range(5), offset=1000)
    with pytest.raises(StrayImageError):
        feed(at_work, street, [0])
    at_work.set_target(Box(0, 0, 5, 5))
    at_work.reset()
    larger = np.pad(street.frame(0), ((0, 10), (0, 0), (0, 0)))
    estimate = at_work.feed(larger, 0)
    assert (estimate.regime, estimate.box) == ("start", street.box(0))


def test_reset_without_a_configured_target_waits():
    street, at_work = Street(), session()
    at_work.set_target(street.box(0))
    feed(at_work, street, range(3))
    at_work.reset()
    assert at_work.waiting
    assert feed(at_work, street, [3]) == [None]


def test_a_target_outside_is_refused_and_the_track_goes_on():
    street = Street()
    at_work = session(street.box(0))
    feed(at_work, street, range(4))
    at_work.set_target(Box(5000, 0, 10, 10))
    estimate = feed(at_work, street, [4])[0]
    assert "outside" in at_work.events[0]
    assert estimate.regime != "start"
    assert error(estimate, street, 4) < 10


def test_a_target_outside_without_a_track_is_refused_once_and_then_waited_for():
    street = Street()
    at_work = session(Box(5000, 0, 10, 10))
    with pytest.raises(InputError, match="outside"):
        feed(at_work, street, [0])
    assert at_work.waiting
    assert feed(at_work, street, [1]) == [None]


def test_a_target_outside_that_was_given_by_hand_leaves_the_configured_one():
    street = Street()
    at_work = session(street.box(0))
    at_work.set_target(Box(5000, 0, 10, 10))
    with pytest.raises(InputError, match="outside"):
        feed(at_work, street, [0])
    assert error(feed(at_work, street, [1])[0], street, 1) < 10


def test_a_new_image_size_starts_again_and_says_so():
    street = Street()
    at_work = session(street.box(0))
    feed(at_work, street, range(3))
    larger = [np.pad(street.frame(t), ((0, 10), (0, 0), (0, 0))) for t in range(3)]
    with pytest.raises(StrayImageError, match="200x130 px among images of 200x120 px"):
        at_work.feed(larger[0], 4 * PERIOD_NS)
    after = [at_work.feed(larger[1], 5 * PERIOD_NS)]
    assert at_work.size == (200, 130)
    assert "200x120 to 200x130" in at_work.events[0]
    after.append(at_work.feed(larger[2], 6 * PERIOD_NS))
    # The image put aside was the one started on, so nothing of its target is missed.
    fresh = session(street.box(0))
    alone = [fresh.feed(frame, (t + 4) * PERIOD_NS) for t, frame in enumerate(larger)]
    assert positions(after) == positions(alone[1:])


def test_a_refused_target_is_tried_again_in_images_of_another_size():
    street = Street()
    at_work = session(street.box(0))
    with pytest.raises(TargetError):
        at_work.feed(other(), -3 * PERIOD_NS)
    assert at_work.feed(other(), -2 * PERIOD_NS) is None
    with pytest.raises(StrayImageError):
        at_work.feed(street.frame(0), 0)
    after = feed(at_work, street, [1, 2])
    assert [estimate.mode for estimate in after] == [Mode.TRACKING] * 2
    assert error(after[-1], street, 2) < 5


def test_the_stamps_tell_the_tracker_how_long_a_second_is():
    street = Street(speed=0.0, hidden=(20, 999))
    at_work = Session(
        APF, from_mapping(ApfParameters, {"lost_after": 1.0}), configured(street.box(0))
    )
    modes = [e.mode for e in feed(at_work, street, range(60))]
    # 25 frames of 40 ms make a second.
    assert modes.index(Mode.LOST) == 44


def test_a_changed_target_parameter_starts_on_it_and_others_keep_the_track():
    street = Street()
    at_work = session(street.box(0))
    feed(at_work, street, range(4))
    at_work.reconfigure(
        from_mapping(ApfParameters, {"num_particles": 77}), configured(street.box(0))
    )
    kept = feed(at_work, street, [4])[0]
    assert (kept.regime != "start", len(kept.weights)) == (True, 77)
    at_work.reconfigure(ApfParameters(), configured(street.box(5)))
    assert feed(at_work, street, [5])[0].regime == "start"


def test_a_target_that_an_images_border_cuts_is_accepted():
    values = {"target.x": -10.0, "target.y": -5.0, "target.width": 24.0, "target.height": 30.0}
    assert from_mapping(SessionParameters, values).target.box.centre == (2.0, 10.0)


@pytest.mark.parametrize(("x", "y"), [(-50.0, 10.0), (10.0, -15.5)])
def test_a_target_outside_every_image_is_refused(x, y):
    with pytest.raises(InputError, match="centre outside every image"):
        from_mapping(
            SessionParameters,
            {"target.x": x, "target.y": y, "target.width": 24.0, "target.height": 30.0},
        )


@pytest.mark.parametrize("stamp", [1720000000.04, np.float64(2.0), "12", None])
def test_a_stamp_that_is_no_integer_is_refused_by_name(stamp):
    street = Street()
    with pytest.raises(InputError, match="stamp_ns is in nanoseconds; give round"):
        session(street.box(0)).feed(street.frame(0), stamp)


def test_integers_of_numpy_are_stamps():
    street = Street()
    of = session(street.box(0))
    estimates = [of.feed(street.frame(t), np.int64((t + 1) * PERIOD_NS)) for t in range(3)]
    expected = feed(session(street.box(0)), street, range(3))
    assert positions(estimates) == positions(expected)


@pytest.mark.parametrize("unit", [1, 10**3], ids=["ms", "µs"])
def test_stamps_in_another_unit_are_noticed(unit):
    street = Street()
    of = session(street.box(0))
    notices = []
    for time in range(3):
        of.feed(street.frame(time), 5 + 40 * time * unit)
        notices.append([event for event in of.events if "they are taken as ns" in event])
    assert [len(found) for found in notices] == [0, 1, 1]

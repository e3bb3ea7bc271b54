import numpy as np
import pytest
from street import Street, error

from vehicle_pf_tracker.features.box import Box
from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.trackers.apf_parameters import ApfParameters
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.parameters import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.session import Session, SessionParameters, TargetParameters

APF = VARIANTS["apf"]
PERIOD_NS = 40_000_000


def configured(box, **values):
    target = TargetParameters(box.x, box.y, box.width, box.height)
    return SessionParameters(target=target, **values)


def session(box=None, **values):
    settings = configured(box, **values) if box else SessionParameters(**values)
    return Session(APF, ApfParameters(), settings)


def feed(of, street, times, offset=0):
    return [of.feed(street.frame(t), (t + offset + 1) * PERIOD_NS) for t in times]


def positions(estimates):
    return [e.position if e else None for e in estimates]


def test_waits_until_there_is_a_target():
    street, waiting = Street(), session()
    assert waiting.waiting
    assert feed(waiting, street, range(3)) == [None] * 3
    waiting.set_target(street.box(3))
    started, *rest = feed(waiting, street, range(3, 8))
    assert started.regime == "start"
    assert not waiting.waiting
    assert error(rest[-1], street, 7) < 10


def test_frames_before_the_target_change_nothing_but_the_clock():
    street, late, prompt = Street(), session(), session(Street().box(0))
    feed(late, street, range(2), offset=-2)
    late.set_target(street.box(0))
    assert positions(feed(late, street, range(9))) == positions(feed(prompt, street, range(9)))


def test_a_recording_that_loops_gives_the_same_again():
    street = Street()
    looped = session(street.box(0))
    # Uneven times at first, which count as one period each until the period is known.
    times = [0, 2, 3, 6, *range(7, 30)]
    first = feed(looped, street, times)
    again = feed(looped, street, times)
    assert positions(again) == positions(first)


def test_the_jump_back_is_told_and_can_be_ridden_over():
    street = Street()
    steady = session(street.box(0), reset_on_time_jump=False)
    feed(steady, street, range(5), offset=100)
    estimate = feed(steady, street, range(5, 6), offset=0)[0]
    assert steady.events == ["time jumped back"]
    assert estimate.regime != "start"
    assert error(estimate, street, 5) < 10


def test_reset_goes_back_to_the_configured_target():
    street = Street()
    at_work = session(street.box(0))
    first = feed(at_work, street, range(6))
    at_work.set_target(Box(0, 0, 5, 5))
    at_work.reset()
    at_work.set_target(street.box(0))
    assert positions(feed(at_work, street, range(6))) == positions(first)


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


def test_a_new_image_size_starts_again_and_says_so():
    street = Street()
    at_work = session(street.box(0))
    feed(at_work, street, range(3))
    larger = np.pad(street.frame(3), ((0, 10), (0, 0), (0, 0)))
    estimate = at_work.feed(larger, 4 * PERIOD_NS)
    assert estimate.regime == "start"
    assert "200x120 to 200x130" in at_work.events[0]


def test_the_stamps_tell_the_tracker_how_long_a_second_is():
    street = Street(speed=0.0, hidden=(20, 999))
    at_work = Session(
        APF, from_mapping(ApfParameters, {"lost_after": 1.0}), configured(street.box(0))
    )
    modes = [e.mode for e in feed(at_work, street, range(60))]
    # 25 frames of 40 ms make a second.
    assert modes.index(Mode.LOST) == 44


def test_every_second_frame_gives_the_same_speed():
    street = Street(speed=2.0)
    at_work = Session(
        APF, from_mapping(ApfParameters, {"frame_rate": 25.0}), configured(street.box(0))
    )
    estimates = feed(at_work, street, range(0, 70, 2))
    assert np.mean([e.velocity[0] for e in estimates[15:]]) == pytest.approx(2.0, abs=0.4)


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


def test_a_target_may_be_set_one_parameter_after_the_other():
    settings = SessionParameters()
    for name, value in (("x", 5.0), ("y", 6.0), ("width", 7.0)):
        settings = from_mapping(SessionParameters, {f"target.{name}": value}, settings)
        assert settings.target.box is None
    settings = from_mapping(SessionParameters, {"target.height": 8.0}, settings)
    assert settings.target.box == Box(5, 6, 7, 8)


def test_a_target_below_a_pixel_is_refused():
    with pytest.raises(InputError, match=r"target\.width"):
        from_mapping(SessionParameters, {"target.width": 0.5, "target.height": 5.0})

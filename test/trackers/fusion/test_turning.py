"""Turns and what is none, as blobs before a still camera."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.history import Trend
from vehicle_pf_tracker.trackers.fusion.projective_motion import ProjectiveMotion
from vehicle_pf_tracker.trackers.fusion.turning import Turns

STREET = np.random.default_rng(0).integers(90, 100, (240, 320, 3), dtype=np.uint8)
SPEED = 3.0


def street(box=None, *, cover=None):
    """A vehicle that fills a box, behind what covers the columns from `cover` on."""
    frame = STREET.copy()
    if box is not None:
        left, top = round(box.x), round(box.y)
        frame[top : round(box.y + box.height), left : round(box.x + box.width)] = 200
    if cover is not None:
        frame[:, cover:] = STREET[:, cover:]
    return frame


def alike(pixels):
    return float((pixels > 150).mean())


def straight(t):
    return Box.around((40.0 + SPEED * t, 160.0), 40.0, 20.0)


def turning(t):
    """From frame 30 on it turns upwards within ten frames, and shows its narrow side."""
    if t <= 30:
        return straight(t)
    angle = min((t - 30) / 10, 1.0) * np.pi / 2
    x, y = straight(30).centre
    steps = np.minimum(np.arange(1, t - 29) / 10, 1.0) * np.pi / 2
    x, y = x + SPEED * np.cos(steps).sum(), y - SPEED * np.sin(steps).sum()
    side = np.sin(angle)
    return Box.around((x, y), 40.0 - 18 * side, 20.0 + 16 * side)


def driven(count=30):
    """Turns that have seen a straight drive."""
    turns = Turns()
    for t in range(count):
        box = straight(t)
        turns.watch(street(box), box, 1.0, still=True, seen=True)
        assert turns.notice(street(box), box, alike, clear=True) is None
    return turns


def test_a_turn_is_noticed_and_followed_to_its_end():
    turns, box = driven(), None
    for t in range(30, 70):
        truth = turning(t)
        frame = street(truth)
        turns.watch(frame, box or straight(t), 1.0, still=True, seen=True)
        if turns.active:
            found = turns.follow(frame, box, alike)
            assert found is not None
            box = found
        elif box is None:
            stuck = Box.around(truth.centre, 40.0, 20.0)  # its looks and its shape do not change
            box = turns.notice(frame, stuck, alike, clear=t <= 30)
        if box is not None:
            assert box.centre == pytest.approx(truth.centre, abs=4)
            last = t
            if not turns.active:
                break
    assert box is not None
    assert 40 < last < 60
    assert (box.width, box.height) == pytest.approx((22, 36), abs=3)


def test_a_vehicle_that_goes_straight_on_in_doubt_does_not_turn():
    turns = driven()
    for t in range(30, 45):
        box = straight(t)
        turns.watch(street(box), box, 1.0, still=True, seen=True)
        assert turns.notice(street(box), box, alike, clear=False) is None


def test_a_vehicle_that_is_being_covered_does_not_turn():
    turns = driven()
    for t in range(30, 50):
        frame = street(straight(t), cover=150)
        turns.watch(frame, straight(t), 1.0, still=True, seen=True)
        assert turns.notice(frame, straight(t), alike, clear=False) is None


def test_nothing_is_known_while_the_camera_moves():
    turns = driven()
    turns.watch(street(straight(30)), straight(30), 1.0, still=False, seen=True)
    assert turns.foreground is None
    assert turns.notice(street(turning(36)), straight(36), alike, clear=False) is None


def test_a_blob_that_is_lost_ends_the_turn():
    turns = driven()
    turns.begin(800.0)
    active = []
    for _ in range(3):
        assert turns.follow(street(), straight(30), alike) is None
        active.append(turns.active)
    assert active == [True, True, False]


def emerge(boxes, colour=alike):
    """First frame, and box, in which a vehicle that went straight to 130 is found again."""
    turns = driven()
    trend = Trend(ProjectiveMotion(straight(30).centre, (SPEED, 0.0), 1.0, 0.0), 0.0)
    emergence = Emergence(turns, 28.0)
    for t, box in enumerate(boxes):
        trend = trend.after(1.0)
        found = emergence.look(street(box), trend, 1.0, colour)
        if found is not None:
            return t, turns.box_of(found.blob), found.velocity
    return None


def behind_a_house(t):
    """Hidden for 20 frames, then it comes out upwards at x 150, from behind y 140."""
    bottom, top = 140.0, 140.0 - SPEED * (t - 20)
    if t <= 20:
        return None
    return Box(140.0, top, 22.0, min(bottom - top, 36.0))


def test_a_vehicle_that_comes_out_of_a_turn_is_found():
    t, box, velocity = emerge([behind_a_house(t) for t in range(60)])
    assert box.centre == pytest.approx(behind_a_house(t).centre, abs=2)
    assert velocity == pytest.approx((0.0, -SPEED), abs=0.5)
    assert t < 45


def test_other_colours_other_ways_and_blobs_of_before_are_not_the_target():
    assert emerge([behind_a_house(t) for t in range(60)], colour=lambda pixels: 0.2) is None
    ahead = [None] * 20 + [Box(150.0 + SPEED * t, 150.0, 40.0, 20.0) for t in range(35)]
    assert emerge(ahead) is None  # straight on is the search's
    before = [Box(140.0, 140.0 - SPEED * t, 22.0, 36.0) for t in range(30)]
    assert emerge(before) is None
    stands = [None] * 20 + [Box(140.0, 100.0, 22.0, 36.0)] * 30
    assert emerge(stands) is None

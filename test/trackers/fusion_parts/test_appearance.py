"""Cues of a target that is whole, half hidden and gone."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion_parameters import CueParameters
from vehicle_pf_tracker.trackers.fusion_parts.appearance import Appearance

SIZE = (30.0, 20.0)
CENTRE = (80.0, 60.0)


def street(x=80, hidden=0):
    """A textured vehicle of 30x20 px around (x, 60); its left `hidden` columns are covered."""
    frame = np.random.default_rng(0).normal(100, 6, (120, 160, 1)).repeat(3, axis=2)
    vehicle = np.random.default_rng(1).integers(0, 255, (5, 6, 3)).repeat(4, axis=0)
    frame[50:70, x - 15 : x + 15] = vehicle.repeat(5, axis=1)
    frame[45:75, x - 20 : x - 15 + hidden] = 60
    return np.clip(frame, 0, 255).astype(np.uint8)


def appearance(**cues):
    return Appearance(street(), CENTRE, SIZE, 24.0, CueParameters(**cues))


def look(one, frame, centre=CENTRE):
    return one.look(frame, centre, 1.0, (25.0, 20.0), (1 / 1.06, 1.0, 1.06))


def test_the_peak_is_where_the_target_went():
    one = appearance()
    view = look(one, street(x=91))
    peak = view.peaks(1, CENTRE, 1e6, 5.0)[0]
    assert peak.place == pytest.approx((91.0, 60.0), abs=1.0)
    assert peak.scale == pytest.approx(1.0, abs=0.07)


def test_particles_read_the_map_at_their_places_and_sizes():
    view = look(appearance(), street(x=91))
    places = np.array([[91.0, 60.0], [94.0, 60.0], [80.0, 60.0]])
    near, beside, before = view.fused(places, np.ones(3))
    assert near > beside > before
    larger = view.fused(places[:1], np.array([1.06]))[0]
    between = view.fused(places[:1], np.array([1.03]))[0]
    assert min(near, larger) < between < max(near, larger)


def test_half_of_the_target_is_still_alike_by_its_parts():
    one = appearance()
    whole = one.compare(look(one, street()), CENTRE, 1.0)
    half = one.compare(look(one, street(hidden=15)), CENTRE, 1.0)
    gone = one.compare(look(one, street(hidden=32)), CENTRE, 1.0)
    assert whole.template > 0.95
    assert half.part > 0.9
    assert half.whole < 0.8
    assert gone.template < 0.4
    without = appearance(parts=False)
    assert without.compare(look(without, street(hidden=15)), CENTRE, 1.0).part < 0.8


def test_a_cue_that_does_not_tell_the_target_from_its_surroundings_loses_weight():
    # Colours that are all around: the template alone tells.
    frame = street()
    frame[:] = frame.mean(axis=2, keepdims=True).astype(np.uint8)
    frame[20:48] = frame[50:70].repeat(2, axis=0)[:28]
    frame[72:110] = frame[50:70].repeat(2, axis=0)[:38]
    one = Appearance(frame, CENTRE, SIZE, 24.0, CueParameters())
    before = one.weights.copy()
    for _ in range(20):
        one.weigh_cues(look(one, frame), CENTRE, 1.0)
    assert one.weights[2] < before[2]
    assert one.weights.sum() == pytest.approx(1.0)


def test_what_waits_to_be_learnt_can_be_forgotten():
    one, other = appearance(), appearance()
    strange = look(one, street(hidden=32))
    for _ in range(3):
        one.learn(strange, CENTRE, 1.0, 0.5, delay=6)
    one.forget_pending()
    for _ in range(6):
        one.learn(look(one, street()), CENTRE, 1.0, 0.5, delay=6)
    seen = look(one, street())
    assert one.compare(seen, CENTRE, 1.0).following == pytest.approx(
        other.compare(seen, CENTRE, 1.0).following, abs=1e-6
    )


def test_without_delay_the_following_template_follows():
    one = appearance()
    frame = np.ascontiguousarray(street()[:, ::-1])  # the vehicle seen from its other side
    changed = look(one, frame)
    before = one.compare(changed, CENTRE, 1.0).following
    for _ in range(10):
        one.learn(changed, CENTRE, 1.0, 0.3, delay=0)
    after = one.compare(changed, CENTRE, 1.0)
    assert before < 0.6
    assert after.following > 0.9
    assert after.anchor == pytest.approx(before, abs=1e-6)

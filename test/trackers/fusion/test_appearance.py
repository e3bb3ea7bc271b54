"""Cues of a target that is whole, half hidden and gone."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.parameters import CueParameters

SIZE = (30.0, 20.0)
CENTRE = (80.0, 60.0)
STEPS = (1 / 1.06, 1.0, 1.06)


def street(x=80, hidden=0):
    """A textured vehicle of 30x20 px around (x, 60); its left `hidden` columns are covered."""
    frame = np.random.default_rng(0).normal(100, 6, (120, 160, 1)).repeat(3, axis=2)
    vehicle = np.random.default_rng(1).integers(0, 255, (5, 6, 3)).repeat(4, axis=0)
    frame[50:70, x - 15 : x + 15] = vehicle.repeat(5, axis=1)
    frame[45:75, x - 20 : x - 15 + hidden] = 60
    return np.clip(frame, 0, 255).astype(np.uint8)


def appearance(**cues):
    return Appearance(street(), CENTRE, SIZE, CueParameters(**cues))


def look(one, frame, centre=CENTRE):
    return one.look(frame, centre, 1.0, 22.0, STEPS)


def test_the_peak_is_where_the_target_went():
    view = look(appearance(), street(x=91))
    peak = view.best(CENTRE, 1e6, (160, 120))
    assert peak.place == pytest.approx((91.0, 60.0), abs=1.0)
    assert peak.scale == pytest.approx(1.0, abs=0.07)


def test_the_target_itself_is_wholly_alike_and_gone_it_is_not():
    one = appearance()
    there, gone = (one.compare(look(one, street(hidden=h)), CENTRE, 1.0) for h in (0, 32))
    assert min(there.anchor, there.following) > 0.95
    assert there.colour > 0.8
    assert max(gone.anchor, gone.following) < 0.4
    assert gone.colour < 0.4


def test_half_of_the_target_is_still_alike_by_its_best_half():
    one = appearance()
    half, gone = (look(one, street(hidden=h)) for h in (15, 32))
    assert one.compare(half, CENTRE, 1.0).following < 0.8
    assert one.best_half(half, CENTRE, 1.0) > 0.9
    assert one.best_half(gone, CENTRE, 1.0) < 0.6
    without = appearance(parts=False)
    assert without.best_half(look(without, street(hidden=15)), CENTRE, 1.0) == 0


def test_a_half_beside_the_region_is_not_alike():
    one = appearance()
    assert one.best_half(look(one, street()), (2.0, 2.0), 1.0) == 0


def test_neighbouring_sizes_differ():
    one = appearance()
    view = one.look(street(), CENTRE, 1.0, 22.0, tuple(1.02**step for step in range(-3, 4)))
    centre = np.array([CENTRE]).repeat(7, axis=0)
    values = view.read(view.cues[:1], centre, view.scales)[0]
    assert int(values.argmax()) == 3
    assert len(set(values.tolist())) == 7


def test_a_cue_that_does_not_tell_the_target_from_its_surroundings_loses_weight():
    # Colours that are all around: the template alone tells.
    frame = street()
    frame[:] = frame.mean(axis=2, keepdims=True).astype(np.uint8)
    frame[20:48] = frame[50:70].repeat(2, axis=0)[:28]
    frame[72:110] = frame[50:70].repeat(2, axis=0)[:38]
    one = Appearance(frame, CENTRE, SIZE, CueParameters())
    before = one.weights.copy()
    for _ in range(20):
        one.weigh_cues(look(one, frame), CENTRE, 1.0)
    assert one.weights[2] < before[2]
    assert one.weights.sum() == pytest.approx(1.0)


def test_cues_that_are_off_have_no_weight():
    assert appearance(colour=False).weights == pytest.approx([1 / 3, 2 / 3, 0])
    assert appearance(anchor=False, following=False).weights == pytest.approx([0, 0, 1])


def test_the_following_template_follows_and_the_anchor_stays():
    one = appearance()
    frame = np.ascontiguousarray(street()[:, ::-1])  # the vehicle seen from its other side
    changed = look(one, frame)
    before = one.compare(changed, CENTRE, 1.0)
    for _ in range(10):
        one.learn(changed, CENTRE, 1.0, 0.3)
    after = one.compare(look(one, frame), CENTRE, 1.0)
    assert before.following < 0.6
    assert after.following > 0.9
    assert after.anchor == pytest.approx(before.anchor, abs=1e-6)


def test_colours_are_learnt_every_fourth_frame():
    one = appearance(colour_rate=0.5)
    frame = street()
    frame[50:70, 65:95] = 255 - frame[50:70, 65:95]
    shares = []
    for _ in range(4):
        one.learn_colours(look(one, frame), CENTRE, 1.0)
        shares.append(one.compare(look(one, frame), CENTRE, 1.0).colour)
    assert shares[0] == shares[1] == shares[2]
    assert shares[3] > shares[2] + 0.1


def test_another_shape_has_its_own_templates_and_mostly_the_old_colours():
    one = appearance()
    other = one.reshaped(street(), (80.0, 60.0), (16.0, 24.0))
    assert other.size == (16.0, 24.0)
    view = other.look(street(), (80.0, 60.0), 1.0, 12.0, (1.0,))
    assert other.compare(view, (80.0, 60.0), 1.0).anchor > 0.95
    vehicle = street()[50:70, 65:95]
    assert other.mean_share(vehicle) == pytest.approx(one.mean_share(vehicle), abs=0.1)
    assert one.mean_share(vehicle) > 0.8
    assert one.mean_share(street()[:20]) < 0.2

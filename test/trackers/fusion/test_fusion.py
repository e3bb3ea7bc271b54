"""The flagship on scenes: scale, camera, occlusions, look-alikes."""

import math

import numpy as np
import pytest
from street import Street, error, follow

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.tracker import FusionTracker


def fusion(**values):
    return FusionTracker(from_mapping(FusionParameters, values))


def run(scene, **values):
    """Estimates and truths of a made scene from its second frame on."""
    tracker, estimates, truths = fusion(**values), [], []
    for one in scene.frames():
        if not truths:
            estimates.append(tracker.start(one.frame, one.truth.box))
        else:
            estimates.append(tracker.step(one.frame))
        truths.append(one.truth)
    return estimates[1:], truths[1:]


def distance(estimate, truth):
    return math.dist(estimate.position, truth.box.centre)


def test_follows_the_size_of_a_vehicle_that_drives_away():
    estimates, truths = run(make_scene("scale", seed=3))
    assert np.median([distance(*pair) for pair in zip(estimates, truths, strict=True)]) < 2
    assert estimates[-1].box.width == pytest.approx(truths[-1].box.width, rel=0.25)


@pytest.mark.parametrize("name", ["bridge", "bus"])
def test_comes_back_from_total_occlusions_and_says_when_it_was_hidden(name):
    back = 0
    for seed in (4, 5, 6):
        estimates, truths = run(make_scene(name, seed=seed))
        pairs = list(zip(estimates, truths, strict=True))
        hidden = [estimate.mode for estimate, truth in pairs if truth.occlusion is Occlusion.TOTAL]
        assert sum(mode is not Mode.TRACKING for mode in hidden) >= 0.8 * len(hidden)
        back += estimates[-1].mode is Mode.TRACKING and distance(*pairs[-1]) < 8
    assert back >= 2


@pytest.mark.parametrize("name", ["turn", "turn_occluded"])
def test_follows_a_turn_and_finds_a_vehicle_behind_one(name):
    ends = []
    for seed in (4, 5):
        estimates, truths = run(make_scene(name, seed=seed))
        ends.append(estimates[-1].mode is Mode.TRACKING and distance(estimates[-1], truths[-1]) < 8)
    assert all(ends)


def test_never_claims_a_twin():
    estimates, truths = run(make_scene("twin", seed=3))
    assert max(distance(*pair) for pair in zip(estimates, truths, strict=True)) < 10


def test_a_camera_that_pans_is_followed_while_the_vehicle_is_hidden():
    texture = np.random.default_rng(0).integers(60, 140, (30, 80, 3)).astype(np.uint8)
    world = texture.repeat(8, axis=0).repeat(8, axis=1)
    vehicle = np.random.default_rng(1).integers(0, 255, (5, 8, 3)).astype(np.uint8)
    vehicle = vehicle.repeat(5, axis=0).repeat(5, axis=1)
    ends = []
    for camera in (True, False):
        tracker = fusion(**{"motion.camera": camera})
        for t in range(45):
            picture, left, pan = world.copy(), 120 + 2 * t, max(t - 22, 0) * 6
            if not 25 <= t < 35:
                picture[100:125, left : left + 40] = vehicle
            frame = np.ascontiguousarray(picture[:, pan : pan + 320])
            box = Box(left - pan, 100, 40, 25)
            estimate = tracker.start(frame, box) if t == 0 else tracker.step(frame)
        ends.append(math.dist(estimate.position, box.centre))
    assert ends[0] < 6
    assert ends[1] > ends[0]


def test_goes_back_to_the_confident_frames_when_it_loses_sight():
    street, times = Street(speed=2.0, hidden=(20, 30)), range(50)
    estimates = follow(fusion(), street, times)
    inside = [error(e, street, t) for e, t in zip(estimates, times, strict=True) if 20 <= t < 30]
    assert max(inside) < 6
    assert estimates[-1].mode is Mode.TRACKING
    assert error(estimates[-1], street, 49) < 3


@pytest.mark.parametrize(
    "off",
    [
        "cues.anchor", "cues.following", "cues.colour", "cues.parts", "cues.adaptive",
        "motion.camera", "motion.scale", "hiding.retrospect", "hiding.projective",
        "hiding.drift", "hiding.gate", "hiding.search", "hiding.background", "hiding.turns",
        "cues.alignment",
    ],
)  # fmt: skip
def test_works_with_each_part_switched_off(off):
    street = Street(speed=2.0)
    estimates = follow(fusion(**{off: False}), street, range(30))
    assert error(estimates[-1], street, 29) < 6

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What comes out beside the path of a hidden vehicle: the vehicle itself, or a stranger."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from fusion_samples import fusion

from laboratory.scenes import make_scene
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting

SIZE = np.array([20.0, 12.0])
LAST = np.array([100.0, 120.0])
MOTION = PerspectiveMotion(LAST, np.array([3.0, 0.0]), 0.0)
IMAGE = np.array([320.0, 200.0])
OUT = np.array([140.0, 80.0])
"""Where it comes out, 20 frames later, on its way up."""


def sides(*boxes):
    """Bounding boxes of what is inside the image."""
    corners = [((x - w / 2, y - h / 2), (x + w / 2, y + h / 2)) for x, y, w, h in boxes]
    return np.clip(np.array(corners).reshape(-1, 2, 2), 0, IMAGE)


def coming_out(time, speed=3.0, size=(12, 14)):
    """Box of the part that shows above the roof that it comes out from."""
    bottom = OUT[1] - speed * (time - 20) + size[1]
    top, low = bottom - size[1], min(bottom, OUT[1])
    return [] if time < 20 else [(OUT[0], (top + low) / 2, size[0], low - top)]


def run(others=lambda time: [], earlier=(), out=coming_out, dropped=()):
    """Frame in which the vehicle is proven, and what was given; None if it never is."""
    before = [(ago, sides(*boxes)) for ago, boxes in earlier]
    emergence = Emergence(Sighting(0.0, LAST, SIZE), MOTION, IMAGE)
    if not emergence.was_alone(before):
        return None
    times = [time for time in range(60) if time not in dropped]
    for last, time in itertools.pairwise(times):
        boxes = sides(*out(time), *others(time))
        emergence = emergence and emergence.observed(boxes, float(time - last))
        found = emergence and emergence.proven()
        if found is not None:
            return time, found
    return None


def test_a_single_vehicle_that_comes_out_beside_the_path_is_found():
    time, (box, velocity) = run(earlier=[(0.0, [(*LAST, *SIZE)]), (10.0, [(70, 120, *SIZE)])])
    assert 27 <= time <= 32
    assert box.mean(axis=0)[0] == pytest.approx(OUT[0], abs=1)
    assert velocity == pytest.approx([0.0, -3.0], abs=0.5)


def test_dropped_frames_do_not_make_it_slower_or_faster():
    # The last interval is twice as long as those before, or all but the last are.
    for dropped in ({26}, {23, 25, 27}):
        _, (_, velocity) = run(dropped=dropped)
        assert velocity == pytest.approx([0.0, -3.0], abs=0.5)


def test_its_own_outline_of_before_is_no_other_vehicle():
    """The last clear sighting is five frames old: ten frames ago it was five before that."""
    emergence = Emergence(Sighting(5.0, LAST, SIZE), MOTION, IMAGE)
    assert emergence.was_alone([(10.0, sides((85 - 11, 120, *SIZE)))])
    assert not emergence.was_alone([(10.0, sides((85 - 45, 120, *SIZE)))])


@pytest.mark.parametrize(
    "options",
    [
        {"earlier": [(20.0, [(40, 120, *SIZE), (110, 90, 14, 12)])]},
        {"others": lambda time: [(3 * time, 60, 20, 12)] if time < 15 else []},
        {"others": lambda time: [(200, 60, 20, 12)] if time > 20 else []},
        {"out": lambda time: [(2 * (time - 20), 60, 20, 12)] if time > 20 else []},
        {"out": lambda time: coming_out(time, size=(40, 40))},
        {"out": lambda time: coming_out(time, speed=0.5)},
        {"out": lambda time: coming_out(time + 18)},
        {"out": lambda time: coming_out(time) if time % 4 else []},
    ],
    ids=[
        "another was there before", "another goes by", "another comes out too", "by the border",
        "too large", "too slow", "too early to be there", "flickers",
    ],
)  # fmt: skip
def test_what_may_be_another_vehicle_is_not_taken(options):
    assert run(**options) is None


def test_paint_is_judged_over_all_frames():
    emergence, differences = Emergence(Sighting(0.0, LAST, SIZE), MOTION, IMAGE), (1.5, 0.9, 0.5)
    alike = [emergence._replace(paint=differences[:count]).has_paint for count in (1, 2, 3)]
    assert alike == [False, False, True]


@pytest.fixture(scope="module")
def turn_behind_a_house():
    return list(make_scene("turn_occluded", seed=0).frames())


def tracked(frames):
    tracker = fusion(seed=0)
    estimates = [tracker.start(frames[0].frame, frames[0].truth.box)]
    return estimates + [tracker.step(each.frame, 1.0) for each in frames[1:]]


def repainted(scene_frame):
    """The same frame with another vehicle where the target was: what was brown is green."""
    frame, box = scene_frame.frame.copy(), scene_frame.truth.box
    rows = slice(int(box.y) - 3, int(box.y + box.height) + 4)
    columns = slice(int(box.x) - 3, int(box.x + box.width) + 4)
    frame[rows, columns] = frame[rows, columns][..., [2, 0, 1]]
    return replace(scene_frame, frame=frame)


def test_a_car_that_turns_behind_a_house_is_found_again(turn_behind_a_house):
    estimates = tracked(turn_behind_a_house)
    x, y = turn_behind_a_house[-1].truth.box.centre
    assert estimates[-1].mode is Mode.TRACKING
    assert np.hypot(estimates[-1].position[0] - x, estimates[-1].position[1] - y) < 12


def test_a_car_of_another_paint_that_comes_out_there_is_not_taken(turn_behind_a_house):
    hidden = [each.truth.occlusion is Occlusion.TOTAL for each in turn_behind_a_house]
    first = hidden.index(True)
    frames = [
        repainted(each) if number > first else each
        for number, each in enumerate(turn_behind_a_house)
    ]
    modes = [estimate.mode for estimate in tracked(frames)]
    assert not any(mode is Mode.TRACKING for mode in itertools.islice(modes, first, None))

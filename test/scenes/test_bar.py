# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The artificial video: geometry by hand, and pixels against truth."""

import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.scenes.catalogue import make_scene


def occlusions(**values):
    return [truth.occlusion for truth in make_scene("bar", settings=values).truths()]


def hidden_frames(**values):
    truths = make_scene("bar", settings=values).truths()
    return sum(truth.visible_fraction == 0 for truth in truths)


@pytest.mark.parametrize(
    ("width", "speed", "frames"),
    # The vehicle's left edge is at 20 + speed * i. It is hidden from the bar's left edge on, at
    # 320 - width // 2, for `width` - 40 px: from 290 to 310 for width 60, five steps of 5 px.
    [
        (30, 5, 0),
        (40, 5, 1),
        (60, 5, 5),
        (90, 5, 11),
        (120, 5, 17),
        (120, 10, 9),
        (120, 16, 6),
        (120, 17, 4),
    ],
)
def test_number_of_wholly_hidden_frames_by_hand(width, speed, frames):
    assert hidden_frames(width=width, speed=speed) == frames


@given(st.integers(50, 120), st.floats(1, 12), st.integers(10, 48))
@settings(max_examples=30)
def test_number_of_wholly_hidden_frames_is_the_free_room_over_the_speed(width, speed, vehicle):
    frames = hidden_frames(width=width, speed=speed, vehicle_width=vehicle)
    room = (width - vehicle) / speed
    # Room for a whole number of steps may come out a rounding error short of it.
    assert math.floor(room - 1e-9) <= frames <= math.floor(room + 1e-9) + 1


def test_positions_are_exact():
    boxes = [truth.box for truth in make_scene("bar", settings=["speed=3.7"]).truths()]
    centres = np.array([box.centre for box in boxes])
    np.testing.assert_allclose(centres[:, 0], 40 + 3.7 * np.arange(len(boxes)), atol=1e-9)
    np.testing.assert_allclose(centres[:, 1], 240, atol=1e-12)
    assert {(round(box.width, 9), round(box.height, 9)) for box in boxes} == {(40, 30)}
    assert boxes[-1].x + 40 <= 620 < boxes[-1].x + 40 + 3.7


@pytest.mark.parametrize("width", [10, 30, 60, 90, 120])
def test_vehicle_is_clear_before_and_after_the_bar(width):
    seen = occlusions(width=width)
    first = next(i for i, state in enumerate(seen) if state is not Occlusion.NONE)
    last = max(i for i, state in enumerate(seen) if state is not Occlusion.NONE)
    assert first >= 25
    assert len(seen) - 1 - last >= 30


def test_width_zero_means_no_bar():
    assert set(occlusions(width=0)) == {Occlusion.NONE}


def test_paper_rate_size_and_stamps():
    scene = make_scene("bar")
    first, second = islice(scene.frames(), 2)
    assert (scene.width, scene.height, scene.frame_rate, scene.frame_count) == (640, 480, 15, 113)
    assert first.frame.shape == (480, 640, 3)
    assert first.frame.dtype == np.uint8
    assert (first.truth.stamp_ns, second.truth.stamp_ns) == (1_000_000_000, 1_066_666_667)


def test_bar_is_dark_and_as_wide_as_asked():
    frame = next(make_scene("bar", settings=["width=31", "noise=0"]).frames()).frame
    dark = np.flatnonzero((frame < 60).all(axis=(0, 2)))
    assert (dark[0], dark[-1], dark.size) == (305, 335, 31)


def test_pixels_move_as_the_truth_says():
    """Centre of mass of what differs from the empty road, against the frame before's."""
    scene = make_scene("bar", settings=["width=0", "noise=0", "speed=4.3"])
    empty = scene.backdrop()
    rows, columns = np.indices(empty.shape[:2]) + 0.5
    offsets = []
    for shot in islice(scene.frames(), 0, 40, 4):
        light = np.abs(shot.frame - empty).sum(axis=2)
        light[light < 6] = 0
        mass = np.array([(light * columns).sum(), (light * rows).sum()]) / light.sum()
        offsets.append(mass - shot.truth.box.centre)
    np.testing.assert_allclose(offsets, np.broadcast_to(offsets[0], (10, 2)), atol=0.1)
    assert np.abs(offsets).max() < 2.5


def test_box_is_tight_around_the_pixels():
    scene = make_scene("bar", settings=["width=0", "noise=0"])
    changed = np.abs(next(scene.frames()).frame - scene.backdrop()).max(axis=2) > 6
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    assert (columns[0], columns[-1], rows[0], rows[-1]) == (20, 59, 225, 254)


def test_target_has_several_colours():
    """At least eight of the 512 bins of an RGB histogram hold two hundredths of the box."""
    frame = next(make_scene("bar", settings=["noise=0"]).frames()).frame[225:255, 20:60]
    bins = (frame // 32).reshape(-1, 3) @ (64, 8, 1)
    assert (np.bincount(bins, minlength=512) >= 0.02 * bins.size).sum() >= 8


def test_visible_fraction_matches_the_pixels():
    """The share of the vehicle's changed pixels that survives the bar, away from its own edges."""
    free = make_scene("bar", settings=["width=0", "noise=0"])
    barred = make_scene("bar", settings=["width=60", "noise=0"])
    empty = free.backdrop()
    for open_road, behind in islice(zip(free.frames(), barred.frames(), strict=True), 46, 68):
        vehicle = np.abs(open_road.frame - empty).max(axis=2) > 6
        same = (open_road.frame == behind.frame).all(axis=2)
        share = (vehicle & same).sum() / vehicle.sum()
        assert behind.truth.visible_fraction == pytest.approx(share, abs=0.02)

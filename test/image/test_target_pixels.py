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

"""Doubts about targets."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.target_pixels import PATIENCE, Stillness, contrast, doubts


@pytest.fixture
def frame():
    """Asphalt with noise, and a striped vehicle on it."""
    rng = np.random.default_rng(0)
    image = np.clip(rng.normal(110, 6, (120, 160, 1)), 0, 255).astype(np.uint8).repeat(3, axis=2)
    image[40:60, 40:70] = (40, 60, 160)
    image[44:50, 45:65] = (220, 220, 230)
    return image


def test_a_vehicle_raises_no_doubts(frame):
    assert doubts(frame, Box(40, 40, 30, 20)) == []


@pytest.mark.parametrize(
    ("box", "words"),
    [
        (Box(45, 44, 5, 8), "it is only 5 x 8 px large"),
        (Box(0, 0, 120, 110), "it covers 69% of the image"),
        (Box(90, 70, 40, 30), "nothing in it stands out"),
        (Box(-10, 90, 40, 30), "nothing in it stands out"),
    ],
)
def test_what_speaks_against_a_target(frame, box, words):
    (found,) = doubts(frame, box)
    assert words in found


def test_a_box_beyond_the_image_has_no_pixels_to_doubt(frame):
    assert doubts(frame, Box(400, 400, 20, 20)) == []


def test_a_patch_whose_contrast_is_known():
    """Two halves of 100 and 120 have a standard deviation of 10, less what smoothing takes."""
    frame = np.full((80, 80, 3), 100, np.uint8)
    frame[:, 40:] = 120
    assert contrast(frame, Box(20, 20, 40, 40)) == pytest.approx(10, abs=0.5)
    assert contrast(np.full((80, 80, 3), 100, np.uint8), Box(20, 20, 40, 40)) == 0


RATE = 10
TARGET = Box(200.0, 100.0, 40.0, 30.0)
NOISE = np.random.default_rng(1)


def street(seconds, others=True):
    """Frame of a noisy camera with a vehicle that drives through in ten seconds."""
    frame = np.full((240, 320, 3), 90, np.uint8)
    frame += NOISE.integers(0, 30, frame.shape, np.uint8)
    if others:
        frame[180:200, int(28 * seconds) : int(28 * seconds) + 30] = 220
    return frame


def watch(seconds, box_at, **options):
    """Whether the target is suspect, for each image."""
    still = Stillness()
    still.begin(TARGET, 0)
    said = []
    for index in range(int(seconds * RATE)):
        frame = street(index / RATE, **options)
        still.look(frame, box_at(index / RATE), index * 10**9 // RATE)
        said.append(still.is_suspect)
    return still, said


def shifted(way):
    return Box(TARGET.x + way, TARGET.y, TARGET.width, TARGET.height)


def test_a_target_that_stays_while_others_drive_is_suspect_after_some_seconds():
    still, said = watch(8, lambda seconds: shifted(np.sin(seconds)))
    assert said.index(True) == PATIENCE * RATE
    assert all(said[said.index(True) :])
    assert still.moved < 2


def test_where_nothing_else_moves_nothing_is_suspected():
    _, said = watch(8, lambda seconds: TARGET, others=False)
    assert not any(said)


def test_the_target_s_own_movement_is_no_other_s():
    def own(seconds):
        frame = street(0.0, others=False)
        frame[100:130, 200:240] = 20 + 12 * int(2 * seconds)
        return frame

    still = Stillness()
    still.begin(TARGET, 0)
    for index in range(8 * RATE):
        still.look(own(index / RATE), TARGET, index * 10**9 // RATE)
    assert not still.is_suspect


@pytest.mark.parametrize("speed", [10.0, -30.0])
def test_a_car_that_parks_after_it_drove_is_not_suspect(speed):
    _, said = watch(12, lambda seconds: shifted(speed * min(seconds, 4.0)))
    assert not any(said)


def test_a_car_that_sets_off_late_is_suspect_no_more():
    _, said = watch(12, lambda seconds: shifted(20.0 * max(seconds - 6.0, 0.0)))
    assert any(said)
    assert not said[-1]


def test_a_new_target_begins_anew():
    still, _ = watch(8, lambda seconds: TARGET)
    still.begin(TARGET, 8 * 10**9)
    assert (still.moved, still.is_suspect) == (0.0, False)

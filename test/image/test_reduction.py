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

"""Large windows are measured in every k-th pixel, and positions stay where they are."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.window import Window
from vehicle_pf_tracker.trackers.papers.hpfms import MOST_PIXELS, Reduction
from vehicle_pf_tracker.trackers.registry import VARIANTS


@pytest.mark.parametrize(
    ("size", "step"),
    [((24, 18), 1), ((315, 317), 1), ((317, 317), 2), ((1920, 1080), 5), ((3840, 2160), 10)],
)
def test_as_few_pixels_are_left_out_as_need_be(size, step):
    window = Window.of_size(*size)
    reduction = Reduction.of_window(window)
    assert reduction.step == step
    small = reduction.window(window)
    assert small.width * small.height <= 1.01 * MOST_PIXELS


def test_nothing_changes_where_nothing_is_left_out():
    frame, positions = np.zeros((9, 9, 3), np.uint8), np.array([[1.25, 3.5]])
    same = Reduction()
    assert same.frame(frame) is frame
    assert same.positions(positions) is same.back(positions) is positions
    assert same.window(Window(3, 4)) == Window(3, 4)


@pytest.mark.parametrize("step", [2, 3, 5])
def test_positions_point_at_the_same_pixel(step):
    frame = np.arange(60 * 60 * 3, dtype=np.uint32).reshape(60, 60, 3)
    reduction = Reduction(step)
    for x, y in ((0, 0), (step, 3 * step), (4 * step, step)):
        there = reduction.positions(np.array([x + 0.5, y + 0.5]))
        column, row = (int(value - 0.5) for value in there)
        assert np.array_equal(reduction.frame(frame)[row, column], frame[y, x])
        assert np.allclose(reduction.back(there), (x + 0.5, y + 0.5))


def test_hpfms_follows_a_vehicle_of_half_the_image():
    """Of 960x540 px, 2 px apart for its histograms; the error is that of a small one, in parts."""
    rng = np.random.default_rng(5)
    road = rng.integers(90, 130, (1080, 1920, 3), np.uint8)
    vehicle = np.kron(rng.integers(0, 255, (9, 16, 3)), np.ones((60, 60, 1))).astype(np.uint8)
    tracker = VARIANTS["hpfms"].tracker(VARIANTS["hpfms"].parameters())
    errors = []
    for number in range(12):
        x, y = 400 + 8 * number, 250
        frame = road.copy()
        frame[y : y + 540, x : x + 960] = vehicle
        if number == 0:
            tracker.start(frame, Box(x, y, 960, 540))
            continue
        estimate = tracker.step(frame, 1.0)
        errors.append(np.hypot(estimate.position[0] - x - 480, estimate.position[1] - y - 270))
    assert max(errors) < 0.02 * 960

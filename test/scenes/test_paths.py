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

"""Paths, by hand numbers."""

import math

import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.models import Attached, Driven, Still, Straight, Wave

START = Box(10, 20, 4, 3)


def test_still_and_straight():
    assert Still(START)(7) == START
    assert Straight(START, (2.5, -1))(4) == Box(20, 16, 4, 3)


def test_wave_is_a_sine_of_the_frame():
    wave = Wave(amplitude=2, period=40, phase=0)
    assert [wave(frame) for frame in (0, 10, 20, 30)] == pytest.approx([0, 2, 0, -2], abs=1e-12)
    assert Wave(2, 40, math.pi / 2)(0) == pytest.approx(2)


def test_driven_adds_its_swings_to_the_course():
    path = Driven(Straight(START, (1, 0)), Wave(2, 40, 0), Wave(0.5, 20, math.pi / 2))
    box = path(10)
    assert (box.x, box.y) == pytest.approx((10 + 10 + 2, 20 - 0.5))
    assert (box.width, box.height) == (4, 3)


def test_attached_keeps_its_offset_and_its_own_size():
    assert Attached(Straight(START, (1, 0)), (-3, 2), (8, 1))(5) == Box(12, 22, 8, 1)

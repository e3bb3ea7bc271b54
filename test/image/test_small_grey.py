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

"""Frames made small and grey."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.small_grey import small_grey


def test_small_frames_keep_their_size():
    frame = np.random.default_rng(0).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    small = small_grey(frame)
    assert small.zoom == 1
    assert small.image.shape == (24, 32)


@pytest.mark.parametrize(("shape", "expected"), [((480, 640), (240, 320)), ((900, 30), (320, 11))])
def test_larger_ones_shrink_to_320_px(shape, expected):
    small = small_grey(np.full((*shape, 3), 77, np.uint8))
    assert small.image.shape == expected
    assert small.zoom == pytest.approx(320 / max(shape))
    assert (small.image == 77).all()

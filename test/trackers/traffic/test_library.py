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

"""Many vehicles from Python, as docs/traffic.md shows it."""

import re
from pathlib import Path

import numpy as np
import pytest

from vehicle_pf_tracker import TrafficTracker
from vehicle_pf_tracker.core.errors import InputError

PAGE = Path(__file__).parents[3] / "docs" / "traffic.md"
GROUND = np.random.default_rng(0).integers(90, 130, (240, 320, 3)).astype(np.uint8)


def drive(frames=60, first=0):
    """Images of two vehicles that drive to the right, with their boxes, scores and classes."""
    for index in range(first, first + frames):
        boxes = [(10 + 4 * index, 60, 40, 30), (30 + 3 * index, 150, 50, 36)]
        frame = GROUND.copy()
        for shade, (x, y, w, h) in zip((20, 230), boxes, strict=True):
            frame[y : y + h, x : x + w] = shade
        yield frame, boxes, [0.9, 0.8], ["car", "bus"]


def test_the_example_of_the_page_prints_each_vehicle(capsys):
    (example,) = re.findall(
        r"```py\n(from vehicle_pf_tracker import T.*?)```", PAGE.read_text(), re.S
    )
    exec(example, {"camera": drive()})
    words = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert {(line[0], line[-1]) for line in words} == {("1", "car"), ("2", "bus")}
    assert {line[-3] for line in words} == {"TRACKING"}


def test_without_boxes_what_moves_is_followed():
    tracker = TrafficTracker(frame_rate=25)
    for frame in [GROUND] * 25:
        assert tracker.update(frame) == ()
    for frame, *_ in drive(40):
        tracks = tracker.update(frame)
    assert sorted(track.id for track in tracks) == [1, 2]
    assert tracks[0].box.centre == pytest.approx((10 + 4 * 39 + 20, 75), abs=4)


def test_stamps_tell_a_dropped_frame_and_mistakes_are_said():
    tracker = TrafficTracker(frame_rate=25)
    for index, (frame, *found) in enumerate(drive(50)):
        if index != 45:
            tracks = tracker.update(frame, *found, stamp_ns=index * 40_000_000)
    assert tracks[0].velocity == pytest.approx((4, 0), abs=0.3)
    with pytest.raises(ValueError, match="as many"):
        tracker.update(frame, [(1, 1, 5, 5)], [0.1, 0.2])
    with pytest.raises(InputError):
        tracker.update(np.zeros((4, 4), np.uint8))

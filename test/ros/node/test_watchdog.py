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

"""The watch over steps that take too long."""

from __future__ import annotations

import threading
import time

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from vehicle_pf_tracker.ros.node.incidents import Watchdog


def deep(levels: int) -> int:
    return 1 + deep(levels - 1) if levels else 0


def test_a_look_at_frames_that_change_ends_no_node():
    """`faulthandler`'s looks ended this loop with a segmentation fault within 20 s."""
    said: list[str] = []
    watchdog = Watchdog(said.append)
    is_over = threading.Event()

    def look():
        while not is_over.is_set():
            watchdog.look()

    looking = threading.Thread(target=look)
    looking.start()
    deadline = time.monotonic() + 60.0
    while len(said) < 200 and time.monotonic() < deadline:
        watchdog.begin(0.0)
        deep(60)
    is_over.set()
    looking.join()
    assert len(said) >= 200
    assert any("in deep" in words for words in said)


def test_a_step_is_reported_once_and_one_that_has_ended_not_at_all():
    said: list[str] = []
    watchdog = Watchdog(said.append)
    watchdog.begin(0.0)
    watchdog.look()
    watchdog.look()
    watchdog.begin(0.0)
    watchdog.end()
    watchdog.look()
    assert len(said) == 1
    assert "longer than 0.0 s" in said[0]

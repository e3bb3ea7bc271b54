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

"""Rates of a node of many vehicles: what they count, and when one is not as usual."""

import numpy as np
import pytest

pytest.importorskip("rclpy")

from vehicle_pf_tracker.ros.traffic.rates import Rates


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


def test_births_and_ends_are_per_minute(clock):
    rates = Rates(clock)
    assert rates.values == {}
    for second in range(120):
        clock.now = float(second)
        rates.note({second // 10, second // 10 + 1}, 3, 2, 0.04, 5)
    values = rates.values
    assert values["births per minute"] == values["ends per minute"] == pytest.approx(6, abs=0.2)
    assert (values["detections per image"], values["of them believed"]) == (3, 2)
    assert values["detector's latency (ms)"] == pytest.approx(40)
    assert values["places with false alarms"] == 5


def watch(rates, clock, seconds, detections, latency=0.03):
    """Note and judge for some seconds; returns what was said."""
    said = []
    for _ in range(seconds):
        clock.now += 1.0
        rates.note({1, 2}, detections(), 2, latency)
        said.append(rates.judge())
    return said


def test_a_detector_that_goes_blind_or_slow_is_named(clock):
    draw, rates = np.random.default_rng(2), Rates(clock)
    usual = watch(rates, clock, 900, lambda: draw.poisson(8))
    assert not any(usual)
    assert any("detections per image" in one for one in watch(rates, clock, 60, lambda: 0))
    slow = watch(rates, clock, 60, lambda: draw.poisson(8), latency=0.5)
    assert any("detector's latency (ms)" in one for one in slow)


def test_what_stays_becomes_usual(clock):
    rates = Rates(clock)
    watch(rates, clock, 300, lambda: 8)
    assert any(watch(rates, clock, 60, lambda: 20))
    assert not any(watch(rates, clock, 3600, lambda: 20)[-600:])

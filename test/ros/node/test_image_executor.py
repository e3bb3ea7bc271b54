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

"""The nodes' executor: messages first, and everything else in good time."""

from __future__ import annotations

import time

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

import rclpy
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from vehicle_pf_tracker.ros.node import process
from vehicle_pf_tracker.ros.node.process import ImageExecutor

pytestmark = pytest.mark.ros


class Served:
    """A node of an `ImageExecutor`, and a tester that publishes to it and calls its service."""

    def __init__(self, bench):
        self.bench = bench
        self.node = rclpy.create_node("served", context=bench.context)
        self.heard = []
        self.asked = 0
        self.node.create_subscription(Header, "topic", self.heard.append, 100)
        self.node.create_service(Trigger, "service", self.answer)
        self.executor = ImageExecutor(context=bench.context)
        self.executor.add_node(self.node)
        self.publisher = bench.node.create_publisher(Header, "topic", 100)
        self.client = bench.node.create_client(Trigger, "service")
        bench.wait_for(self.publisher.get_subscription_count)
        bench.wait_for(self.client.service_is_ready)

    def answer(self, _, response):
        self.asked += 1
        return response

    def spin_until(self, condition):
        deadline = time.perf_counter() + 120
        while not condition():
            assert time.perf_counter() < deadline
            self.executor.spin_once()

    def hear_one(self):
        before = len(self.heard)
        self.publisher.publish(Header())
        self.spin_until(lambda: len(self.heard) > before)

    def waits_for_all(self):
        """Spin once, without a message; tell whether everything was waited for."""
        waits = []
        original = self.executor.wait_for_ready_callbacks

        def record(timeout, nodes=None):
            waits.append(nodes is None)
            return original(0.0, nodes)

        self.executor.wait_for_ready_callbacks = record
        self.executor.spin_once()
        self.executor.wait_for_ready_callbacks = original
        return waits == [True]

    def close(self):
        self.executor.shutdown()
        self.node.destroy_node()


@pytest.fixture
def served(bench):
    made = Served(bench)
    yield made
    made.close()


@pytest.fixture
def clock(monkeypatch):
    """The executor's clock, which stands still unless it is set."""
    times = [0.0]
    monkeypatch.setattr(process.time, "monotonic", lambda: times[0])
    return times


def test_while_messages_flow_nothing_else_is_waited_for(served, clock):
    assert served.waits_for_all()
    served.hear_one()
    assert not served.waits_for_all()


def test_messages_that_never_pause_starve_no_service_nor_let_it_wait_for_a_look(served, clock):
    served.hear_one()
    future = served.client.call_async(Trigger.Request())
    deadline = time.perf_counter() + 120
    while not served.asked:
        assert time.perf_counter() < deadline
        served.hear_one()
    served.bench.wait_for(future.done)


def test_a_look_at_everything_ends_once_nothing_is_ready(served, clock):
    served.hear_one()
    clock[0] += process.LOOK_EVERY
    assert served.waits_for_all()
    assert not served.waits_for_all()


def test_silence_brings_back_the_wait_for_everything(served, clock):
    served.hear_one()
    assert not served.waits_for_all()  # nothing comes in time
    assert served.waits_for_all()
    future = served.client.call_async(Trigger.Request())
    served.spin_until(lambda: served.asked)
    served.bench.wait_for(future.done)


def test_a_node_can_be_removed_while_messages_flow(served):
    served.hear_one()
    served.executor.remove_node(served.node)
    before = len(served.heard)
    served.publisher.publish(Header())
    served.executor.spin_once()  # ends after LOOK_EVERY
    assert len(served.heard) == before


def test_an_error_in_a_callback_is_raised(served):
    def fail(_):
        raise RuntimeError("broken")

    served.node.create_subscription(Header, "other", fail, 1)
    publisher = served.bench.node.create_publisher(Header, "other", 1)
    served.bench.wait_for(publisher.get_subscription_count)
    publisher.publish(Header())
    with pytest.raises(RuntimeError, match="broken"):
        while True:
            served.executor.spin_once()

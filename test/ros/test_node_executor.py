# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The nodes' executor: messages first, and everything else in good time."""

from __future__ import annotations

import time
import types

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from vehicle_pf_tracker.ros import node_executor, rclpy_internals
from vehicle_pf_tracker.ros.node_executor import MessageExecutor

pytestmark = pytest.mark.ros


class Served:
    """A node of a `MessageExecutor`, and a tester that publishes to it and calls its service."""

    def __init__(self, bench):
        self.bench = bench
        self.node = rclpy.create_node("served", context=bench.context)
        self.heard, self.infos = [], []
        self.asked = 0
        self.subscription = self.node.create_subscription(Header, "topic", self.hear, 100)
        self.node.create_service(Trigger, "service", self.answer)
        self.executor = MessageExecutor(context=bench.context)
        self.executor.add_node(self.node)
        self.publisher = bench.node.create_publisher(Header, "topic", 100)
        self.client = bench.node.create_client(Trigger, "service")
        bench.wait_for(self.publisher.get_subscription_count)
        bench.wait_for(self.client.service_is_ready)

    def hear(self, message, info):
        self.heard.append(message)
        self.infos.append(info)

    def answer(self, _, response):
        self.asked += 1
        return response

    def spin_until(self, condition):
        deadline = time.perf_counter() + 20
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

        def record(timeout, *others):
            waits.append(timeout)
            return original(0.0, *others)

        self.executor.wait_for_ready_callbacks = record
        self.executor.spin_once()
        self.executor.wait_for_ready_callbacks = original
        return bool(waits)

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
    monkeypatch.setattr(node_executor.time, "monotonic", lambda: times[0])
    return times


def test_while_messages_flow_nothing_else_is_waited_for(served, clock):
    served.hear_one()
    assert not served.waits_for_all()


def test_messages_come_with_their_info_in_order(served):
    served.hear_one()
    for number in range(20):
        served.publisher.publish(Header(frame_id=str(number)))
    served.spin_until(lambda: len(served.heard) == 21)
    assert [message.frame_id for message in served.heard[1:]] == list(map(str, range(20)))
    numbers = [info["publication_sequence_number"] for info in served.infos]
    assert numbers == list(range(numbers[0], numbers[0] + 21))


def test_a_callback_may_take_the_message_alone(served):
    alone = []
    served.node.create_subscription(Header, "topic", alone.append, 100)
    served.bench.wait_for(lambda: served.publisher.get_subscription_count() == 2)
    for _ in range(3):
        served.hear_one()
    served.spin_until(lambda: len(alone) == 3)


def test_messages_that_never_pause_starve_no_service(served):
    served.hear_one()
    future = served.client.call_async(Trigger.Request())
    deadline = time.perf_counter() + 20
    while not served.asked:
        assert time.perf_counter() < deadline
        served.hear_one()
    served.bench.wait_for(future.done)


def test_a_timer_runs_while_messages_flow(served):
    ticks = []
    served.hear_one()
    served.node.create_timer(0.01, lambda: ticks.append(1))
    deadline = time.perf_counter() + 20
    while len(ticks) < 3:
        assert time.perf_counter() < deadline
        served.hear_one()


def test_a_timer_needs_no_wait_for_everything(served, clock):
    ticks = []
    served.hear_one()
    timer = served.node.create_timer(0.01, lambda: ticks.append(1))
    assert not served.waits_for_all()
    assert ticks == [1]
    timer.cancel()
    time.sleep(0.02)
    rclpy_internals.run_timer(timer)
    served.node.destroy_timer(timer)
    rclpy_internals.run_timer(timer)
    assert ticks == [1]


def test_services_are_left_out_between_looks_for_requests(served, clock, monkeypatch):
    looks = []
    wait = rclpy_internals.EntityWait.wait

    def record(self, seconds, *, for_requests):
        looks.append(for_requests)
        return wait(self, seconds, for_requests=for_requests)

    monkeypatch.setattr(rclpy_internals.EntityWait, "wait", record)
    served.hear_one()
    served.hear_one()
    looks.clear()
    served.hear_one()
    assert not any(looks)
    clock[0] += node_executor.REQUESTS_EVERY
    served.hear_one()
    assert looks[-1]
    # Once a request came, each wait is for the next one, too.
    served.client.call_async(Trigger.Request())
    clock[0] += node_executor.REQUESTS_EVERY
    served.spin_until(lambda: served.asked)
    looks.clear()
    served.hear_one()
    assert all(looks)


def test_a_request_ends_a_silence_between_messages(served, clock):
    served.hear_one()
    served.hear_one()
    served.client.call_async(Trigger.Request())
    served.executor.spin_once()  # for messages alone
    served.executor.spin_once()
    assert served.asked == 1


def test_everything_is_looked_at_once_in_a_while(served, clock):
    served.hear_one()
    clock[0] += node_executor.LOOK_EVERY
    assert served.waits_for_all()


def test_silence_brings_back_the_wait_for_everything(served, clock):
    served.hear_one()
    assert not served.waits_for_all()  # nothing comes in time
    assert served.waits_for_all()
    future = served.client.call_async(Trigger.Request())
    served.spin_until(lambda: served.asked)
    served.bench.wait_for(future.done)


def test_a_subscription_that_a_callback_destroys_is_not_called(served):
    other = served.node.create_subscription(Header, "topic", served.hear, 100)
    served.bench.wait_for(lambda: served.publisher.get_subscription_count() == 2)
    served.hear_one()
    served.node.destroy_subscription(other)
    before = len(served.heard)
    rclpy_internals.run_callback(other)
    assert len(served.heard) == before
    served.hear_one()


def test_an_entity_that_another_thread_destroys_ends_nothing(served, monkeypatch):
    other = served.node.create_subscription(Header, "other", served.hear, 1)
    served.hear_one()
    served.hear_one()  # the first comes by the wait for everything
    # As between the moments in which the thread destroys it and says so.
    monkeypatch.setattr(served.executor, "wake", lambda: None)
    served.node.destroy_subscription(other)
    served.hear_one()


def test_a_change_while_entities_are_listed_is_listed_the_next_time(served, clock, monkeypatch):
    listed = served.executor.get_nodes
    ticks = []

    def listed_before_a_timer_is_made():
        nodes = [
            types.SimpleNamespace(subscriptions=list(node.subscriptions), timers=[], services=[])
            for node in listed()
        ]
        monkeypatch.setattr(served.executor, "get_nodes", listed)
        served.node.create_timer(0.001, lambda: ticks.append(1))
        return nodes

    served.hear_one()
    served.hear_one()
    monkeypatch.setattr(served.executor, "get_nodes", listed_before_a_timer_is_made)
    served.executor.wake()
    served.hear_one()
    time.sleep(0.002)
    served.hear_one()
    assert ticks


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


def test_another_rclpy_has_its_own_executor(ros_domain, monkeypatch):
    monkeypatch.setattr(rclpy_internals, "_compiled", None)
    assert not rclpy_internals.can_wait_for_entities()
    monkeypatch.setattr(node_executor, "can_wait_for_entities", lambda: False)
    rclpy.init()
    try:
        assert type(node_executor.node_executor()) is SingleThreadedExecutor
    finally:
        rclpy.shutdown()

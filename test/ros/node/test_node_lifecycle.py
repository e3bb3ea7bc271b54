# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""States and transitions, at any moment, with and without images arriving."""

from __future__ import annotations

import random

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.serialization import serialize_message
from tracker_rig import Rig, TrackerNode, header, on_target, overrides, road, values_of

from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.rclpy_internals import state_label
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros


class Manager:
    """What a lifecycle manager asks of the node."""

    def __init__(self, bench) -> None:
        self.bench = bench

    def change(self, transition: str) -> bool:
        request = ChangeState.Request()
        request.transition.label = transition
        return self.bench.call(ChangeState, "/apf_tracker/change_state", request).success

    @property
    def state(self) -> str:
        response = self.bench.call(GetState, "/apf_tracker/get_state", GetState.Request())
        return response.current_state.label


@pytest.fixture
def manager(bench):
    return Manager(bench)


def test_without_autostart_it_waits_for_a_manager(bench, manager):
    node = TrackerNode(
        find_variant("apf"), context=bench.context, parameter_overrides=overrides(autostart=False)
    )
    bench.add(node)
    assert manager.state == "unconfigured"
    assert node.count_subscribers("/image") == 0
    assert manager.change("configure")
    assert manager.change("activate")
    assert manager.state == "active"
    bench.wait_for(lambda: node.count_subscribers("/image") == 1)


def test_an_inactive_node_neither_listens_nor_speaks(bench, manager):
    rig = Rig(bench, on_target())
    frames = road(6)
    rig.play(frames[:3])
    assert manager.change("deactivate")
    bench.wait_for(lambda: rig.camera.get_subscription_count() == 0)
    rig.camera.publish(image_message(header(3), frames[3]))
    assert manager.state == "inactive"
    assert manager.change("activate")
    bench.wait_until_matched(rig.camera)
    answer = rig.show_frame(frames[4], 4)
    assert len(rig.modes) == 4
    assert values_of(answer)["regime"] != "start"  # the track outlives a pause


@pytest.mark.parametrize("transitions", [["deactivate"], ["deactivate", "cleanup"]])
def test_an_image_taken_just_before_is_left_alone(bench, manager, transitions):
    """As an executor of several threads may do."""
    rig = Rig(bench, on_target())
    frames = road(4)
    rig.play(frames[:3])
    take = rig.callback("/image")
    for transition in transitions:
        assert manager.change(transition)
    take(serialize_message(image_message(header(3), frames[3])), {})
    assert rig.node.diagnostics.health.arrivals.images == 3
    assert len(rig.modes) == 3


def test_cleanup_forgets_the_track_and_parameters_set_meanwhile_count(bench, manager):
    rig = Rig(bench, on_target())
    rig.play(road(3))
    for transition in ("deactivate", "cleanup"):
        assert manager.change(transition)
    bench.wait_for(lambda: rig.node.count_publishers("/apf_tracker/mode") == 0)
    rig.node.set_parameters_atomically(overrides(num_particles=33))
    for transition in ("configure", "activate"):
        assert manager.change(transition)
    rig.wait_until_heard()
    values = values_of(rig.show_frame(road(1)[0], 0))
    assert (values["regime"], values["num_particles"]) == ("start", "33")


@pytest.mark.parametrize("transition", ["configure", "activate", "cleanup", "nonsense", ""])
def test_a_transition_that_does_not_exist_here_is_refused(bench, manager, transition):
    Rig(bench)
    assert not manager.change(transition)
    assert manager.state == "active"


def test_a_failing_transition_says_why_and_the_node_lives(bench, manager, monkeypatch):
    rig = Rig(bench)
    assert manager.change("deactivate")
    assert rig.node.failure == ""
    with monkeypatch.context() as patch:
        patch.setattr(rig.node, "warn_of_overrides", lambda **_: 1 / 0)
        assert not manager.change("activate")
    assert rig.node.failure == "unexpected ZeroDivisionError: division by zero"
    assert manager.state == "unconfigured"
    assert manager.change("configure")
    assert manager.change("activate")
    assert rig.node.failure == "unexpected ZeroDivisionError: division by zero"  # the last one
    rig.wait_until_heard()
    assert rig.show_frame(road(1)[0], 0).status[0].message == "WAITING"


def test_shutdown_lets_go_of_everything(bench, manager):
    rig = Rig(bench)
    assert manager.change("shutdown")
    assert manager.state == "finalized"
    assert rig.node.count_publishers("/apf_tracker/mode") == 0
    assert rig.node.count_subscribers("/image") == 0


@pytest.mark.parametrize("images", [True, False], ids=["with images", "without images"])
def test_many_transitions_at_any_moment(bench, images):
    """More than 80, each through the service while images and requests are on their way."""
    rig = Rig(bench, on_target())
    frame = road(1)[0]
    client = bench.node.create_client(ChangeState, "/apf_tracker/change_state")
    bench.wait_for(client.service_is_ready)
    draw = random.Random(3)
    done = 0
    for index in range(160):
        if images:
            rig.camera.publish(image_message(header(index), frame))
        request = ChangeState.Request()
        possible = {
            "active": ["deactivate"],
            "inactive": ["activate", "cleanup"],
            "unconfigured": ["configure"],
        }[state_label(rig.node)]
        request.transition.label = draw.choice([*possible, "nonsense"])
        future = client.call_async(request)
        if images:
            rig.camera.publish(image_message(header(index), frame))
        bench.wait_for(future.done)
        assert future.result().success == (request.transition.label in possible)
        done += future.result().success
    assert done > 80
    while state_label(rig.node) != "active":
        state = state_label(rig.node)
        (rig.node.trigger_configure if state == "unconfigured" else rig.node.trigger_activate)()
    rig.wait_until_heard()
    rig.camera.publish(image_message(header(1000), frame))
    bench.wait_for(lambda: rig.modes and rig.modes[-1].header == header(1000))
    assert rig.node.count_subscribers("/image") == 1
    assert rig.node.count_publishers("/apf_tracker/mode") == 1

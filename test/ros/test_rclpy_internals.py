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

"""Private names of rclpy: present in this release, and not needed by a node."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.parameter import Parameter
from tracker_rig import Rig, on_target, overrides, road

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros import rclpy_internals
from vehicle_pf_tracker.ros.node.process import ImageExecutor, node_executor
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros

EVERYTHING = ("_overrides", "_state_machine")


@pytest.fixture
def stranger(monkeypatch):
    """An rclpy in which every private name is called something else."""
    monkeypatch.delattr(Executor, "_make_handler")
    for name in EVERYTHING:
        monkeypatch.setattr(rclpy_internals, name, lambda node: None)
    monkeypatch.setattr(rclpy_internals, "change_state_service", lambda node: None)


def test_this_release_has_all_of_them(bench):
    rig = Rig(bench)
    assert rclpy_internals.missing(rig.node) == []
    assert rclpy_internals.change_state_service(rig.node) is not None
    assert rclpy_internals.state_label(rig.node) == "active"
    assert issubclass(rclpy_internals.RCLError, RuntimeError)
    assert rclpy_internals.RCLError is not RuntimeError
    assert rclpy_internals.UnknownROSArgsError is not RuntimeError


def test_what_is_missing_is_named(bench, stranger):
    sentences = rclpy_internals.missing(Rig(bench).node)
    assert [sentence.split(":")[0] for sentence in sentences] == [
        "its executor differs",
        "its parameter overrides are hidden",
        "its state machine is hidden",
    ]


def test_a_node_tracks_without_any_of_them(bench, monkeypatch):
    for name in EVERYTHING:
        monkeypatch.setattr(rclpy_internals, name, lambda node: None)
    rig = Rig(bench, on_target(num_particles=40))
    assert rig.node.get_parameter("num_particles").value == 40
    assert rig.node.get_parameter("target.x").value == 20.0
    assert set(rig.play(road(6))) == {"TRACKING"}


def test_overrides_are_read_the_public_way_as_by_the_list(bench, monkeypatch):
    given = [*on_target(num_particles=33, seed=5), Parameter("lost_after", value=3)]
    tables = []
    for hidden in (False, True):
        with monkeypatch.context() as patch:
            if hidden:
                patch.setattr(rclpy_internals, "_overrides", lambda node: None)
            node = bench.add(
                TrackerNode(find_variant("pf"), context=bench.context, parameter_overrides=given)
            )
            tables.append(node.table.configuration)
            bench.remove(node)
    assert tables[0] == tables[1]
    assert tables[0].tracker.num_particles == 33
    assert tables[0].to_mapping()["lost_after"] == 3.0


def test_a_wrong_override_is_refused_the_public_way_too(bench, monkeypatch):
    monkeypatch.setattr(rclpy_internals, "_overrides", lambda node: None)
    with pytest.raises(InputError, match="num_particles"):
        TrackerNode(
            find_variant("pf"),
            context=bench.context,
            parameter_overrides=overrides(num_particles="many"),
        )


def test_a_hidden_state_machine_still_changes_state(bench, monkeypatch):
    monkeypatch.setattr(rclpy_internals, "_state_machine", lambda node: None)
    rig = Rig(bench)
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_DEACTIVATE))
    assert bench.call(ChangeState, f"{rig.name}/change_state", request).success
    assert rclpy_internals.state_label(rig.node) == ""


@pytest.mark.parametrize("change", ["gone", "other parameters", "other marks"])
def test_an_unknown_executor_is_replaced_by_the_public_one(monkeypatch, change):
    if change == "gone":
        monkeypatch.delattr(Executor, "_make_handler")
    elif change == "other parameters":
        monkeypatch.setattr(Executor, "_make_handler", lambda self, entity, node: None)
    else:
        monkeypatch.setattr(
            Executor, "_make_handler", lambda self, entity, node, take_from_wait_list: None
        )
    assert not rclpy_internals.can_run_directly()
    made = []
    for kind in (ImageExecutor, SingleThreadedExecutor):
        monkeypatch.setattr(
            f"vehicle_pf_tracker.ros.node.process.{kind.__name__}",
            lambda kind=kind: made.append(kind),
        )
    node_executor()
    assert made == [SingleThreadedExecutor]

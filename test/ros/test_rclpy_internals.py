# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Private names of rclpy: present in this release, and not needed by a node."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from tracker_rig import Rig, on_target, road

from vehicle_pf_tracker.ros import rclpy_internals

pytestmark = pytest.mark.ros


def test_this_release_has_all_of_them(bench):
    rig = Rig(bench)
    assert rclpy_internals.change_state_service(rig.node) is not None
    assert rclpy_internals.state_label(rig.node) == "active"
    for error in (rclpy_internals.RCLError, rclpy_internals.UnknownROSArgsError):
        assert issubclass(error, RuntimeError)
        assert error is not RuntimeError


def test_a_node_tracks_and_changes_state_without_any_of_them_and_says_what_is_lost(
    bench, monkeypatch, capfd
):
    monkeypatch.setattr(rclpy_internals, "state_machine", lambda node: None)
    monkeypatch.setattr(rclpy_internals, "change_state_service", lambda node: None)
    rig = Rig(bench, on_target())
    assert set(rig.play(road(6))) == {"TRACKING"}
    assert "its state machine is hidden; failed" in capfd.readouterr().err
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_DEACTIVATE))
    assert bench.call(ChangeState, f"{rig.name}/change_state", request).success
    assert rclpy_internals.state_label(rig.node) == ""

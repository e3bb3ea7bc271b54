# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node whose kernels are not compiled yet: it answers, it obeys, and it loses no target."""

from __future__ import annotations

import signal

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")
pytest.importorskip("numba", reason="there is nothing to compile")

from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.srv import GetState
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger
from tracker_rig import TARGET, header, road, values_of

from vehicle_pf_tracker.ros.messages import NOT_READY, image_message

pytestmark = pytest.mark.ros


@pytest.fixture
def cold(start_node, tmp_path):
    """A node with an empty cache, which takes ten seconds and more to fill."""
    names = ("x", "y", "width", "height")
    target = [f"target.{name}:={float(v)}" for name, v in zip(names, TARGET, strict=True)]
    words = [word for one in target for word in ("-p", one)]
    process = start_node("pf", *words, NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    process.wait_for_output(NOT_READY)
    return process


def test_a_cold_node_answers_its_services_while_it_compiles(bench, cold):
    state = bench.call(GetState, "/pf_tracker/get_state", GetState.Request())
    assert state.current_state.label == "active"
    answer = bench.call(Trigger, "/pf_tracker/reset", Trigger.Request())
    assert not answer.success
    assert answer.message.startswith(NOT_READY)
    assert "ready: images on" not in cold.output


@pytest.mark.slow
def test_images_are_answered_meanwhile_and_tracked_in_afterwards(bench, cold):
    frame = road(1)[0]
    camera = bench.publisher(Image, "image")
    modes = bench.collect(DiagnosticArray, "/pf_tracker/mode", 100)
    bench.publish_until(lambda: modes, camera, image_message(header(0), frame))
    assert modes[0].status[0].message == "WAITING"
    assert values_of(modes[0])["reason"].startswith(NOT_READY)
    cold.wait_for_output("ready: images on", 600.0)
    del modes[:]
    bench.publish_until(lambda: modes, camera, image_message(header(1), frame))
    assert modes[-1].status[0].message == "TRACKING"


def test_a_signal_is_obeyed_while_it_compiles(cold):
    cold.send(signal.SIGTERM)
    assert cold.wait() == 0
    assert "Traceback" not in cold.output

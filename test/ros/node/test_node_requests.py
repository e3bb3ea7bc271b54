# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests to a node that images keep busy: each is answered."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image
from tracker_rig import header, road

from vehicle_pf_tracker.ros.messages import image_message

pytestmark = pytest.mark.ros

RATE = 30.0
BURSTS = [30, 50, 200]


class Camera:
    """Publishes VGA images at `RATE` while the bench spins."""

    def __init__(self, bench):
        self.message = image_message(header(0), road(1, 640, 480)[0])
        self.index = 0
        self.publisher = bench.publisher(Image, "image", QoSProfile(depth=1))
        self.answers = bench.collect(DiagnosticArray, "/pf_tracker/mode", 100)
        bench.node.create_timer(1 / RATE, self.publish)
        bench.wait_for(lambda: len(self.answers) > 10)

    def publish(self):
        self.index += 1
        self.message.header = header(self.index)
        self.publisher.publish(self.message)


@pytest.fixture
def client(bench, start_node):
    target = {"x": 20.0, "y": 50.0, "width": 24.0, "height": 18.0}
    start_node("pf", *(w for k, v in target.items() for w in ("-p", f"target.{k}:={v}")))
    # A client keeps ten replies unless told; a burst may bring more before it is scheduled again.
    made = bench.node.create_client(
        SetParameters, "/pf_tracker/set_parameters", qos_profile=QoSProfile(depth=max(BURSTS))
    )
    bench.wait_for(made.service_is_ready)
    made.camera = Camera(bench)
    return made


def request(number: int) -> SetParameters.Request:
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=3.0 + number * 1e-3)
    return SetParameters.Request(parameters=[Parameter(name="sigma", value=value)])


@pytest.mark.parametrize("count", BURSTS)
def test_every_request_of_a_burst_is_answered(bench, client, count):
    futures = [client.call_async(request(number)) for number in range(count)]
    bench.wait_for(lambda: all(future.done() for future in futures))
    assert all(future.result().results[0].successful for future in futures)
    # Until its kernels are compiled it answers images with WAITING.
    bench.wait_for(lambda: client.camera.answers[-1].status[0].message == "TRACKING")

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What cameras, networks and people do to a node: it lives, answers, and does not grow."""

from __future__ import annotations

import signal
import time
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image
from tracker_rig import Rig, diagnostics_of, header, on_target, road

from vehicle_pf_tracker.ros.messages import image_message

pytestmark = pytest.mark.ros


def resident(process) -> int:
    """Resident memory of a process in bytes."""
    fields = Path("/proc", str(process.popen.pid), "statm").read_text().split()
    return int(fields[1]) * 4096


def test_a_publisher_that_dies_and_returns_is_heard_again(bench, other_bench):
    rig = Rig(bench, on_target())
    frames = road(12)
    rig.play(frames[:4])
    bench.node.destroy_publisher(rig.camera)
    bench.wait_for(lambda: rig.node.count_publishers("/image") == 0)
    camera = other_bench.publisher(Image, "image", QoSProfile(depth=10))
    bench.wait_for(lambda: rig.node.diagnostics.source.count_publishers() == 1)
    for index in range(4, 12):
        before = len(rig.modes)
        camera.publish(image_message(header(index), frames[index]))
        bench.wait_for(lambda: len(rig.modes) > before)  # noqa: B023 - called at once
    assert [answer.status[0].message for answer in rig.modes] == ["TRACKING"] * 12
    assert rig.node.diagnostics.health.arrivals.dropped == 0


def test_at_200_hz_images_are_dropped_and_counted_and_memory_stays(bench, start_node):
    """A node that needs longer than 5 ms takes the newest image and keeps no queue."""
    target = [f"target.{k}:={v}" for k, v in zip(("x", "y"), (20.0, 50.0), strict=True)]
    target += ["target.width:=24.0", "target.height:=18.0", "num_particles:=100000"]
    node = start_node("pf", *(word for one in target for word in ("-p", one)))
    node.wait_for_output("ready")
    camera = bench.publisher(Image, "image", QoSProfile(depth=1))
    modes = bench.collect(DiagnosticArray, "/pf_tracker/mode", QoSProfile(depth=500))
    image = image_message(header(0), road(1, 320, 240)[0])
    bench.publish_until(lambda: modes, camera, image)
    sizes = []
    began = time.monotonic()
    for index in range(1, 601):
        image.header = header(index)
        camera.publish(image)
        while time.monotonic() < began + index / 200:
            bench.executor.spin_once(timeout_sec=0.001)
        sizes.append(resident(node))
    told = diagnostics_of(
        bench, "pf_tracker", lambda table: int(table["images"]) + int(table["dropped"]) >= 600
    )
    images, dropped = int(told["images"]), int(told["dropped"])
    assert dropped > 100
    assert 600 <= images + dropped <= 600 + 20  # those of publish_until, before it was heard
    assert images - 2 <= len(modes) <= images
    assert sizes[-1] < sizes[200] * 1.05 + 2**20


def test_a_subscriber_that_stalls_holds_nobody_up(bench, start_node, start_process):
    node = start_node("apf", "-p", "queue_depth:=10")
    node.wait_for_output("ready")
    code = (
        "import rclpy\n"
        "from diagnostic_msgs.msg import DiagnosticArray\n"
        "from sensor_msgs.msg import Image\n"
        "rclpy.init()\n"
        "node = rclpy.create_node('sleeper')\n"
        "node.create_subscription(DiagnosticArray, '/apf_tracker/mode', print, 10)\n"
        "node.create_subscription(Image, '/apf_tracker/overlay', print, 10)\n"
        "rclpy.spin(node)"
    )
    sleeper = start_process("-u", "-c", code)
    modes = bench.collect(DiagnosticArray, "/apf_tracker/mode", QoSProfile(depth=50))
    camera = bench.publisher(Image, "image", QoSProfile(depth=10))
    image = image_message(header(0), road(1, 320, 240)[0])
    bench.publish_until(lambda: modes and "WAITING" in sleeper.output, camera, image)
    sleeper.send(signal.SIGSTOP)
    before = resident(node)
    for index in range(1, 201):
        image.header = header(index)
        camera.publish(image)
        bench.wait_for(lambda: modes[-1].header == image.header)
    sleeper.send(signal.SIGKILL)
    assert resident(node) < before * 1.05 + 4 * 2**20


def test_a_killed_node_neither_harms_others_nor_its_successor(bench, start_node):
    modes = {}
    killed = start_node("apf")
    start_node("pf").wait_for_output("ready")
    killed.wait_for_output("ready")
    image = image_message(header(0), road(1)[0])
    for name in ("apf", "pf"):
        modes[name] = bench.collect(DiagnosticArray, f"/{name}_tracker/mode")
    camera = bench.publisher(Image, "image", QoSProfile(depth=10), count=2)
    bench.publish_until(lambda: all(modes.values()), camera, image)
    killed.send(signal.SIGKILL)
    killed.wait()
    count = len(modes["pf"])
    bench.publish_until(lambda: len(modes["pf"]) >= count + 5, camera, image)
    count = len(modes["apf"])
    start_node("apf").wait_for_output("ready")
    bench.publish_until(lambda: len(modes["apf"]) > count, camera, image)


def test_simulated_time_is_that_of_the_reports(bench):
    rig = Rig(bench, [*on_target(), Parameter("use_sim_time", value=True)])
    clock = bench.publisher(Clock, "/clock")
    clock.publish(Clock(clock=Time(sec=1, nanosec=250_000_000)))
    bench.wait_for(lambda: rig.node.get_clock().now().nanoseconds == 1_250_000_000)
    answer = rig.show_frame(road(1)[0], 5)  # stamped 1.2 s
    assert answer.header.stamp == header(5).stamp
    told = diagnostics_of(bench, "apf_tracker", lambda table: table["images"] == "1")
    assert float(told["age of frames (ms)"]) == pytest.approx(50.0)
    # Time that stands still stops neither the reports nor the answers.
    assert rig.play(road(3), first=6) == ["TRACKING"] * 3
    diagnostics_of(bench, "apf_tracker", lambda table: table["images"] == "4")

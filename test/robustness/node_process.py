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

"""A tracker node in a process of its own, and somebody who talks to it in lock-step."""

from __future__ import annotations

import atexit
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from faulty_messages import TARGET
from geometry_msgs.msg import PointStamped, PolygonStamped
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image, RegionOfInterest

from vehicle_pf_tracker.ros.messages import NOT_READY

TIMEOUT = 20.0
RELIABLE = "qos_overrides./image.subscription.reliability:=reliable"
"""Images come by best effort: on a busy machine DDS may drop one, beside a flood above all.

An image without an answer would then say nothing about the node.
"""
MB = 1e6
SETTLED = 600.0
"""Seconds until memory has to stay as it is; a shorter run shows its second half."""
TRACKED = {"TRACKING", "OCCLUDED", "LOST"}
_TOPICS = {RegionOfInterest: "set_target", PolygonStamped: "set_box", PointStamped: "clicked_point"}


class NodeProcess:
    """Starts the node of `variant`, and ends it.

    Parameters
    ----------
    variant : str
        Name of the variant.
    *assignments : str
        Parameters, ``name:=value``.
    target : (float, float, float, float) or None
        Left, top, width, height of the target in px; None gives none.
    is_reliable : bool
        Images come reliably; else by best effort, as from a camera.
    """

    def __init__(
        self,
        variant: str,
        *assignments: str,
        target: tuple[float, float, float, float] | None = TARGET,
        is_reliable: bool = True,
    ) -> None:
        os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        box = zip(("x", "y", "width", "height"), target or (), strict=target is not None)
        words = [*(f"target.{name}:={value}" for name, value in box), *assignments]
        words += [RELIABLE] if is_reliable else []
        self._log = tempfile.TemporaryFile("w+")  # noqa: SIM115 - open as long as the node
        code = (
            "from vehicle_pf_tracker.ros.executables import main;"
            f"raise SystemExit(main({variant!r}))"
        )
        arguments = [word for one in words for word in ("-p", one)]
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, "--ros-args", *arguments],
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )
        atexit.register(self._process.kill)
        rclpy.init()
        self._node = rclpy.create_node("tester")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self.modes: list[DiagnosticArray] = []
        self.name = own = f"/{variant}_tracker"
        self._node.create_subscription(
            DiagnosticArray, f"{own}/mode", self.modes.append, QoSProfile(depth=100)
        )
        self._reports: list[DiagnosticArray] = []
        self._node.create_subscription(
            DiagnosticArray, "/diagnostics", self._reports.append, QoSProfile(depth=10)
        )
        self._camera = self._node.create_publisher(Image, "image", QoSProfile(depth=100))
        self._targets = {
            kind: self._node.create_publisher(kind, f"{own}/{name}", 10)
            for kind, name in _TOPICS.items()
        }
        self._parameters = self._node.create_client(SetParameters, f"{own}/set_parameters")
        self.changes: list[bool] = []
        self._sent: deque[object] = deque(maxlen=8)

    def begin(self, image: Image) -> None:
        """Wait until the node answers `image`, which is sent again and again."""
        deadline = time.monotonic() + TIMEOUT
        while not self.modes or self._is_loading():
            if self.modes:
                deadline = time.monotonic() + TIMEOUT  # it lives, and compiles
            if time.monotonic() > deadline:
                raise SystemExit(f"the node does not answer:\n{self.log}")
            self.publish(image)
            self.spin(0.2)
        self.spin(0.5)
        self.modes.clear()

    def _is_loading(self) -> bool:
        values = self.modes[-1].status[0].values
        return any(pair.value.startswith(NOT_READY) for pair in values)

    @property
    def lost(self) -> int:
        """Images that were sent but never reached the node, by their publication numbers."""
        self._reports.clear()
        deadline = time.monotonic() + TIMEOUT
        while not self._reports and time.monotonic() < deadline:
            self.spin(0.1)
        values = self._reports[-1].status[0].values if self._reports else ()
        return next((int(pair.value) for pair in values if pair.key == "dropped"), 0)

    def collect(self, kind: type, name: str) -> list[Any]:
        """Subscribe to an output of the node; returns the list that messages are appended to."""
        received: list[Any] = []
        topic = f"{self.name}/{name}"
        self._node.create_subscription(kind, topic, received.append, QoSProfile(depth=100))
        return received

    def publisher(self, kind: type, topic: str) -> Publisher:
        """Make a publisher of the tester."""
        return self._node.create_publisher(kind, topic, QoSProfile(depth=100))

    def publish(self, message: object) -> None:
        """Send an image or a target."""
        self._sent.append(message)
        publisher = self._targets.get(type(message), self._camera)
        publisher.publish(message)

    def set_parameter(self, name: str, value: object) -> None:
        """Ask for a value; `changes` has whether it was taken, once that is answered."""
        wanted = Parameter(name, value=value).to_parameter_msg()
        future = self._parameters.call_async(SetParameters.Request(parameters=[wanted]))
        future.add_done_callback(
            lambda done: self.changes.append(done.result().results[0].successful)
        )

    def spin(self, seconds: float) -> None:
        """Listen for this long."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def take(self, image: Image) -> DiagnosticArray:
        """Send an image and return its one answer."""
        self.modes.clear()
        self.publish(image)
        deadline = time.monotonic() + TIMEOUT
        while not self.modes:
            self._executor.spin_once(timeout_sec=0.5)
            if time.monotonic() > deadline or self._process.poll() is not None:
                raise SystemExit(f"no answer to the image {_brief(image)}\n{self.log}")
        return self.modes[0]

    def check(self, answer: DiagnosticArray, image: Image, *, is_good: bool) -> str:
        """Return the mode of an answer that is right.

        Raises
        ------
        SystemExit
            If a good image has no estimate, or an answer is wrong in itself.
        """
        status = answer.status[0]
        values = {item.key: item.value for item in status.values}
        if not _is_right(status.message, values, image, is_good) or answer.header != image.header:
            history = "\n".join(map(_brief, self._sent))
            raise SystemExit(f"wrong: {values}\nfor {_brief(image)}, the last of\n{history}")
        return str(status.message)

    @property
    def resident(self) -> int:
        """Resident memory of the node in bytes."""
        pages = int(Path("/proc", str(self._process.pid), "statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    @property
    def log(self) -> str:
        """The last of what the node said."""
        return self.output[-4000:]

    @property
    def output(self) -> str:
        """All that the node said."""
        self._log.seek(0)
        return self._log.read()

    def end(self) -> None:
        """End the node with a signal.

        Raises
        ------
        SystemExit
            If it says something of a traceback, or does not end well.
        """
        self._process.send_signal(signal.SIGINT)
        status = self._process.wait(TIMEOUT)
        self._executor.shutdown()
        rclpy.try_shutdown()
        text = self.output
        if status or "Traceback" in text:
            raise SystemExit(f"the node ended with {status}:\n{text[-4000:]}")


def growth(sizes: list[tuple[float, int]]) -> float:
    """Print how the resident memory went; returns by how many MB it grew once settled."""
    times, memory = np.array(sizes).T
    since = min(SETTLED, times[-1] / 2)
    settled = memory[times >= since] / MB
    print(
        f"resident memory {settled[0]:.1f} MB after {since / 60:.1f} minutes, {settled[-1]:.1f} MB "
        f"at the end ({settled[-1] - settled[0]:+.1f} MB), {settled.max():.1f} MB at most"
    )
    for at, size in list(zip(times, memory, strict=True))[:: max(len(times) // 12, 1)]:
        print(f"  {at / 60:5.1f} minutes: {size / MB:.1f} MB")
    return float(settled[-1] - settled[0]) if times[-1] > SETTLED else 0.0


def _is_right(mode: str, values: Mapping[str, str], image: Image, is_good: bool) -> bool:
    if mode not in TRACKED:
        reason = values.get("reason", "unexpected")
        return mode == "REJECTED" and not is_good and not reason.startswith("unexpected")
    x, y, confidence = (float(values[name]) for name in ("x", "y", "confidence"))
    return 0 <= x <= image.width and 0 <= y <= image.height and 0 <= confidence <= 1


def _brief(message: object) -> str:
    if not isinstance(message, Image):
        return str(message)
    stamp = message.header.stamp
    return (
        f"{message.width}x{message.height} {message.encoding!r} step {message.step} "
        f"{len(message.data)} bytes at {stamp.sec}.{stamp.nanosec:09d}"
    )

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node in a process of its own, and somebody who sends it images and hears its answers."""

from __future__ import annotations

import atexit
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PolygonStamped
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image, RegionOfInterest

TIMEOUT = 20.0
"""Seconds in which a node answers, or ends: a busy machine, and no more patience than a user's."""
RELIABLE = "qos_overrides./image.subscription.reliability:=reliable"
"""Images come by best effort: on a busy machine DDS may drop one, beside a flood above all.

An image without an answer would then say nothing about the node.
"""
_DEPTH = QoSProfile(depth=100)
"""More messages than one case sends: none of the answers is dropped here."""
_TARGETS = {
    RegionOfInterest: "set_target",
    PolygonStamped: "set_box",
    PointStamped: "clicked_point",
}


class FaultError(Exception):
    """A node or a command did not do with a fault as it should."""


class Tester:
    """One camera, and an ear for everything that nodes publish."""

    def __init__(self) -> None:
        # Nodes of other machines must neither hear nor answer.
        os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        rclpy.init()
        self._node = rclpy.create_node("tester")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._camera = self.publisher(Image, "image")

    def publisher(self, kind: Any, topic: str) -> Publisher:
        """Make a publisher."""
        return self._node.create_publisher(kind, topic, _DEPTH)

    def collect(self, kind: Any, topic: str) -> list[Any]:
        """Subscribe to a topic; return the list that messages are appended to."""
        received: list[Any] = []
        self._node.create_subscription(kind, topic, received.append, _DEPTH)
        return received

    def parameter_client(self, node: str) -> Any:
        """Make a client that sets parameters of `node`."""
        return self._node.create_client(SetParameters, f"{node}/set_parameters")

    def show(self, image: Image) -> None:
        """Send an image to all nodes."""
        self._camera.publish(image)

    def spin(self, seconds: float) -> None:
        """Listen for this long."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def close(self) -> None:
        """End."""
        self._executor.shutdown()
        rclpy.try_shutdown()


class NodeProcess:
    """Starts the node of `variant`, and ends it.

    Parameters
    ----------
    tester : Tester
        Hears it.
    variant : str
        Name of the variant, or of the node of many vehicles.
    *assignments : str
        Parameters, ``name:=value``.
    is_reliable : bool
        Images come reliably; else by best effort, as from a camera.

    Attributes
    ----------
    name : str
        Full name of the node.
    modes : list of DiagnosticArray
        Messages of `~/mode` that nobody has taken yet.
    changes : list of bool
        Outcomes of the parameters that were set, in the order of the answers.
    """

    def __init__(
        self, tester: Tester, variant: str, *assignments: str, is_reliable: bool = True
    ) -> None:
        words = [*assignments, *([RELIABLE] if is_reliable else [])]
        # A file and not a pipe: nobody reads while the node runs, and a full pipe would stop it.
        self._log = tempfile.TemporaryFile("w+")  # noqa: SIM115 - open as long as the node
        code = (
            "from vehicle_pf_tracker.ros.executables import main;"
            f"raise SystemExit(main({variant!r}))"
        )
        arguments = [word for assignment in words for word in ("-p", assignment)]
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, "--ros-args", *arguments],
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )
        # Also where this program ends by an exception.
        atexit.register(self._process.kill)
        self.name = f"/{variant}_tracker"
        self.modes: list[DiagnosticArray] = tester.collect(DiagnosticArray, f"{self.name}/mode")
        self.changes: list[bool] = []
        self._tester = tester
        self._reports = tester.collect(DiagnosticArray, "/diagnostics")
        self._targets = {
            kind: tester.publisher(kind, f"{self.name}/{name}") for kind, name in _TARGETS.items()
        }
        self._parameters = tester.parameter_client(self.name)

    def give_target(self, target: object) -> None:
        """Send a target."""
        self._targets[type(target)].publish(target)

    def set_parameter(self, name: str, value: object) -> None:
        """Ask for a value; `changes` has whether it was taken, once that is answered."""
        wanted = Parameter(name, value=value).to_parameter_msg()
        future = self._parameters.call_async(SetParameters.Request(parameters=[wanted]))
        future.add_done_callback(
            lambda done: self.changes.append(done.result().results[0].successful)
        )

    def lost(self) -> int:
        """Count images that were sent and never reached the node, by their publication numbers."""
        # Reports from now on: an older one does not count the last images.
        self._reports.clear()
        deadline = time.monotonic() + TIMEOUT
        while time.monotonic() < deadline:
            self._tester.spin(0.1)
            for report in self._reports:
                status = report.status[0]
                if status.name.startswith(f"{self.name[1:]}:"):
                    return next(
                        int(value.value) for value in status.values if value.key == "dropped"
                    )
        return 0

    @property
    def is_alive(self) -> bool:
        """True while the process runs."""
        return self._process.poll() is None

    @property
    def resident(self) -> int:
        """Resident memory of the node in bytes."""
        pages = int(Path("/proc", str(self._process.pid), "statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    @property
    def output(self) -> str:
        """All that the node said."""
        self._log.seek(0)
        return self._log.read()

    def end(self) -> None:
        """End the node with a signal.

        Raises
        ------
        FaultError
            If it says something of a traceback, or does not end well.
        """
        if self.is_alive:
            # As Ctrl-C does: a node has to end well by that.
            self._process.send_signal(signal.SIGINT)
        status = self._process.wait(TIMEOUT)
        text = self.output
        if status or "Traceback" in text:
            raise FaultError(f"{self.name} ended with status {status}:\n{text[-4000:]}")

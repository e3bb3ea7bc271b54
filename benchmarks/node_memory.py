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

"""Memory of nodes through Fast DDS, and of what numba adds to it.

    python -m benchmarks.node_memory

Each node is a process of its own that takes 200 images of 640x360 px with 50 vehicles, each when it
has answered the one before. Resident memory includes shared libraries; what of it is the process's
own is beside it. The second table is a process that loads the compiled kernels step by step, then
one that compiles them.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image, RegionOfInterest
from std_msgs.msg import Header

from benchmarks.bench.processes import NodeProcess, floor_words
from benchmarks.traffic_cost import made
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.transport import image_transport

VEHICLES = 50
FIRST = "first start"
IMAGES = 200
RATE = 20.0
"""Images per second by their stamps."""
PATIENCE = 2.0
"""Seconds until an image has been lost on its way."""
CODE = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main({!r}))"
MOTION = "detector.kind:=motion"
TARGET = {"x": 300.0, "y": 80.0, "width": 40.0, "height": 20.0}
STEPS = """
import sys
from benchmarks.node_memory import fields
def say(words):
    print(f"| {{words}} | {{fields('self')['Rss']:.0f}} | {{fields('self')['Anonymous']:.0f}} |")
say("the packages that kernels need anyway")
import llvmlite.binding; say("and llvmlite")
import numba; say("and numba")
from numba.core.registry import cpu_target
cpu_target.target_context.refresh(); say("and numba's types and functions, which kernels refer to")
import vehicle_pf_tracker.image.kernels.numba_kernels; say("and {kernels}")
from vehicle_pf_tracker.image.kernels.choice import load_kernels
load_kernels("numba"); say("after what is not needed any more is released")
"""


def fields(process: int | str) -> dict[str, float]:
    """Sizes of /proc/PROCESS/smaps_rollup in MB."""
    lines = Path("/proc", str(process), "smaps_rollup").read_text().splitlines()[1:]
    return {line.split(":")[0]: int(line.split()[1]) * 1024 / 1e6 for line in lines}


class Viewer:
    """A camera whose images have so many bytes, and somebody who hears `~/mode`."""

    def __init__(self, frame_bytes: int) -> None:
        with image_transport(frame_bytes, rclpy.get_rmw_implementation_identifier()):
            rclpy.init()
            self._node = rclpy.create_node("viewer")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._camera = self._node.create_publisher(Image, "image", QoSProfile(depth=10))
        self._targets = self._node.create_publisher(
            RegionOfInterest, "/traffic_tracker/add_target", QoSProfile(depth=2 * VEHICLES)
        )
        self.answers: list[DiagnosticArray] = []

    def hear(self, variant: str) -> None:
        """Listen to a node."""
        topic = f"/{variant}_tracker/mode"
        qos = QoSProfile(depth=IMAGES)
        self._node.create_subscription(DiagnosticArray, topic, self.answers.append, qos)

    def show(self, frames: Sequence[Frame], boxes: Array, *, is_heard: bool) -> None:
        """Publish the frames, each when the one before was answered or a while has passed.

        `boxes` (left, top, width, height) are given by hand, after the first frame.
        """
        self._spin(lambda: False, 1.0)
        self.answers.clear()
        for number, frame in enumerate(frames, start=1):
            header = Header(frame_id="camera")
            nanoseconds = round(number * 1e9 / RATE)
            header.stamp.sec, header.stamp.nanosec = divmod(nanoseconds, 10**9)
            before = len(self.answers)
            self._camera.publish(image_message(header, frame))
            if is_heard:
                self._spin(lambda before=before: len(self.answers) > before, PATIENCE)
            else:
                self._spin(lambda: False, 1 / RATE)
            for left, top, width, height in np.round(boxes).astype(int).tolist():
                region = RegionOfInterest(x_offset=left, y_offset=top, width=width, height=height)
                self._targets.publish(region)
                self._spin(lambda: False, 1 / RATE)  # the node's queue is ten deep
            boxes = boxes[:0]

    def _spin(self, is_done: Callable[[], bool], seconds: float) -> None:
        deadline = time.monotonic() + seconds
        while not is_done() and (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)


def measure(
    viewer: Viewer, frames: Sequence[Frame], boxes: Array, words: str, variant: str, *options: str
) -> None:
    """Print the row of one node; `variant` is empty for a node that takes images only."""
    if variant:
        viewer.hear(variant)
    with tempfile.TemporaryDirectory() as empty:
        variables = {"NUMBA_CACHE_DIR": empty} if FIRST in words else {}
        command = ["-c", CODE.format(variant), "--ros-args"] if variant else floor_words("image")
        options = "queue_depth:=10", *options
        parameters = [word for one in options if variant for word in ("-p", one)]
        with NodeProcess([*command, *parameters], variables) as node:
            viewer.show(frames, boxes[:0] if MOTION in options else boxes, is_heard=bool(variant))
            sizes = fields(node.pid)
    heard = viewer.answers
    if variant and len(heard) < len(frames) / 2:
        raise SystemExit(f"{words}: only {len(heard)} answers to {len(frames)} images")
    counts = [
        int(pair.value)
        for answer in heard
        for pair in answer.status[0].values
        if pair.key == "vehicles"
    ]
    followed = max(counts) if counts else "1" if variant else ""
    print(f"| {words} | {sizes['Rss']:.0f} | {sizes['Anonymous']:.0f} | {followed} |", flush=True)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", default="", help="nodes with this in their row")
    parser.add_argument("--images", type=int, default=IMAGES, help="images that each node gets")
    args = parser.parse_args()
    only = args.only
    with tempfile.TemporaryDirectory() as folder:
        scene = made(VEHICLES, Path(folder, "scene"), args.images)
        frames = [frame.copy() for frame in scene.frames()]
        rows = scene.detections["good"]
        boxes = rows[rows[:, 0] == 1][:, 1:5]
    viewer = Viewer(frames[0].nbytes)
    target = [f"target.{name}:={value}" for name, value in TARGET.items()]
    print("| node | resident, MB | own, MB | vehicles, at most |\n|---|---:|---:|---:|")
    nodes = (
        ("takes images, and nothing else", ""),
        ("`apf`, OpenCV's kernels", "apf", *target, "kernels:=opencv"),
        ("`apf`, numba's kernels", "apf", *target, "kernels:=numba"),
        (f"`apf`, numba's kernels, {FIRST}", "apf", *target, "kernels:=numba"),
        ("`traffic`, detection of motion", "traffic", MOTION),
        ("`traffic`, vehicles given by hand", "traffic", "detector.kind:=none"),
    )
    for words, variant, *options in nodes:
        if only in words:
            measure(viewer, frames, boxes, words, variant, *options)
    if not only:
        show_steps()


def show_steps() -> None:
    """Print the table of what loading takes step by step."""
    print("\n| a process with | resident, MB | own, MB |\n|---|---:|---:|", flush=True)
    command = [sys.executable, "-c", STEPS.format(kernels="the kernels, from the cache")]
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)  # fills the cache
    subprocess.run(command, check=True)
    with tempfile.TemporaryDirectory() as empty:
        command[-1] = STEPS.format(kernels="the kernels, compiled in this process")
        subprocess.run(command, env={**os.environ, "NUMBA_CACHE_DIR": empty}, check=True)


if __name__ == "__main__":
    main()

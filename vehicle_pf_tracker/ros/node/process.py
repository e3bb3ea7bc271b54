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

"""A process of one node, or of several: memory, exit status.

Memory for images is kept, instead of returned to the system after every one. By default glibc maps
fresh pages for each block as large as an image, and the kernel has to clear them. Keeping them
takes a third of the CPU time off a node that receives 640x480 at 30 Hz.
"""

from __future__ import annotations

import ctypes
import os
import time
import traceback
from collections import deque
from collections.abc import Callable, Sequence

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

from vehicle_pf_tracker.ros.node.kernel_loading import is_loading
from vehicle_pf_tracker.ros.process import answer_usage, end_at_once, run_process, spin_nodes

_LARGEST_BLOCK = 32 * 2**20
"""Bytes; the highest threshold that glibc takes, more than a 4K image."""

_OPTIONS = {
    "MALLOC_TRIM_THRESHOLD_": (-1, 2**30),
    "MALLOC_TOP_PAD_": (-2, 2 * _LARGEST_BLOCK),
    "MALLOC_MMAP_THRESHOLD_": (-3, _LARGEST_BLOCK),
}
"""Number and value of each of glibc's options, by its environment variable."""


def keep_image_memory() -> bool:
    """Make glibc reuse freed blocks of the size of images.

    Returns
    -------
    bool
        True if it was done: not where the C library has no such options, or where the environment
        already says what to do.
    """
    if any(name in os.environ for name in _OPTIONS):
        return False
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    taken = [mallopt(number, value) for number, value in _OPTIONS.values()]
    return all(taken)


_OVERLAY_BYTES = 1280 * 720 * 3
"""Size of the largest overlay of which the segment holds four; a larger one still fits once.
Whether the images themselves come through is decided by the camera's segment."""

_MOST_FAILURES = 20
_FAILING = 10.0
"""This many failed callbacks within this many seconds mean a broken node, not malformed requests:
it ends, so that ``respawn`` in a launch file can restart it."""

_BROKEN = "a request could not be answered:"


def run_nodes(
    name: str, makers: Sequence[Callable[[], Node]], arguments: Sequence[str], usage: str
) -> int:
    """Run nodes that take images, in turns, until a signal ends them.

    Parameters
    ----------
    name : str
        Name of the executable, for its errors.
    makers : sequence of callable
        Each makes a node.
    arguments : sequence of str
        Command line without the program's name.
    usage : str
        Answer to words that are not ROS's.

    Returns
    -------
    int
        Exit status: 0 ended by a signal, 1 a user's mistake (printed on stderr), 2 usage.
    """
    keep_image_memory()

    def serve(words: list[str]) -> int:
        if words:
            return answer_usage(name, words, usage)
        return spin_nodes(makers, _OVERLAY_BYTES, _spin, arguments)

    status = run_process(name, arguments, serve)
    if is_loading():  # a thread in LLVM would be left behind
        end_at_once(status)
    return status


def _spin(executor: SingleThreadedExecutor, node: Node) -> int:
    """Run callbacks until a signal comes; return 1 if they fail repeatedly."""
    failures: deque[float] = deque(maxlen=_MOST_FAILURES)
    while rclpy.ok():
        if not _spin_once(executor, node):
            failures.append(time.monotonic())
            if len(failures) == _MOST_FAILURES and failures[-1] - failures[0] < _FAILING:
                words = f"{_MOST_FAILURES} callbacks failed within {_FAILING:g} s: ending"
                node.get_logger().fatal(words)
                return 1
    return 0


def _spin_once(executor: SingleThreadedExecutor, node: Node) -> bool:
    try:
        executor.spin_once()
    except ExternalShutdownException:
        pass
    except Exception:  # a malformed request, from which rclpy's own services are not safe
        if rclpy.ok():
            text = traceback.format_exc()
            node.get_logger().error(f"{_BROKEN} {text}", throttle_duration_sec=1.0)
            return False
    return True


def node_usage(name: str) -> str:
    """Return how the executable `name` of one node is called."""
    return (
        f"usage: {name} [--ros-args -p NAME:=VALUE --params-file FILE -r image:=TOPIC ...]\n"
        f"`vehicle-pf-tracker params {name.removesuffix('_tracker')}` prints every parameter."
    )

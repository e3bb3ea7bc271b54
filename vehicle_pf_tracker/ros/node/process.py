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

"""A node as a process of its own: memory, executor, exit status.

Memory for images is kept, instead of returned to the system after every one. By default glibc maps
fresh pages for each block as large as an image, and the kernel has to clear them. Keeping them
takes a third of the CPU time off a node that receives 640x480 at 30 Hz.

While messages flow, the executor waits for little else. For each callback, rclpy puts every entity
of the node into a new wait set, and then into another, since a callback wakes its executor: a
managed node has over a dozen services and two dozen event handlers. That takes longer than all that
a tracker node does with an image besides tracking. Event handlers cost most, and can wait; requests
cannot.
"""

from __future__ import annotations

import ctypes
import os
import time
import traceback
from collections import deque
from collections.abc import Callable, Sequence

import rclpy
from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

from vehicle_pf_tracker.ros.node.stream import is_loading
from vehicle_pf_tracker.ros.process import answer_usage, end_at_once, run_process
from vehicle_pf_tracker.ros.rclpy_internals import (
    DirectExecutor,
    MessageSources,
    can_run_directly,
)
from vehicle_pf_tracker.ros.transport import image_transport

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


LOOK_EVERY = 0.2
"""Longest time in s that an event waits while messages flow."""


def node_executor() -> Executor:
    """Make the executor of a node's process: `ImageExecutor` where this rclpy allows it."""
    return ImageExecutor() if can_run_directly() else SingleThreadedExecutor()


class ImageExecutor(DirectExecutor):
    """A single thread that waits for messages, timers and requests alone while images flow.

    Every `LOOK_EVERY` s it serves whatever else is ready. When no message came for so long, it
    waits for everything, as its base class always does. The callbacks of subscriptions and services
    have to be plain functions, no coroutines.

    Parameters
    ----------
    context : Context, optional
        The default one unless given.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._flowing = False
        self._looking = False
        self._look_at = 0.0
        self._sources: dict[Node, MessageSources] = {}

    def add_node(self, node: Node) -> bool:
        """Add a node whose callbacks are to be run."""
        self._sources[node] = MessageSources(node)
        return bool(super().add_node(node))

    def remove_node(self, node: Node) -> None:
        """Run no more callbacks of a node."""
        self._sources.pop(node, None)
        super().remove_node(node)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and run it; without a timeout it may return without one."""
        if timeout_sec is not None or not self._flowing:
            self._flowing = isinstance(self.run_one(timeout_sec), Subscription)
            self._look_at = time.monotonic() + LOOK_EVERY
            return
        self._looking = self._looking or time.monotonic() >= self._look_at
        if not self._looking:
            self._flowing = self.run_one(LOOK_EVERY, list(self._sources.values())) is not None
        elif self.run_one(0.0) is None:  # all that was ready has been served
            self._looking = False
            self._look_at = time.monotonic() + LOOK_EVERY


_OVERLAY_BYTES = 1280 * 720 * 3
"""Size of the largest overlay of which the segment holds four; a larger one still fits once."""

_MOST_FAILURES = 20
_FAILING = 10.0
"""This many failed callbacks within this many seconds mean a broken node, not malformed requests:
it ends, so that ``respawn`` in a launch file can restart it."""

_BROKEN = "a request could not be answered:"


def run_node(name: str, make_node: Callable[[], Node], arguments: Sequence[str]) -> int:
    """Run a node that takes images until a signal ends it.

    Parameters
    ----------
    name : str
        Name of the executable, for its errors.
    make_node : callable
        Makes the node.
    arguments : sequence of str
        Command line without the program's name.

    Returns
    -------
    int
        Exit status: 0 ended by a signal, 1 a user's mistake (printed on stderr), 2 usage.
    """
    keep_image_memory()

    def serve(words: list[str]) -> int:
        return answer_usage(name, words, _usage(name)) if words else _serve(make_node)

    status = run_process(name, arguments, serve)
    if is_loading():  # a thread in LLVM would be left behind
        end_at_once(status)
    return status


def _serve(make_node: Callable[[], Node]) -> int:
    executor = node_executor()
    node = None
    try:
        # For ~/overlay; whether the frames come through is decided by the camera's segment.
        with image_transport(_OVERLAY_BYTES, rclpy.get_rmw_implementation_identifier()):
            node = make_node()
        executor.add_node(node)
        return _spin(executor, node)
    except Exception:
        if rclpy.ok():
            raise  # otherwise a signal took the ground from under a call
    finally:
        if node is not None:
            node.destroy_node()
        executor.shutdown()
    return 0


def _spin(executor: Executor, node: Node) -> int:
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


def _spin_once(executor: Executor, node: Node) -> bool:
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


def _usage(name: str) -> str:
    return (
        f"usage: {name} [--ros-args -p NAME:=VALUE --params-file FILE -r image:=TOPIC ...]\n"
        f"`vehicle-pf-tracker params {name.removesuffix('_tracker')}` prints every parameter."
    )

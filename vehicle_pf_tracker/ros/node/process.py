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

"""A node as a process of its own: arguments, signals, exit status."""

from __future__ import annotations

import sys
import time
import traceback
from collections import deque
from collections.abc import Callable, Sequence
from functools import partial

import rclpy
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node

from vehicle_pf_tracker.ros.node.allocator import keep_image_memory
from vehicle_pf_tracker.ros.node.image_executor import node_executor
from vehicle_pf_tracker.ros.node.kernel_loading import is_loading
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.ros.process import end_at_once, run_process
from vehicle_pf_tracker.ros.transport import image_transport
from vehicle_pf_tracker.trackers.registry import Variant

_OVERLAY_BYTES = 1280 * 720 * 3
"""Size of the largest overlay of which the segment holds four; a larger one still fits once."""

_MOST_FAILURES = 20
_FAILING = 10.0
"""This many failed callbacks within this many seconds mean a broken node, not malformed requests:
it ends, so that ``respawn`` in a launch file can restart it."""

_BROKEN = "a request could not be answered:"


def run_node(variant: Variant, arguments: Sequence[str]) -> int:
    """Run the node of `variant` until it is told to end.

    Parameters
    ----------
    variant : Variant
        From the registry.
    arguments : sequence of str
        Command line without the program's name.

    Returns
    -------
    int
        Exit status: 0 ended by a signal, 1 a user's mistake (printed on stderr), 2 usage.
    """
    return run_node_of(variant.executable, partial(TrackerNode, variant), arguments)


def run_node_of(name: str, make_node: Callable[[], Node], arguments: Sequence[str]) -> int:
    """Run the node that `make_node` makes; see `run_node`."""
    keep_image_memory()

    def serve(others: list[str]) -> int:
        return _usage(name, others) if others else _serve(make_node)

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


def _usage(name: str, words: Sequence[str]) -> int:
    asked = set(words) <= {"-h", "--help"}
    if not asked:
        print(f"{name}: unknown arguments: {' '.join(words)}", file=sys.stderr)
    print(
        f"usage: {name} [--ros-args -p NAME:=VALUE --params-file FILE -r image:=TOPIC ...]\n"
        f"`vehicle-pf-tracker params {name.removesuffix('_tracker')}` prints every parameter.",
        file=sys.stdout if asked else sys.stderr,
    )
    return 0 if asked else 2

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

import itertools
import os
import signal
import sys
import threading
import time
import traceback
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from types import FrameType

import rclpy
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.yaml_text import check_yaml_file
from vehicle_pf_tracker.ros.node.allocator import keep_image_memory
from vehicle_pf_tracker.ros.node.image_executor import node_executor
from vehicle_pf_tracker.ros.node.kernel_loading import is_loading
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.ros.rclpy_internals import RCLError, UnknownROSArgsError
from vehicle_pf_tracker.ros.transport import image_transport
from vehicle_pf_tracker.trackers.registry import Variant

_OVERLAY_BYTES = 1280 * 720 * 3
"""Size of the largest overlay of which the segment holds four; a larger one still fits once."""

_MOST_FAILURES = 20
_FAILING = 10.0
"""This many failed callbacks within this many seconds mean a broken node, not malformed requests:
it ends, so that ``respawn`` in a launch file can restart it."""

_BROKEN = "a request could not be answered:"


class _Interrupts:
    """Signals end the program until ROS is up; from then on rclpy's own handlers end the spin.

    `ros2 launch` sends SIGINT twice, and the second must not reach the clean-up. rclpy knows SIGINT
    and SIGTERM alone; a terminal that closes sends SIGHUP, which is turned into SIGTERM.
    """

    def __init__(self) -> None:
        self.left_to_ros = False
        signal.signal(signal.SIGINT, self)
        signal.signal(signal.SIGTERM, self)
        if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as nohup sets it
            _turn_hangup_into_termination()

    def __call__(self, number: int, frame: FrameType | None) -> None:
        if not self.left_to_ros:
            raise KeyboardInterrupt


def _turn_hangup_into_termination() -> None:
    """Send SIGTERM on SIGHUP, from a thread: Python's handlers wait while rclpy waits for messages.

    Blocking the signal instead would leave it deadly in threads that libraries have started before.
    """
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    signal.signal(signal.SIGHUP, lambda number, frame: None)
    threading.Thread(target=_await_hangup, args=(reader,), name="SIGHUP", daemon=True).start()


def _await_hangup(reader: int) -> None:
    """Read the numbers of signals until SIGHUP is one of them."""
    while os.read(reader, 1) != bytes([signal.SIGHUP]):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


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
    status = _run(variant, arguments)
    if is_loading():  # a thread in LLVM would be left behind, and may not outlive Python
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    return status


def _run(variant: Variant, arguments: Sequence[str]) -> int:
    interrupts = _Interrupts()
    name = f"{variant.name}_tracker"
    keep_image_memory()
    try:
        _check_parameter_files(arguments)
        rclpy.init(args=list(arguments))
        interrupts.left_to_ros = True
        others = remove_ros_args(list(arguments))
        return _usage(name, others) if others else _serve(variant)
    except InputError as error:
        return _fail(name, str(error))
    except (RCLError, UnknownROSArgsError) as error:
        return _fail(name, _first_sentence(error))
    finally:
        rclpy.try_shutdown()


def _check_parameter_files(arguments: Sequence[str]) -> None:
    """Refuse files in which a key is there twice, of which ROS would take the last."""
    for option, value in itertools.pairwise(arguments):
        if option == "--params-file" and Path(value).is_file():  # of others, ROS says why
            check_yaml_file(Path(value), "parameter file")


def _serve(variant: Variant) -> int:
    executor = node_executor()
    node = None
    try:
        # For ~/overlay; whether the frames come through is decided by the camera's segment.
        with image_transport(_OVERLAY_BYTES, rclpy.get_rmw_implementation_identifier()):
            node = TrackerNode(variant)
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


def _fail(name: str, sentence: str) -> int:
    print(f"{name}: {sentence}", file=sys.stderr)
    return 1


def _first_sentence(error: Exception) -> str:
    if isinstance(error, UnknownROSArgsError):
        return f"unknown ROS arguments: {error}"
    text = str(error).replace("failed to initialize rcl: ", "")
    return text.partition(", at /")[0]

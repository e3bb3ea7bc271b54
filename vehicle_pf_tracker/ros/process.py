# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A process of nodes: arguments, signals, exit status."""

from __future__ import annotations

import itertools
import os
import signal
import sys
import time
import traceback
import warnings
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from vehicle_pf_tracker.core.addresses import shown
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml, read_yaml_file
from vehicle_pf_tracker.ros.image_memory import keep_image_memory
from vehicle_pf_tracker.ros.node.kernel_loading import is_loading
from vehicle_pf_tracker.ros.node_executor import node_executor
from vehicle_pf_tracker.ros.rclpy_internals import RCLError, UnknownROSArgsError
from vehicle_pf_tracker.ros.transport import image_transport

_OVERLAY_BYTES = 1280 * 720 * 3
"""Size of the largest overlay of which the segment holds four; a larger one still fits once.
Whether the images themselves come through is decided by the camera's segment."""

_MOST_FAILURES = 20
"""Failed callbacks in short succession that end the process, so that ``respawn`` in a launch file
can restart it: one is a malformed request, twenty are a broken node."""
_FAILING = 10.0
"""The short succession, s: a person who tries requests by hand sends fewer than two a second."""


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
            # Within a second: every node has a timer that lets Python's handlers run.
            signal.signal(signal.SIGHUP, lambda *_: os.kill(os.getpid(), signal.SIGTERM))

    def __call__(self, number: int, frame: FrameType | None) -> None:
        if not self.left_to_ros:
            raise KeyboardInterrupt


def run_process(name: str, arguments: Sequence[str], serve: Callable[[list[str]], int]) -> int:
    """Run `serve` between the start of ROS and its end.

    Parameters
    ----------
    name : str
        Name of the executable, for its errors.
    arguments : sequence of str
        Command line without the program's name.
    serve : callable
        Gets the words that are not ROS's, and returns the exit status.

    Returns
    -------
    int
        Exit status: that of `serve`, or 1 for a user's mistake (printed on stderr).
    """
    interrupts = _Interrupts()
    # rclpy's words where a signal comes while a node is made; the node is not missed.
    warnings.filterwarnings("ignore", "Failed to fini rosout publisher", RuntimeWarning)
    try:
        for path in _parameter_files(arguments):  # of a key that is there twice, ROS takes the last
            read_yaml_file(path, "parameter file")
        rclpy.init(args=list(arguments))
        interrupts.left_to_ros = True
        return serve(remove_ros_args(list(arguments)))
    except InputError as error:
        reason = str(error)
    except (RCLError, UnknownROSArgsError) as error:
        if interrupts.left_to_ros and not rclpy.ok():
            return 0  # a signal took the ground from under a call
        reason = _first_sentence(error)
    finally:
        rclpy.try_shutdown()
    print(f"{name}: {reason}", file=sys.stderr)
    return 1


def answer_usage(name: str, words: Sequence[str], usage: str) -> int:
    """Print how a program is called, and which of `words` it does not know; return its status."""
    is_asked = set(words) <= {"-h", "--help"}
    if not is_asked:
        unknown = " ".join(map(shown, words))
        print(f"{name}: unknown arguments: {unknown}", file=sys.stderr)
    print(usage, file=sys.stdout if is_asked else sys.stderr)
    return 0 if is_asked else 2


NodeT = TypeVar("NodeT", bound=Node)


def spin_nodes(
    makers: Sequence[Callable[[], NodeT]],
    image_bytes: int,
    spin: Callable[[SingleThreadedExecutor, NodeT], int],
    arguments: Sequence[str],
) -> int:
    """Make nodes, run `spin`, and destroy the nodes.

    Parameters
    ----------
    makers : sequence of callable
        Each makes a node.
    image_bytes : int
        Size of the images of which shared memory should have room for some.
    spin : callable
        Runs the callbacks of all, and logs as the first; returns the exit status.
    arguments : sequence of str
        Command line without the program's name.

    Returns
    -------
    int
        That of `spin`; 0 where a signal took the ground from under a call.
    """
    executor = node_executor()
    nodes = list[NodeT]()
    try:
        with image_transport(image_bytes, rclpy.get_rmw_implementation_identifier()) as notices:
            for make in makers:
                nodes.append(make())
                executor.add_node(nodes[-1])
        for notice in [*notices, *_files_for_others(arguments, nodes)]:
            nodes[0].get_logger().warning(notice)
        return spin(executor, nodes[0])
    except Exception:
        if rclpy.ok():
            raise
    finally:
        for node in nodes:
            node.destroy_node()
        executor.shutdown()
    return 0


def end_at_once(status: int) -> None:
    """End the process where a thread that cannot be ended would outlive Python."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def _parameter_files(arguments: Sequence[str]) -> Iterator[Path]:
    for option, value in itertools.pairwise(arguments):
        if option == "--params-file" and Path(value).is_file():  # of others, ROS says why
            yield Path(value)


def _files_for_others(arguments: Sequence[str], nodes: Sequence[Node]) -> Iterator[str]:
    """Say which parameter files have nothing for these nodes: ROS passes over them."""
    for path in _parameter_files(arguments):
        refusals = []
        for node in nodes:
            try:
                read_yaml(path, node.get_fully_qualified_name())
            except InputError as error:  # noqa: PERF203 - of a node or two
                refusals.append(str(error))
        if len(refusals) == len(nodes):
            yield refusals[0]


def _first_sentence(error: Exception) -> str:
    if isinstance(error, UnknownROSArgsError):
        return f"unknown ROS arguments: {error}"
    text = str(error).replace("failed to initialize rcl: ", "")
    return text.partition(", at /")[0]


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
        try:
            executor.spin_once()
        except Exception:  # a malformed request, from which rclpy's own services are not safe
            if not rclpy.ok():
                break  # a signal took the ground from under a call
            words = f"a request could not be answered: {traceback.format_exc()}"
            node.get_logger().error(words, throttle_duration_sec=1.0)
            failures.append(time.monotonic())
        if len(failures) == _MOST_FAILURES and failures[-1] - failures[0] < _FAILING:
            words = f"{_MOST_FAILURES} callbacks failed within {_FAILING:g} s: ending"
            node.get_logger().fatal(words)
            return 1
    return 0


def node_usage(name: str) -> str:
    """Return how the executable `name` of one node is called."""
    return (
        f"usage: {name} [--ros-args -p NAME:=VALUE --params-file FILE -r image:=TOPIC ...]\n"
        f"`vehicle-pf-tracker params {name.removesuffix('_tracker')}` prints every parameter."
    )

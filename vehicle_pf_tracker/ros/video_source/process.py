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

"""The executable `video_source`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

from vehicle_pf_tracker.ros.process import end_at_once, run_process
from vehicle_pf_tracker.ros.transport import image_transport
from vehicle_pf_tracker.ros.video_source.source_node import VideoSourceNode

_NAME = "video_source"
_IMAGE_BYTES = 1920 * 1080 * 3
"""Size of an image of which the segment holds four; one of 4K still fits once."""
_LAST_WAIT = 2.0
"""Seconds that the thread gets to end; one that waits for a silent camera is left behind."""
_LOOK_EVERY = 0.1
"""Seconds between two looks whether the source has ended."""
_USAGE = """\
usage: video_source SOURCE [--ros-args -p NAME:=VALUE -r image:=TOPIC ...]
SOURCE is a video file, a folder of images, a camera's index or a stream's URL. Parameters: source,
fps, loop, frame_id, compressed, jpeg_quality, camera_info_url."""


def run_video_source(arguments: Sequence[str]) -> int:
    """Publish a source until it ends or a signal comes.

    Parameters
    ----------
    arguments : sequence of str
        Command line without the program's name.

    Returns
    -------
    int
        Exit status: 0 ended by a signal or at the end of a file, 1 a source that cannot be read
        (printed on stderr), 2 usage.
    """
    is_left_behind = False

    def serve(words: list[str]) -> int:
        nonlocal is_left_behind
        if len(words) > 1 or any(word.startswith("-") for word in words):
            return _usage(words)
        status, is_left_behind = _serve(*words)
        return status

    status = run_process(_NAME, arguments, serve)
    if is_left_behind:
        end_at_once(status)
    return status


def _serve(source: str = "") -> tuple[int, bool]:
    """Return the exit status, and whether a thread was left behind."""
    executor = SingleThreadedExecutor()
    node = None
    try:
        with image_transport(_IMAGE_BYTES, rclpy.get_rmw_implementation_identifier()) as notices:
            node = VideoSourceNode(source)
        for notice in notices:
            node.get_logger().warning(notice)
        executor.add_node(node)
        while rclpy.ok() and not node.is_done:
            executor.spin_once(timeout_sec=_LOOK_EVERY)
    except ExternalShutdownException:
        pass
    except Exception:
        if rclpy.ok():
            raise  # otherwise a signal took the ground from under a call
    finally:
        executor.shutdown()
    return _end(node) if node is not None else (0, False)


def _end(node: VideoSourceNode) -> tuple[int, bool]:
    """End the node, also beside a thread that waits: else its shared memory would stay."""
    has_ended = node.stop(_LAST_WAIT)
    node.destroy_node()
    if node.problem:
        print(f"{_NAME}: {node.problem}", file=sys.stderr)
    return (1 if node.problem else 0), not has_ended


def _usage(words: Sequence[str]) -> int:
    is_asked = set(words) <= {"-h", "--help"}
    if not is_asked:
        print(f"{_NAME}: unknown arguments: {' '.join(words)}", file=sys.stderr)
    print(_USAGE, file=sys.stdout if is_asked else sys.stderr)
    return 0 if is_asked else 2

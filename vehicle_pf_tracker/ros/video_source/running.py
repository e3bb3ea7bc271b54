# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The executable `video_source`: arguments, the spin until the source ends, exit status."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import rclpy
from rclpy.executors import SingleThreadedExecutor

from vehicle_pf_tracker.ros.process import answer_usage, end_at_once, run_process, spin_nodes
from vehicle_pf_tracker.ros.video_source.source_node import NODE_NAME, VideoSourceNode

_IMAGE_BYTES = 1920 * 1080 * 3
"""Size of an image of which the segment holds four; one of 4K still fits once."""
_LAST_WAIT = 2.0
"""Seconds that the thread gets to end; one that waits for a silent camera is left behind."""
_LOOK_EVERY = 0.1
"""Seconds between two looks whether the source has ended."""
_USAGE = """\
usage: video_source SOURCE [--ros-args -p NAME:=VALUE -r image:=TOPIC ...]
SOURCE is a video file, a folder of images, a camera's index or a stream's URL. Parameters: source,
fps, loop, frame_id."""


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

    def serve(words: list[str]) -> int:
        if len(words) > 1 or any(word.startswith("-") for word in words):
            return answer_usage(NODE_NAME, words, _USAGE)
        return spin_nodes([lambda: VideoSourceNode(*words)], _IMAGE_BYTES, _spin, arguments)

    return run_process(NODE_NAME, arguments, serve)


def _spin(executor: SingleThreadedExecutor, node: VideoSourceNode) -> int:
    """Run callbacks until the source has ended or a signal comes, then end the thread."""
    try:
        while rclpy.ok() and not node.is_done:
            executor.spin_once(timeout_sec=_LOOK_EVERY)
    except Exception:
        if rclpy.ok():
            raise  # otherwise a signal took the ground from under a call
    has_ended = node.stop(_LAST_WAIT)
    status = 1 if node.problem else 0
    if node.problem:
        print(f"{NODE_NAME}: {node.problem}", file=sys.stderr)
    if not has_ended:  # it waits for a silent camera; the node's shared memory would stay
        node.destroy_node()
        rclpy.try_shutdown()
        end_at_once(status)
    return status

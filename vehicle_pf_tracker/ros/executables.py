# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The programs behind all nodes: ``<variant>_tracker`` runs the variant in its name.

``vehicle_tracker --variant NAME`` runs any, a plug-in's for instance, and ``--cameras FILE`` one
for each camera of a file, all in this process.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.core.errors import InputError

if TYPE_CHECKING:
    from rclpy.node import Node

    from vehicle_pf_tracker.trackers.registry import Variant

_VIDEO = "video_source"
"""Name of the one executable that is no tracker."""
_ANY = "vehicle"
"""``vehicle_tracker`` without its ending: runs the variant, or cameras, that its options name."""
_USAGE = "usage: vehicle_tracker (--variant NAME | --cameras FILE) [--ros-args ...]"
_NO_ROS = (
    "ROS 2 was not found (no module {}): source its setup.bash, or install this package with the "
    "extra [ros]"
)


def main(variant: str | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node of a variant, of `traffic`, or `video_source`.

    It imports late, so that a signal while libraries load ends the program without a traceback.

    Parameters
    ----------
    variant : str, optional
        Name in the registry, ``video_source`` or ``vehicle``; that of the running executable if
        left out.
    args : sequence of str, optional
        Command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.process.run_nodes`.
    """
    name = variant or Path(sys.argv[0]).stem.removesuffix("_tracker")
    program = name if name == _VIDEO else f"{name}_tracker"
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _run(name, sys.argv[1:] if args is None else args)
    except InputError as error:
        reason = str(error)
    except ModuleNotFoundError as error:
        reason = _NO_ROS.format(error.name)
    except MemoryError:
        reason = "there is not enough memory"
    except KeyboardInterrupt:
        return 0
    print(f"{program}: {reason}", file=sys.stderr)
    return 1


video_source = main
"""Entry point of the executable of that name."""


def _run(name: str, words: Sequence[str]) -> int:
    if name == _VIDEO:
        from vehicle_pf_tracker.ros.video_source.running import run_video_source  # noqa: PLC0415

        return run_video_source(words)
    if name == _ANY and words[:1] != ["--variant"]:
        return _run_cameras(words)
    if name == _ANY:
        name = words[1] if len(words) > 1 else ""
        words = words[2:]
    from vehicle_pf_tracker.trackers.registry import find_node  # noqa: PLC0415

    found = find_node(name)
    from vehicle_pf_tracker.ros.process import node_usage, run_nodes  # noqa: PLC0415

    usage = node_usage(found.executable)
    return run_nodes(found.executable, [_maker(found)], words, usage)


def _run_cameras(words: Sequence[str]) -> int:
    from vehicle_pf_tracker.ros.process import answer_usage  # noqa: PLC0415

    if words[:1] != ["--cameras"] or len(words) < 2:
        return answer_usage(f"{_ANY}_tracker", words, _USAGE)
    from vehicle_pf_tracker.ros.camera_file import read_cameras  # noqa: PLC0415
    from vehicle_pf_tracker.ros.process import run_nodes  # noqa: PLC0415
    from vehicle_pf_tracker.trackers.registry import find_node  # noqa: PLC0415

    makers = [
        partial(
            _maker(find_node(camera.variant)), namespace=camera.name, cli_args=camera.arguments()
        )
        for camera in read_cameras(words[1])
    ]
    return run_nodes(f"{_ANY}_tracker", makers, words[2:], _USAGE)


def _maker(found: Variant) -> Callable[..., Node]:
    """Return what makes the node of a variant, from the options of `rclpy.node.Node`."""
    from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT  # noqa: PLC0415

    if found is TRAFFIC_VARIANT:
        from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode  # noqa: PLC0415

        return TrafficNode
    from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode  # noqa: PLC0415

    return partial(TrackerNode, found)

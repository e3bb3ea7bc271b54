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
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

_VIDEO = "video_source"
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
        Name in the registry, or ``video_source``; that of the running executable if left out.
    args : sequence of str, optional
        Command line without the program's name; that of the process if left out.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.node.process.run_node`.
    """
    name = variant or Path(sys.argv[0]).stem.removesuffix("_tracker")
    program = name if name == _VIDEO else f"{name}_tracker"
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _run(name, sys.argv[1:] if args is None else args)
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


video_source = main
"""Entry point of the executable of that name."""


def _run(name: str, words: Sequence[str]) -> int:
    if name == _VIDEO:
        from vehicle_pf_tracker.ros.video_source.source_node import run_video_source  # noqa: PLC0415

        return run_video_source(words)
    from vehicle_pf_tracker.trackers.registry import TRAFFIC, find_node  # noqa: PLC0415

    found = find_node(name)
    from vehicle_pf_tracker.ros.node.process import run_node  # noqa: PLC0415

    if found is TRAFFIC:
        from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode  # noqa: PLC0415

        return run_node(found.executable, TrafficNode, words)
    from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode  # noqa: PLC0415

    return run_node(found.executable, partial(TrackerNode, found), words)

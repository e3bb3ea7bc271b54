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

"""`set-target`: give a running node its target, where there is no `ros2 topic pub`."""

from __future__ import annotations

import argparse
import math

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.parameter_options import parse_box
from vehicle_pf_tracker.cli.shared_options import add_ros_args


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add("node", metavar="NODE", help="name of the node, with its namespace: front/apf_tracker")
    add(
        "box", type=parse_box, metavar="X,Y,W,H",
        help="box of the vehicle in px of the image, top-left corner and size",
    )  # fmt: skip
    add(
        "--timeout", type=_positive, default=10.0, metavar="S",
        help="longest wait for the node in seconds (default: 10)",
    )  # fmt: skip
    add_ros_args(parser)


def run(args: argparse.Namespace) -> int:
    """Publish the target and say so.

    Raises
    ------
    UsageError
        If the box has no area.
    """
    if args.box.width <= 0 or args.box.height <= 0:
        raise UsageError(f"the box {args.box} has no area; give x,y,w,h with w and h above 0")
    from vehicle_pf_tracker.ros.target_request import set_target

    name = set_target(args.node, args.box, args.timeout, args.ros_args)
    print(f"{name} has got the target {args.box}: it starts with the next image")
    return 0


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number above 0")
    return value

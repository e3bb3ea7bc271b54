# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`set-target`: give a running node its target, where there is no `ros2 topic pub`."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.requests import positional
from vehicle_pf_tracker.cli.shared_options import RosOptions
from vehicle_pf_tracker.cli.target_options import parse_box
from vehicle_pf_tracker.core.box import Box


@dataclass(frozen=True, kw_only=True)
class Request(RosOptions):
    """Request of `set-target`."""

    node: str = positional(
        metavar="NODE", help="name of the node, with its namespace: front/apf_tracker"
    )
    box: Box = positional(
        type=parse_box, metavar="X,Y,W,H",
        help="box of the vehicle in px of the image, top-left corner and size",
    )  # fmt: skip


def run(request: Request) -> int:
    """Publish the target and print that it has arrived.

    Raises
    ------
    UsageError
        If the box has no area.
    """
    if request.box.width <= 0 or request.box.height <= 0:
        raise UsageError(f"the box {request.box} has no area; give x,y,w,h with w and h above 0")
    from vehicle_pf_tracker.ros.target_request import set_target

    name = set_target(request.node, request.box, request.timeout, request.ros_args)
    print(f"{name} has the target {request.box}: it starts with the next image")
    return 0

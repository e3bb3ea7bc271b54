# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Targets read from messages, px, with every number checked."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import RegionOfInterest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError

_UPRIGHT = 1e-3
"""Angle of a box that counts as upright, rad: over 1000 px it moves a corner by a pixel."""


def finite(topic: str, *numbers: float) -> tuple[float, ...]:
    """Return numbers that came on a topic.

    Raises
    ------
    InputError
        If one is not finite.
    """
    if not all(map(math.isfinite, numbers)):
        raise InputError(f"{topic} got a number that is not finite; give pixels of the image")
    return numbers


def box_of_region(region: RegionOfInterest) -> Box:
    """Return the region as a box."""
    return Box(*map(float, (region.x_offset, region.y_offset, region.width, region.height)))


def box_of_polygon(message: PolygonStamped) -> Box:
    """Return the upright box around the polygon's corners.

    Raises
    ------
    InputError
        If there are too few corners, or one is not finite.
    """
    points = message.polygon.points
    if len(points) < 2:
        raise InputError(
            f"~/set_box got a polygon of {len(points)} corners; give the four corners of the box"
        )
    across = finite("~/set_box", *(point.x for point in points))
    down = finite("~/set_box", *(point.y for point in points))
    left = min(across)
    top = min(down)
    return Box(left, top, max(across) - left, max(down) - top)


def box_of_point(message: PointStamped, like: Box | None) -> Box:
    """Return the box of the size of `like` around the point; None where there is no box yet.

    Raises
    ------
    InputError
        If the point is not finite, or there is no box whose size to take.
    """
    x, y = finite("~/clicked_point", message.point.x, message.point.y)
    if like is None:
        raise InputError(
            "~/clicked_point has no box size to take yet; give a box on ~/set_target first, "
            "or set the parameters target.width and target.height"
        )
    return Box.around((x, y), like.width, like.height)


def box_of_detection(message: Any) -> Box:
    """Return the box of a vision_msgs/Detection2D.

    Raises
    ------
    InputError
        If a number is not finite, or the box is turned.
    """
    topic = "~/set_detection"
    box = message.bbox
    at = box.center.position
    theta = box.center.theta
    x, y, _, width, height = finite(topic, at.x, at.y, theta, box.size_x, box.size_y)
    if abs(theta) > _UPRIGHT:
        raise InputError(f"{topic} got a box turned by {theta:g} rad; boxes must be upright")
    return Box.around((x, y), float(width), float(height))

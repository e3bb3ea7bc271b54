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

"""Target messages as boxes, px."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import RegionOfInterest
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError


def box_of_region(region: RegionOfInterest) -> Box:
    """Return the region as a box."""
    return Box(
        float(region.x_offset), float(region.y_offset), float(region.width), float(region.height)
    )


def box_of_polygon(message: PolygonStamped, image_frame: str | None, suffix: str = "") -> Box:
    """Return the upright box around the polygon's corners.

    Parameters
    ----------
    message : PolygonStamped
        In pixels of the image.
    image_frame : str or None
        The images' `frame_id`; None if none has come yet.
    suffix : str
        Suffix of the `frame_id` in the node's own outputs, accepted too.

    Raises
    ------
    InputError
        If there are too few corners, one is not finite, or they are given in another frame.
    """
    check_frame_id("~/set_box", message.header, image_frame, suffix)
    corners = [(point.x, point.y) for point in message.polygon.points]
    if len(corners) < 2:
        raise InputError(
            f"~/set_box got a polygon of {len(corners)} corners; give the four corners of the box"
        )
    _check_finite("~/set_box", *(number for corner in corners for number in corner))
    left, top = (min(numbers) for numbers in zip(*corners, strict=True))
    right, bottom = (max(numbers) for numbers in zip(*corners, strict=True))
    return Box(left, top, right - left, bottom - top)


def box_of_point(
    message: PointStamped, image_frame: str | None, like: Box | None, suffix: str = ""
) -> Box:
    """Return the box of the size of `like` around the point.

    Parameters
    ----------
    message : PointStamped
        In pixels of the image.
    image_frame : str or None
        The images' `frame_id`; None if none has come yet.
    like : Box or None
        The present box; None if there is none.
    suffix : str
        Suffix of the `frame_id` in the node's own outputs, accepted too.

    Raises
    ------
    InputError
        If the point is not finite or in another frame, or there is no box whose size to take.
    """
    check_frame_id("~/clicked_point", message.header, image_frame, suffix)
    _check_finite("~/clicked_point", message.point.x, message.point.y)
    if like is None:
        raise InputError(
            "~/clicked_point has no box size to take yet; give a box on ~/set_target first, "
            "or set the parameters target.width and target.height"
        )
    return Box.around((message.point.x, message.point.y), like.width, like.height)


_UPRIGHT = 1e-3
"""Angle of a box that counts as upright, rad: over 1000 px it moves a corner by a pixel."""


def box_of_detection(message: Any, image_frame: str | None, suffix: str = "") -> Box:
    """Return the box of a vision_msgs/Detection2D.

    Parameters
    ----------
    message : Detection2D
        In pixels of the image.
    image_frame : str or None
        The images' `frame_id`; None if none has come yet.
    suffix : str
        Suffix of the `frame_id` in the node's own outputs, accepted too.

    Raises
    ------
    InputError
        If a number is not finite, the box is turned, or it is given in another frame.
    """
    topic, box = "~/set_detection", message.bbox
    check_frame_id(topic, message.header, image_frame, suffix)
    centre = box.center.position.x, box.center.position.y
    _check_finite(topic, *centre, box.center.theta, box.size_x, box.size_y)
    if abs(box.center.theta) > _UPRIGHT:
        raise InputError(
            f"{topic} got a box turned by {box.center.theta:g} rad; boxes must be upright"
        )
    return Box.around(centre, float(box.size_x), float(box.size_y))


def check_frame_id(topic: str, header: Header, image_frame: str | None, suffix: str) -> None:
    """Refuse a position in another frame than that of the images.

    Raises
    ------
    InputError
        If it is.
    """
    if image_frame is not None and header.frame_id not in ("", image_frame, image_frame + suffix):
        raise InputError(
            f"{topic} got a target in the frame {header.frame_id!r}; give it in pixels of the "
            f"image, with the image's frame_id {image_frame!r} or none"
        )


def _check_finite(topic: str, *numbers: float) -> None:
    if not all(map(math.isfinite, numbers)):
        raise InputError(f"{topic} got a number that is not finite; give pixels of the image")

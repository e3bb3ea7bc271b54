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

"""Messages that a node takes: targets as boxes, px, and the camera's lens and pose."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped, Transform
from sensor_msgs.msg import CameraInfo, RegionOfInterest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.camera import FIRST_PIXEL, Lens, Pose

_COEFFICIENTS = {"rational_polynomial": 8, "equidistant": 4}
"""Numbers of coefficients of a model; what a driver writes after them must be zero."""
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
    left, top = min(across), min(down)
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
    topic, box = "~/set_detection", message.bbox
    at, theta = box.center.position, box.center.theta
    x, y, _, width, height = finite(topic, at.x, at.y, theta, box.size_x, box.size_y)
    if abs(theta) > _UPRIGHT:
        raise InputError(f"{topic} got a box turned by {theta:g} rad; boxes must be upright")
    return Box.around((x, y), float(width), float(height))


@dataclass(frozen=True, slots=True)
class ImageLens:
    """Lens of a camera, and the size of the images that it is for, px."""

    lens: Lens
    size: tuple[int, int]


def lens_of_info(message: CameraInfo, *, rectified: bool) -> ImageLens:
    """Read the lens of a CameraInfo, for the images that it goes with: binned and cut out.

    Parameters
    ----------
    message : CameraInfo
        Calibration of the camera.
    rectified : bool
        True for images that were rectified: they have the projection matrix, and no distortion.

    Raises
    ------
    InputError
        If the camera is not calibrated, or its model is not known.
    """
    matrix = message.p if rectified else message.k
    fx, cx, fy, cy = (matrix[0], matrix[2], matrix[5], matrix[6]) if rectified else (
        matrix[0], matrix[2], matrix[4], matrix[5]
    )  # fmt: skip
    if not (fx > 0 and fy > 0):
        raise InputError("camera_info has no calibration: its focal length is not above 0")
    across, down = max(message.binning_x, 1), max(message.binning_y, 1)
    left, top = message.roi.x_offset, message.roi.y_offset
    model, coefficients = _distortion(message, rectified=rectified)
    lens = Lens(
        (fx / across, fy / down),
        (_binned(cx, left, across), _binned(cy, top, down)),
        model,
        coefficients,
    )
    width, height = message.roi.width or message.width, message.roi.height or message.height
    return ImageLens(lens, (width // across, height // down))


def _distortion(message: CameraInfo, *, rectified: bool) -> tuple[str, tuple[float, ...]]:
    coefficients = tuple(map(float, message.d))
    if rectified or (not any(coefficients) and message.distortion_model != "equidistant"):
        return "none", ()
    count = _COEFFICIENTS.get(message.distortion_model, len(coefficients))
    if any(coefficients[count:]):
        raise InputError(
            f"camera_info has {len(coefficients)} coefficients of {message.distortion_model}; "
            f"those after the first {count} must be 0"
        )
    return message.distortion_model, coefficients[:count]


def _binned(centre: float, offset: int, factor: int) -> float:
    """Move a principal point to a part of the image, and bin it; pixels have corners."""
    return (centre + FIRST_PIXEL - offset) / factor - FIRST_PIXEL


def pose_of_transform(transform: Transform) -> Pose:
    """Read the pose of the child frame of a transform in its parent.

    Raises
    ------
    InputError
        If it is not a rigid transform.
    """
    at, turn = transform.translation, transform.rotation
    return Pose.of((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))

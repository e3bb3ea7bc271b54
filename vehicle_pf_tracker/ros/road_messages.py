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

"""CameraInfo, TF and places on the road, to and from messages."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped, Transform, Vector3Stamped
from sensor_msgs.msg import CameraInfo
from std_msgs.msg import Header

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.camera import FIRST_PIXEL, Lens, Pose

UNKNOWN_ANGLE = math.pi**2 / 3
"""Variance of an angle that nothing is known of, rad²."""
_COEFFICIENTS = {"rational_polynomial": 8, "equidistant": 4}
"""Numbers of coefficients of a model; what a driver writes after them must be zero."""


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


def place_message(header: Header, position: Array) -> PointStamped:
    """Make a place on the road, m; z = 0."""
    message = PointStamped(header=header)
    message.point.x, message.point.y = map(float, position)
    return message


def road_velocity_message(header: Header, velocity: Array) -> Vector3Stamped:
    """Make a velocity on the road, m/s."""
    message = Vector3Stamped(header=header)
    message.vector.x, message.vector.y = map(float, velocity)
    return message


def pose_message(header: Header, position: Array, covariance: Array) -> PoseWithCovarianceStamped:
    """Make a position with its covariance (2, 2), in px or m; nothing is known of its heading."""
    message = PoseWithCovarianceStamped(header=header)
    pose = message.pose
    pose.pose.position.x, pose.pose.position.y = map(float, position)
    pose.pose.orientation.w = 1.0
    rows, numbers = covariance.tolist(), [0.0] * 36
    numbers[0:2], numbers[6:8] = rows[0], rows[1]
    numbers[21] = numbers[28] = numbers[35] = UNKNOWN_ANGLE
    pose.covariance = numbers
    return message

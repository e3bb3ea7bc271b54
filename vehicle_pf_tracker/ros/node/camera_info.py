# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lens of a camera as its camera_info states it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from sensor_msgs.msg import CameraInfo

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.lens import FIRST_PIXEL, Lens

_COEFFICIENTS = {"rational_polynomial": 8, "equidistant": 4}
"""Numbers of coefficients of a model; what a driver writes after them must be zero."""


@dataclass(frozen=True, slots=True)
class ImageLens:
    """Lens of a camera, and the size of the images that it is for, px."""

    lens: Lens
    size: tuple[int, int]


def lens_of_info(message: CameraInfo, *, rectified: bool) -> ImageLens:
    """Read the lens of a CameraInfo, for the images that it goes with: binned and cut out.

    image_geometry does the same, but is in apt only, as tf2_ros is.

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
    rows = np.reshape(message.p if rectified else message.k, (3, -1)).tolist()
    (fx, _, cx, *_), (_, fy, cy, *_) = rows[:2]
    if not (fx > 0 and fy > 0):
        raise InputError("camera_info has no calibration: its focal length is not above 0")
    # A driver that does not bin leaves 0.
    across = max(message.binning_x, 1)
    down = max(message.binning_y, 1)
    model, coefficients = _distortion(message, rectified=rectified)
    centre = _binned(cx, message.roi.x_offset, across), _binned(cy, message.roi.y_offset, down)
    lens = Lens((fx / across, fy / down), centre, model, coefficients)
    # Cut out first, then binned: the order in which CameraInfo defines them.
    width = message.roi.width or message.width  # 0 of a whole image
    height = message.roi.height or message.height
    return ImageLens(lens, (width // across, height // down))


def _distortion(message: CameraInfo, *, rectified: bool) -> tuple[str, tuple[float, ...]]:
    # A model with all coefficients 0 is no distortion, but for the fisheye, whose mapping is
    # another one even then.
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

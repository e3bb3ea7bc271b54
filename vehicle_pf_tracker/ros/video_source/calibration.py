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

"""A camera's calibration file, as ROS's `camera_calibration` writes it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from sensor_msgs.msg import CameraInfo

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.yaml_text import read_yaml_file

_LARGEST_SIDE = 2**15
"""Largest side of an image, px: that of images that trackers take."""


def read_calibration(url: str) -> CameraInfo:
    """Read a calibration.

    Parameters
    ----------
    url : str
        Path of the YAML file, or ``file://`` and its absolute path, as `camera_info_url` of camera
        drivers has it.

    Raises
    ------
    InputError
        If it cannot be read, or lacks something.
    """
    path = _path(url)
    document = read_yaml_file(path, "calibration")
    if not isinstance(document, dict):
        raise InputError(f"the calibration {path} is not a mapping of names to values")
    try:
        return _camera_info(document)
    except InputError as error:
        raise InputError(f"the calibration {path}: {error}") from None


def _path(url: str) -> Path:
    parts = urlsplit(url)
    if not parts.scheme:
        return Path(url)
    if parts.scheme != "file" or parts.netloc:
        raise InputError(f"the calibration {url} is neither a path nor a file:///URL")
    return Path(unquote(parts.path))


def _camera_info(document: dict[str, Any]) -> CameraInfo:
    matrix = _numbers(document, "camera_matrix", 9)
    identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    projection = [*matrix[:3], 0.0, *matrix[3:6], 0.0, *matrix[6:], 0.0]
    return CameraInfo(
        width=_side(document, "image_width"),
        height=_side(document, "image_height"),
        distortion_model=str(document.get("distortion_model", "plumb_bob")),
        d=_numbers(document, "distortion_coefficients", None, []),
        k=matrix,
        r=_numbers(document, "rectification_matrix", 9, identity),
        p=_numbers(document, "projection_matrix", 12, projection),
    )


def _side(document: dict[str, Any], name: str) -> int:
    value = document.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 < value <= _LARGEST_SIDE:
        raise InputError(f"{name} is not an integer from 1 to {_LARGEST_SIDE} px")
    return value


def _numbers(
    document: dict[str, Any], name: str, count: int | None, default: list[float] | None = None
) -> list[float]:
    """Return the values of a matrix; of any number where `count` is None."""
    if name not in document and default is not None:
        return default
    entry = document.get(name)
    values = entry.get("data") if isinstance(entry, dict) else entry
    if not isinstance(values, list) or (count is not None and len(values) != count):
        raise InputError(f"{name} has no data of {count or 'its'} numbers")
    for value in values:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not math.isfinite(value):
            raise InputError(f"{name} has {value!r}, which is not a number")
    return [float(value) for value in values]

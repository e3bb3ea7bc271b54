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

"""Parameters of the video source, all of them for its start."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.footage import HIGHEST_FPS, LOWEST_FPS

_SPECS: dict[str, tuple[object, str]] = {
    "source": ("", "A video file, a folder of images, a camera's index, a stream's URL"),
    "fps": (0.0, "Frame rate of a folder or a video, 1/s; 0 takes what it states"),
    "loop": (False, "Begin a video or a folder again at its end"),
    "frame_id": ("camera", "Frame of the images' headers"),
    "compressed": (False, "Publish JPEG images too, on image/compressed"),
    "jpeg_quality": (95, "Of these, 1 to 100"),
    "camera_info_url": ("", "Calibration YAML, a path or file:///URL; published as camera_info"),
}
_RANGES = {"jpeg_quality": {"integer_range": [IntegerRange(from_value=1, to_value=100, step=1)]}}


def declare(node: Node) -> dict[str, Any]:
    """Declare the parameters of `node` and return their values, by name.

    Raises
    ------
    InputError
        Naming the parameter that has a wrong value.
    """
    values = {name: _declared(node, name) for name in _SPECS}
    fps = values["fps"]
    if not isinstance(fps, int | float) or (fps and not LOWEST_FPS <= fps <= HIGHEST_FPS):
        raise InputError(
            f"the parameter fps is neither 0 nor from {LOWEST_FPS:g} to {HIGHEST_FPS:g} images per "
            f"second: {fps!r}"
        )
    return values


def _declared(node: Node, name: str) -> Any:
    default, description = _SPECS[name]
    descriptor = ParameterDescriptor(
        description=description,
        read_only=True,
        # A camera's index and a whole frame rate are integers on a command line.
        dynamic_typing=name in {"source", "fps"},
        **_RANGES.get(name, {}),
    )
    try:
        return node.declare_parameter(name, default, descriptor).value
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise InputError(f"the parameter {name} cannot have this value: {error}") from None

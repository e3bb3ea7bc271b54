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

"""Images of a source as they go out: when they are due, their publishers and calibration."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import cv2
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.parameters.files import read_yaml_file
from vehicle_pf_tracker.ros.messages import image_message, packed

_DEPTH = 5
"""Images kept for a slow subscriber. Reliable, since that serves both kinds of subscribers."""


class Pace:
    """Stamps for the images of one pass through a source.

    Images of a file keep the intervals that it states: the first is stamped by the clock, and the
    others follow, so that stamps do not carry the jitter of this process. Live images are stamped
    by the clock as they come.

    Parameters
    ----------
    clock : callable
        Returns the present time in ns.
    stop : threading.Event
        Ends every wait.
    """

    def __init__(self, clock: Callable[[], int], stop: threading.Event) -> None:
        self._clock, self._stop, self._is_live = clock, stop, False
        self._began: tuple[int, int, float] | None = None
        self.last = 0

    def begin(self, *, is_live: bool) -> None:
        """Begin a pass, of images that come by themselves where `is_live`."""
        self._began, self._is_live = None, is_live

    def stamp(self, recorded_ns: int) -> int:
        """Return the stamp of an image with the source's own time, once it is due.

        It is later than any before. Returns early when the process ends.
        """
        if self._is_live:
            self.last = max(self._clock(), self.last + 1)
            return self.last
        if self._began is None:
            self._began = recorded_ns, max(self._clock(), self.last + 1), time.monotonic()
        first, stamped, when = self._began
        passed = recorded_ns - first
        self._stop.wait(max(when + passed / 1e9 - time.monotonic(), 0.0))
        self.last = stamped + passed
        return self.last


class ImageOutputs:
    """Publishes images, and what belongs to them; what nobody subscribes to is not made.

    Parameters
    ----------
    node : Node
        The node.
    jpeg_quality : int or None
        Quality of compressed images, 1 to 100; None publishes none.
    calibration : CameraInfo or None
        Published with each image of its size.
    """

    def __init__(
        self, node: Node, *, jpeg_quality: int | None, calibration: CameraInfo | None
    ) -> None:
        self._node, self._jpeg_quality, self._calibration = node, jpeg_quality, calibration
        self._image = _publisher(node, Image, "image")
        self._compressed: Publisher | None = None
        self._camera_info: Publisher | None = None
        if jpeg_quality is not None:
            self._compressed = _publisher(node, CompressedImage, "image/compressed")
        if calibration is not None:
            self._camera_info = _publisher(node, CameraInfo, "camera_info")

    @property
    def topic(self) -> str:
        """Resolved topic of the raw images."""
        return str(self._image.topic_name)

    def publish(self, header: Header, frame: Frame) -> None:
        """Publish one image."""
        if self._camera_info is not None and self._calibration is not None:
            self._publish_calibration(self._camera_info, self._calibration, header, frame)
        if self._image.get_subscription_count():
            self._image.publish(image_message(header, frame))
        if self._compressed is not None and self._compressed.get_subscription_count():
            self._compressed.publish(self._jpeg(header, frame))

    def _publish_calibration(
        self, publisher: Publisher, calibration: CameraInfo, header: Header, frame: Frame
    ) -> None:
        width, height = frame_size(frame)
        if (calibration.width, calibration.height) != (width, height):
            self._node.get_logger().warning(
                f"no camera_info: the calibration is for {calibration.width}x{calibration.height} "
                f"px, and the images have {width}x{height} px",
                throttle_duration_sec=60.0,
            )
            return
        calibration.header = header
        publisher.publish(calibration)

    def _jpeg(self, header: Header, frame: Frame) -> CompressedImage:
        options = [cv2.IMWRITE_JPEG_QUALITY, self._jpeg_quality or 0]
        pixels = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
        _, encoded = cv2.imencode(".jpg", pixels, options)
        words = "rgb8; jpeg compressed bgr8"
        return CompressedImage(header=header, format=words, data=packed(encoded))


def _publisher(node: Node, kind: type, topic: str) -> Publisher:
    return node.create_publisher(
        kind,
        topic,
        QoSProfile(depth=_DEPTH),
        qos_overriding_options=QoSOverridingOptions.with_default_policies(),
    )


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

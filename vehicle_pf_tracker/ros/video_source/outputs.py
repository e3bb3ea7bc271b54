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

"""Publishers of a source's images."""

from __future__ import annotations

import array

import cv2
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.ros.messages import image_message

_DEPTH = 5
"""Images kept for a slow subscriber. Reliable, since that serves both kinds of subscribers."""


class ImageOutputs:
    """Publishes images, and what belongs to them; what nobody subscribes to is not made.

    Parameters
    ----------
    node : Node
        The node.
    jpeg_quality : int or None
        Of compressed images; None for none.
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
        data = array.array("B")
        data.frombytes(encoded.data)
        return CompressedImage(header=header, format="rgb8; jpeg compressed bgr8", data=data)


def _publisher(node: Node, kind: type, topic: str) -> Publisher:
    return node.create_publisher(
        kind,
        topic,
        QoSProfile(depth=_DEPTH),
        qos_overriding_options=QoSOverridingOptions.with_default_policies(),
    )

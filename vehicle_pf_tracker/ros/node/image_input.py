# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Subscription to images, the publishers on its topic, and images as frames."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.qos import QoSCompatibility, QoSProfile, ReliabilityPolicy, qos_check_compatible
from rclpy.qos_overriding_options import InvalidQosOverridesError, QoSOverridingOptions
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo
from sensor_msgs.msg import CompressedImage, Image

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage, read_compressed
from vehicle_pf_tracker.image.formats.encodings import frame_of_message
from vehicle_pf_tracker.ros.rclpy_internals import RCLError
from vehicle_pf_tracker.ros.serialized_image import ImageMessage, read_serialized_image

ImageCallback = Callable[[ImageMessage, Mapping[str, Any]], None]
"""Takes an image and its info."""

_TYPE_NAMES = {Image: "sensor_msgs/msg/Image", CompressedImage: "sensor_msgs/msg/CompressedImage"}
"""Names of the types in the graph, which knows no classes."""


def image_topic(node: Node, transport: str) -> str:
    """Resolve the topic of the images: a remapped `image` takes its `/compressed` with it."""
    base: str = node.resolve_topic_name("image")
    return base if transport == "raw" else str(node.resolve_topic_name(f"{base}/compressed"))


def subscribe(
    node: Node,
    kind: Any,
    topic: str,
    callback: Callable[..., object],
    qos: QoSProfile,
    *,
    raw: bool = False,
) -> Subscription:
    """Subscribe with a QoS that parameters ``qos_overrides.<topic>.subscription.*`` may change.

    Raises
    ------
    InputError
        If a QoS override is not usable.
    """
    options = QoSOverridingOptions.with_default_policies()
    try:
        return node.create_subscription(
            kind, topic, callback, qos, qos_overriding_options=options, raw=raw
        )
    except RCLError as error:
        raise InputError(f"cannot subscribe to {topic}: {error}") from None
    # rclpy reports a bad override by several kinds, none of which names the topic.
    except (ParameterException, InvalidQosOverridesError, RuntimeError) as error:
        raise InputError(f"the QoS overrides of {topic} do not fit: {error}") from None


class ImageInput:
    """An open subscription to images: sensor data, the newest `depth` kept.

    Parameters
    ----------
    node : Node
        Its parameters ``qos_overrides.<topic>.subscription.*`` may change the QoS.
    transport : str
        ``raw`` or ``compressed``.
    depth : int
        Images that may wait.
    callback : callable
        Takes the image and its info.
    leave_out : callable
        Takes the reason where a message is no image, so that there is no header to answer.

    Raises
    ------
    InputError
        If a QoS override is not usable.
    """

    def __init__(
        self,
        node: Node,
        transport: str,
        depth: int,
        callback: ImageCallback,
        leave_out: Callable[[str], None],
    ) -> None:
        self._node = node
        self._transport = transport
        self._kind = Image if transport == "raw" else CompressedImage
        self.topic = image_topic(node, transport)
        # Best effort fits publishers of either kind, and a late image is worth less than the next.
        qos = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)

        def take(serialized: bytes, info: Mapping[str, Any]) -> None:
            try:
                image = read_serialized_image(serialized)
            except InputError as error:
                leave_out(str(error))
            else:
                callback(image, info)

        is_raw = self._kind is Image
        self._subscription = subscribe(
            node, self._kind, self.topic, take if is_raw else callback, qos, raw=is_raw
        )

    def count_publishers(self) -> int:
        """Return the number of publishers that match in topic, type and QoS."""
        return int(self._subscription.get_publisher_count())

    def __str__(self) -> str:
        qos = self._subscription.qos_profile
        kind = qos.reliability.name.lower().replace("_", " ")
        return f"{self.topic} ({self._transport}, {kind}, keep last {qos.depth})"

    def close(self) -> None:
        """Destroy the subscription."""
        self._node.destroy_subscription(self._subscription)

    def explain_silence(self) -> str:
        """Explain the lack of images: every publisher with its QoS, and each mismatch."""
        publishers = self._node.get_publishers_info_by_topic(self.topic)
        if not publishers:
            return f"nobody publishes on it{self._elsewhere()}"
        return "; ".join(self._judge(publisher) for publisher in publishers)

    def _judge(self, publisher: TopicEndpointInfo) -> str:
        qos = publisher.qos_profile
        offers = f"{qos.reliability.name.lower()}, {qos.durability.name.lower()}"
        name = f"{publisher.node_namespace.rstrip('/')}/{publisher.node_name} ({offers})"
        if publisher.topic_type != _TYPE_NAMES[self._kind]:
            return f"{name} publishes {publisher.topic_type}, not {_TYPE_NAMES[self._kind]}"
        match, reason = qos_check_compatible(qos, self._subscription.qos_profile)
        if match == QoSCompatibility.ERROR:  # equal, but not the same object
            return (
                f"{name} does not fit this node's QoS: {reason.removeprefix('ERROR: ').rstrip(';')}"
            )
        return f"{name} fits, but sends nothing"

    def _elsewhere(self) -> str:
        """Name topics that images are on, with the setting that would take them."""
        # The likeliest mistake first: the same camera, by the other transport.
        transport = "compressed" if self._transport == "raw" else "raw"
        other = image_topic(self._node, transport)
        if self._node.count_publishers(other):
            return f", but {other} has images: set image_transport to {transport}"
        found = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if _TYPE_NAMES[self._kind] in types
            and self._node.count_publishers(name)
            and not name.endswith("/overlay")  # of this node, or of another tracker
        ]
        return f"; images are on {', '.join(found)}: remap image to one of them" if found else ""


def read_image(message: ImageMessage) -> Frame | CodedImage:
    """Return the RGB frame of `message`; for rgb8 a view of its data.

    A compressed image is not decoded: it may be a stray, of any size.

    Raises
    ------
    InputError
        If the encoding is unknown, or size and data do not fit each other.
    """
    if isinstance(message, CompressedImage):
        return read_compressed(message.format, message.data)
    return frame_of_message(message)

"""Publishers for the topics of a recording."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import CompressedImage, Image

from vehicle_pf_tracker.features.encodings import decode_compressed
from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.recordings.topics import COMPRESSED_IMAGE, IMAGE
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.playable import Playable, PlayableTopic
from vehicle_pf_tracker.ros.replay_options import ReplayOptions

_SUFFIX = "/compressed"
_IMAGE_DEPTH = 10
_DEPTH = 100


class TopicPublisher:
    """Publishes the messages of one recorded topic.

    Parameters
    ----------
    node : Node
        The player's own node.
    topic : PlayableTopic
        What was recorded.
    name : str
        What to publish it under.
    decompress : bool
        Whether it carries compressed images that go out as raw ones.
    """

    def __init__(self, node: Node, topic: PlayableTopic, name: str, decompress: bool) -> None:
        type_name = IMAGE if decompress else topic.type_name
        depth = _IMAGE_DEPTH if type_name == IMAGE else _DEPTH
        self._publisher = node.create_publisher(
            _message_class(type_name), name, QoSProfile(depth=depth)
        )
        self._convert: Callable[[bytes], Any] = decompressed if decompress else bytes

    @property
    def name(self) -> str:
        """The name it is published under, namespace included."""
        return str(self._publisher.topic_name)

    def publish(self, data: bytes) -> None:
        """Publish one recorded message.

        Raises
        ------
        InputError
            If it is a compressed image to be decompressed, but cannot be.
        """
        self._publisher.publish(self._convert(data))

    def subscription_count(self) -> int:
        """Count the matched subscriptions."""
        return int(self._publisher.get_subscription_count())

    def is_acknowledged(self, timeout: float = 0.0) -> bool:
        """Whether every reliable subscription has all messages, waiting up to `timeout` s."""
        return bool(self._publisher.wait_for_all_acked(Duration(seconds=timeout)))


def make_publishers(
    node: Node, recording: Playable, options: ReplayOptions
) -> tuple[dict[str, TopicPublisher], list[str]]:
    """Make a publisher for each topic that is to be played.

    Returns
    -------
    dict of str to TopicPublisher, list of str
        The publishers by recorded topic; and a sentence for each topic that cannot be played.

    Raises
    ------
    InputError
        If a topic that is chosen or renamed is not in the recording.
    """
    known = {topic.name for topic in recording.topics}
    for name in (*options.topics, *options.remap):
        if name not in known:
            listed = ", ".join(sorted(known))
            raise InputError(f"the recording {recording.path} has no topic {name}, only {listed}")
    publishers, notices = {}, []
    for topic in recording.topics:
        if options.topics and topic.name not in options.topics:
            continue
        try:
            publishers[topic.name] = _make_publisher(node, topic, options)
        except (ImportError, AttributeError, ValueError):
            kind = topic.type_name or "an unknown type"
            notices.append(f"not played: {topic.name}, since {kind} is not installed here")
    return publishers, notices


def decompressed(data: bytes) -> Image:
    """Turn a serialized `CompressedImage` into an `rgb8` image with the same header.

    Raises
    ------
    InputError
        If it cannot be decoded.
    """
    compressed = deserialize_message(data, CompressedImage)
    frame = decode_compressed(compressed.format, compressed.data)
    return image_message(compressed.header, frame)


def _make_publisher(node: Node, topic: PlayableTopic, options: ReplayOptions) -> TopicPublisher:
    if not topic.is_cdr:
        raise ValueError(topic.name)
    decompress = options.decompress and topic.type_name == COMPRESSED_IMAGE
    name = topic.name.removesuffix(_SUFFIX) if decompress else topic.name
    return TopicPublisher(node, topic, options.remap.get(topic.name, name), decompress)


def _message_class(type_name: str) -> Any:
    """Find the class of a type like ``sensor_msgs/msg/Image``."""
    package, kind, name = type_name.split("/")
    return getattr(import_module(f"{package}.{kind}"), name)

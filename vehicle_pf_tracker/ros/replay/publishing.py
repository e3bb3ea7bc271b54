# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Publishers for the topics of a recording, and what nodes hear its images as."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from importlib import import_module
from typing import Any, NamedTuple

from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import CompressedImage, Image

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.formats.compressed_image import decode_compressed
from vehicle_pf_tracker.recordings.bags.messages import COMPRESSED_IMAGE
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.topic_table import TopicInfo
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.reading import read_message
from vehicle_pf_tracker.ros.replay.recorded_qos import recorded_qos
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions

_SUFFIX = "/compressed"
"""End of a topic of compressed images, as image_transport names it."""
_IMAGE_DEPTH = 10
"""Images kept for a slow subscriber: of 1080p they are 60 MB."""
_DEPTH = 100
"""Messages kept of other topics, which are small, and may come in bursts as TF does."""


class RecordedImages(NamedTuple):
    """Where the images of a recording are, and how a node hears them.

    Attributes
    ----------
    topic : str
        As recorded.
    base : str
        Topic that the node's ``image`` is remapped to.
    transport : str
        The node's parameter ``image_transport``.
    published : str
        Topic that the replay publishes them on.
    """

    topic: str
    base: str
    transport: str
    published: str


def recorded_images(recording: Recording) -> RecordedImages:
    """Find how nodes hear the images of a recording."""
    name = recording.image_topic
    if recording.image_type != COMPRESSED_IMAGE:
        return RecordedImages(name, name, "raw", name)
    base = name.removesuffix(_SUFFIX)
    return RecordedImages(name, base, "compressed", base + _SUFFIX)


class TopicPublisher(NamedTuple):
    """Publisher of one recorded topic, and the conversion of its messages.

    Attributes
    ----------
    publisher : Publisher
        Publisher of the player's own node.
    convert : callable
        Makes of the recorded bytes what is published: a message, or its bytes. Raises `InputError`
        if they cannot be converted.
    """

    publisher: Publisher
    convert: Callable[[bytes], Any]


def make_publishers(
    node: Node, recording: Recording, options: ReplayOptions
) -> tuple[dict[str, TopicPublisher], list[str]]:
    """Make a publisher for each topic that is to be played.

    Returns
    -------
    dict of str to TopicPublisher, list of str
        The publishers by recorded topic; and a sentence for each topic that cannot be played.

    Raises
    ------
    InputError
        If a topic that is named is not in the recording, or its new name is none.
    """
    names = _published_names(recording, options)
    publishers: dict[str, TopicPublisher] = {}
    notices = []
    for topic in recording.topics:
        if topic.name not in names:
            continue
        kind = _message_class(topic.type_name) if topic.is_cdr else None
        if kind is None:
            what = topic.type_name if topic.is_cdr and topic.type_name else "an unknown type"
            notices.append(f"not played: {topic.name}, since {what} is not installed here")
            continue
        convert: Callable[[bytes], Any] = bytes
        if _is_decompressed(topic, options):
            kind = Image
            convert = decompressed
        qos = recorded_qos(topic.offered_qos, _IMAGE_DEPTH if kind is Image else _DEPTH)
        name = names[topic.name]
        try:
            publishers[topic.name] = TopicPublisher(node.create_publisher(kind, name, qos), convert)
        except NameValidationException as error:
            reason = str(error).splitlines()[0].rstrip(":").rpartition(": ")[2]
            raise InputError(f"{name!r} is not a topic name: {reason}") from None
    return publishers, notices


def decompressed(data: bytes) -> Image:
    """Turn a serialized `CompressedImage` into an `rgb8` image with the same header.

    Raises
    ------
    InputError
        If it is no such message, or cannot be decoded.
    """
    compressed = read_message(data, CompressedImage)
    frame = decode_compressed(compressed.format, compressed.data)
    return image_message(compressed.header, frame)


def _published_names(recording: Recording, options: ReplayOptions) -> dict[str, str]:
    """Return what each topic that is to be played is published as, by its recorded name."""
    names = {topic.name: _played_name(topic, options) for topic in recording.topics}
    unknown = {*options.topics} - names.keys()
    unknown |= {*options.remap} - names.keys() - {*names.values()}
    if unknown:
        raise InputError(
            f"the recording {recording.path} has no topic {', '.join(sorted(unknown))}; "
            f"it has {', '.join(sorted(names))}"
        )
    final = {
        topic: options.remap.get(topic, options.remap.get(name, name))
        for topic, name in names.items()
        if not options.topics or topic in options.topics
    }
    for name, count in Counter(final.values()).items():
        if count > 1:
            what = f"several topics would be published as {name}"
            raise InputError(f"{what}; choose one with --topics")
    return final


def _is_decompressed(topic: TopicInfo, options: ReplayOptions) -> bool:
    return options.decompress and topic.type_name == COMPRESSED_IMAGE


def _played_name(topic: TopicInfo, options: ReplayOptions) -> str:
    """Name of a topic before it is remapped."""
    return topic.name.removesuffix(_SUFFIX) if _is_decompressed(topic, options) else topic.name


def _message_class(type_name: str) -> type[Any] | None:
    """Find the class of a type like ``sensor_msgs/msg/Image``, None where it is not installed."""
    package, _, name = type_name.partition("/msg/")
    try:
        found: type[Any] = getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError, ValueError):
        return None
    return found

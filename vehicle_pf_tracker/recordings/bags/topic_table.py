# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Topics of a recording, and the choice of its image topic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mcap.records import Channel
from mcap.well_known import MessageEncoding

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.mcap_index import McapIndex
from vehicle_pf_tracker.recordings.bags.messages import IMAGE_TYPES


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """A topic: its ROS type (empty where unknown), its encoding and its number of messages.

    `is_cdr` is true where the messages are serialized as in ROS 2. `offered_qos` is the recorded
    QoS as YAML text, empty where unknown.
    """

    name: str
    type_name: str
    message_count: int
    is_cdr: bool
    offered_qos: str = ""

    @property
    def is_image(self) -> bool:
        """True if these are images that we can read."""
        return self.is_cdr and self.type_name in IMAGE_TYPES


def list_topics(files: Sequence[McapIndex]) -> tuple[TopicInfo, ...]:
    """List the topics of a recording, several channels of one topic added up."""
    by_name: dict[str, TopicInfo] = {}
    for index in files:
        for channel_id, channel in index.channels.items():
            count = index.counts[channel_id]
            # A file that was split, or a publisher that restarted, has a channel more.
            known = by_name.get(channel.topic) or _describe(index, channel)
            by_name[channel.topic] = replace(known, message_count=known.message_count + count)
    return tuple(by_name.values())


def choose_image_topic(path: Path, topics: Sequence[TopicInfo], wanted: str | None) -> TopicInfo:
    """Return the topic `wanted`, or the only image topic that has messages.

    Raises
    ------
    InputError
        If it does not exist, is empty or carries no images, or several could be meant.
    """
    images = [topic for topic in topics if topic.is_image]
    # 1. A topic that was named must be right: a sentence for each way in which it is not.
    if wanted is not None:
        # Among all topics: one that exists but has no images gets a sentence of its own.
        chosen = next((topic for topic in topics if topic.name == wanted), None)
        if chosen is None:
            names = _listed(images)
            raise InputError(
                f"the recording {path} has no topic {wanted}; its image topics are: {names}"
            )
        if not chosen.is_image:
            raise InputError(
                f"the topic {wanted} of {path} carries {chosen.type_name or 'an unknown type'}, "
                f"no images; the image topics are: {_listed(images)}"
            )
        if not chosen.message_count:
            raise InputError(f"the image topic {wanted} of {path} has no messages")
        return chosen
    # 2. Without a name there must be no choice.
    # Recorders list topics on which nothing came: those are no choice.
    filled = [topic for topic in images if topic.message_count]
    if not filled:
        names = _listed(topics)
        raise InputError(f"the recording {path} has no images; its topics are: {names}")
    if len(filled) > 1:
        raise InputError(
            f"the recording {path} has several image topics, choose one with --topic: "
            f"{_listed(filled)}"
        )
    return filled[0]


def _describe(index: McapIndex, channel: Channel) -> TopicInfo:
    schema = index.schemas.get(channel.schema_id)
    is_cdr = channel.message_encoding == MessageEncoding.CDR
    qos = channel.metadata.get("offered_qos_profiles", "")
    return TopicInfo(channel.topic, "" if schema is None else schema.name, 0, is_cdr, qos)


def _listed(topics: Sequence[TopicInfo]) -> str:
    return ", ".join(topic.name for topic in topics) or "none"

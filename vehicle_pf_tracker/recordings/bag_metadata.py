"""What rosbag2 wants to know about a bag: metadata.yaml version 9, and QoS profiles.

Read by rosbag2's `MetadataIo` and by `rosbags`; the field names are rosbag2_storage's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import yaml

VERSION = 9
_INFINITE = {"sec": 9223372036, "nsec": 854775807}

RELIABLE_QOS: list[dict[str, Any]] = [
    {
        "history": "keep_last",
        "depth": 10,
        "reliability": "reliable",
        "durability": "volatile",
        "deadline": _INFINITE,
        "lifespan": _INFINITE,
        "liveliness": "automatic",
        "liveliness_lease_duration": _INFINITE,
        "avoid_ros_namespace_conventions": False,
    }
]
"""The QoS profiles that every topic of our recordings offers."""


@dataclass(frozen=True, slots=True)
class TopicSummary:
    """A topic of a bag: its type, the type's RIHS01 hash and how many messages it has."""

    name: str
    type_name: str
    type_hash: str
    message_count: int


class _PlainDumper(yaml.SafeDumper):
    """Writes equal values out each time: rosbag2's readers need not know YAML's aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def qos_text() -> str:
    """Return the QoS profiles as the text that an MCAP channel carries."""
    return _dump(RELIABLE_QOS)


def bag_information(
    file_name: str, start_ns: int, duration_ns: int, summaries: Sequence[TopicSummary]
) -> dict[str, Any]:
    """Describe a bag of one MCAP file whose first message is at `start_ns`, in ns."""
    start = {"nanoseconds_since_epoch": start_ns}
    duration = {"nanoseconds": duration_ns}
    count = sum(summary.message_count for summary in summaries)
    return {
        "version": VERSION,
        "storage_identifier": "mcap",
        "duration": duration,
        "starting_time": start,
        "message_count": count,
        "topics_with_message_count": [_topic(summary) for summary in summaries],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file_name],
        "files": [
            {
                "path": file_name,
                "starting_time": start,
                "duration": duration,
                "message_count": count,
            }
        ],
        "custom_data": None,
        "ros_distro": "jazzy",
    }


def metadata_yaml(information: dict[str, Any]) -> str:
    """Return the text of metadata.yaml."""
    return _dump({"rosbag2_bagfile_information": information})


def information_yaml(information: dict[str, Any]) -> str:
    """Return the text of the copy that rosbag2 keeps inside the MCAP file."""
    return _dump(information)


def _topic(summary: TopicSummary) -> dict[str, Any]:
    return {
        "topic_metadata": {
            "name": summary.name,
            "type": summary.type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": RELIABLE_QOS,
            "type_description_hash": summary.type_hash,
        },
        "message_count": summary.message_count,
    }


def _dump(value: Any) -> str:
    return yaml.dump(value, Dumper=_PlainDumper, sort_keys=False)

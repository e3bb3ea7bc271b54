"""Who is there: tracker nodes, and what they subscribe to."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from vehicle_pf_tracker.recordings.topics import DIAGNOSTIC_ARRAY, IMAGE_TYPES

_MODE = "/mode"


def full_name(name: str) -> str:
    """Write a node's name with its namespace: ``apf_tracker`` is ``/apf_tracker``."""
    return "/" + name.strip("/")


def tracker_nodes(node: Node) -> set[str]:
    """Full names of all nodes that publish a `~/mode` as trackers do."""
    return {
        topic.removesuffix(_MODE)
        for topic, types in node.get_topic_names_and_types()
        if topic.endswith(_MODE)
        and DIAGNOSTIC_ARRAY in types
        and topic.removesuffix(_MODE) in map(_owner, node.get_publishers_info_by_topic(topic))
    }


def subscribers(node: Node, topic: str) -> set[str]:
    """Full names of all nodes that subscribe to `topic`."""
    return set(map(_owner, node.get_subscriptions_info_by_topic(topic)))


def image_inputs(node: Node, tracker: str) -> list[str]:
    """Image topics that the node `tracker` subscribes to."""
    return [
        topic
        for topic, types in node.get_topic_names_and_types()
        if not set(types).isdisjoint(IMAGE_TYPES) and tracker in subscribers(node, topic)
    ]


def _owner(endpoint: Any) -> str:
    return full_name(f"{endpoint.node_namespace}/{endpoint.node_name}")

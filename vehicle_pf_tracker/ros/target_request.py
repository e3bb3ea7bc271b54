# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Target for a running node, published once, and waited for until it has arrived."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import rclpy
from geometry_msgs.msg import Point32, PolygonStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import RegionOfInterest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError

_GRAPH_PERIOD = 0.05
"""Seconds between two queries of the graph, whose changes wake nobody."""
_REGION = "sensor_msgs/msg/RegionOfInterest"
"""Type of ``~/set_target``, by which nodes that take targets are known."""
_LARGEST = 2**32 - 1
"""Largest number in a region of interest, whose fields have 32 bits."""


def set_target(node_name: str, box: Box, timeout: float, ros_args: Sequence[str] = ()) -> str:
    """Publish a target for a node and return its full name.

    A box in whole pixels goes to its ``~/set_target``, another to its ``~/set_box``.

    Parameters
    ----------
    node_name : str
        Name of the node, with its namespace.
    box : Box
        The target, px.
    timeout : float
        Longest wait for the node, s.
    ros_args : sequence of str
        Arguments for ROS.

    Raises
    ------
    InputError
        If no such node listens within `timeout`, or does not confirm that it got the target.
    """
    name = "/" + node_name.strip("/")
    # Python's own handlers stay: Ctrl-C is to end the wait.
    rclpy.init(
        args=["--ros-args", *ros_args] if ros_args else [],
        signal_handler_options=SignalHandlerOptions.NO,
    )
    try:
        node = rclpy.create_node("set_target", start_parameter_services=False)
        topic, message = _message(name, box)
        publisher = node.create_publisher(type(message), topic, 1)
        _await_subscription(node, publisher, name, timeout)
        publisher.publish(message)
        if not publisher.wait_for_all_acked(Duration(seconds=timeout)):
            raise InputError(f"the node {name} did not confirm the target within {timeout:g} s")
    finally:
        rclpy.try_shutdown()
    return name


def _message(name: str, box: Box) -> tuple[str, Any]:
    values = (box.x, box.y, box.width, box.height)
    if all(value.is_integer() and 0 <= value <= _LARGEST for value in values):
        x, y, width, height = map(int, values)
        region = RegionOfInterest(x_offset=x, y_offset=y, width=width, height=height)
        return f"{name}/set_target", region
    polygon = PolygonStamped()
    polygon.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in box.corners]
    return f"{name}/set_box", polygon


def _await_subscription(node: Node, publisher: Publisher, name: str, timeout: float) -> None:
    deadline = time.monotonic() + timeout
    while not (publisher.get_subscription_count() and _listens(node, publisher.topic_name, name)):
        if time.monotonic() >= deadline:
            raise InputError(
                f"there is no node {name} that takes targets after {timeout:g} s: {_others(node)}"
            )
        time.sleep(_GRAPH_PERIOD)


def _listens(node: Node, topic: str, name: str) -> bool:
    """Return True if the node `name` itself subscribes to `topic`."""
    return any(
        "/" + f"{one.node_namespace}/{one.node_name}".strip("/") == name
        for one in node.get_subscriptions_info_by_topic(topic)
    )


def _others(node: Node) -> str:
    """List the nodes that take targets, or say that there are none."""
    names = sorted(
        topic.removesuffix("/set_target")
        for topic, types in node.get_topic_names_and_types()
        if topic.endswith("/set_target")
        and _REGION in types
        and _listens(node, topic, topic.removesuffix("/set_target"))
    )
    return f"there is {', '.join(names)}" if names else "is it running and active?"

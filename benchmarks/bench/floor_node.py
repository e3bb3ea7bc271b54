# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The least a node can do: take an image, publish a point. `python -m benchmarks.bench.floor_node`.

Its subscription, its publisher, its executor and its allocator are those of a tracker node.
"""

from __future__ import annotations

import sys

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image

from vehicle_pf_tracker.ros.image_memory import keep_image_memory


class FloorNode(Node):  # type: ignore[misc]
    """Answers every image with its header."""

    def __init__(self) -> None:
        super().__init__("floor")
        self._publisher = self.create_publisher(PointStamped, "~/position", QoSProfile(depth=10))
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(Image, "image", self._on_image, qos)
        self.get_logger().info("ready: a floor")

    def _on_image(self, message: Image) -> None:
        self._publisher.publish(PointStamped(header=message.header))


def main() -> None:
    """Spin until a signal comes."""
    # As a tracker node does, so that the floor has the same allocator.
    keep_image_memory()
    rclpy.init(args=sys.argv)
    executor = SingleThreadedExecutor()
    executor.add_node(FloorNode())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

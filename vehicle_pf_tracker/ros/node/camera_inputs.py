# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Inputs about the camera: its lens from camera_info and its pose from TF."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import CameraInfo

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.poses import Pose, PoseTree
from vehicle_pf_tracker.ros.node.camera_info import ImageLens, lens_of_info
from vehicle_pf_tracker.ros.node.image_input import image_topic

try:
    from tf2_msgs.msg import TFMessage
except ImportError:  # an optional package: only road.from_tf needs it
    TFMessage = None

_THROTTLE = 30.0
"""Interval between two lines of the same kind in the log, s: a driver repeats its mistake with
every image, and TF a hundred times a second."""
_NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""For camera_info: only the newest counts, and best effort fits drivers of either kind."""
_MOVING = QoSProfile(depth=100)
"""As tf2 listens to /tf."""
_LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""As tf2 listens to /tf_static, which is sent once, perhaps before this node was there."""


class CameraInputs:
    """Open subscriptions to what the road's parameters ask for.

    Parameters
    ----------
    node : Node
        Node to subscribe with.

    Attributes
    ----------
    lens : ImageLens or None
        Lens of the last CameraInfo; None before the first.
    poses : PoseTree
        All poses that have come.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.lens: ImageLens | None = None
        # tf2_ros is in no index but apt's, so that a node whose ROS comes from pip could not
        # use it. Its buffer gives the pose at an image's stamp; the newest, which this has, differs
        # only while the camera turns.
        self.poses = PoseTree()
        self._asked: tuple[bool, bool, bool] | None = None
        self._rectified = False
        self._subscriptions: list[Subscription] = []

    def open(self, road: RoadParameters) -> None:
        """Subscribe to what `road` asks for, and to nothing else."""
        asked = road.from_camera_info, road.from_tf, road.rectified
        # Other parameters change more often: a subscription that is made anew would lose the lens.
        if asked == self._asked:
            return
        self.close()
        self._asked = asked
        self._rectified = road.rectified
        subscribe = self._node.create_subscription
        if road.from_camera_info:
            # Beside the images, as camera drivers publish it.
            folder = image_topic(self._node, "raw").rpartition("/")[0]
            topic = str(self._node.resolve_topic_name(f"{folder}/camera_info"))
            self._subscriptions.append(subscribe(CameraInfo, topic, self._on_info, _NEWEST))
        if road.from_tf and TFMessage is None:
            self._node.get_logger().error(
                "road.from_tf needs the package tf2_msgs (apt: ros-$ROS_DISTRO-tf2-msgs)"
            )
        elif road.from_tf:
            for topic, qos in (("/tf", _MOVING), ("/tf_static", _LATCHED)):
                self._subscriptions.append(subscribe(TFMessage, topic, self._on_transforms, qos))

    def close(self) -> None:
        """Destroy the subscriptions."""
        while self._subscriptions:
            self._node.destroy_subscription(self._subscriptions.pop())
        self._asked = None
        self.lens = None

    def _on_info(self, message: CameraInfo) -> None:
        try:
            self.lens = lens_of_info(message, rectified=self._rectified)
        except InputError as error:
            # The lens of before stays: one broken message does not unmake a calibration.
            self._warn(str(error))

    def _on_transforms(self, message: Any) -> None:
        for transform in message.transforms:
            at = transform.transform.translation
            turn = transform.transform.rotation
            try:
                pose = Pose.of((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))
            except InputError as error:
                self._warn(f"a transform of {transform.child_frame_id} is ignored: {error}")
            else:
                self.poses.put(transform.header.frame_id, transform.child_frame_id, pose)

    def _warn(self, words: str) -> None:
        self._node.get_logger().warning(words, throttle_duration_sec=_THROTTLE)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lens and pose of the camera from camera_info and TF, and the localisation that uses them."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import CameraInfo
from std_msgs.msg import Header

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.lens import FIRST_PIXEL, Lens
from vehicle_pf_tracker.road.poses import Pose, PoseTree
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.image_input import image_topic
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.localisation import Localisation, RoadEstimate

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
        self._subscriptions: list[Subscription] = []

    def open(self, road: RoadParameters) -> None:
        """Subscribe to what `road` asks for, and to nothing else."""
        asked = road.from_camera_info, road.from_tf, road.rectified
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
        self._asked = self.lens = None

    def _on_info(self, message: CameraInfo) -> None:
        try:
            self.lens = lens_of_info(message, rectified=self._rectified)
        except InputError as error:
            self._warn(str(error))

    def _on_transforms(self, message: Any) -> None:
        for one in message.transforms:
            at = one.transform.translation
            turn = one.transform.rotation
            try:
                pose = Pose.of((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))
            except InputError as error:
                self._warn(f"a transform of {one.child_frame_id} is ignored: {error}")
            else:
                self.poses.put(one.header.frame_id, one.child_frame_id, pose)

    def _warn(self, words: str) -> None:
        self._node.get_logger().warning(words, throttle_duration_sec=_THROTTLE)


class StreamLocalisation:
    """Localisation of a track with lens and pose from topics.

    Parameters
    ----------
    variant : str
        Name of the variant.
    parameters : RoadParameters
        Mapping to the road.
    cameras : CameraInputs
        Where lens and pose come from.
    """

    def __init__(self, variant: str, parameters: RoadParameters, cameras: CameraInputs) -> None:
        self._track = Localisation(variant, parameters)
        self._cameras = cameras
        self._misfit = ""

    def reconfigure(self, parameters: RoadParameters) -> None:
        """Take another mapping to the road; lens and pose that came from outside are kept."""
        self._track.reconfigure(parameters)

    def locate(self, estimate: Estimate, header: Header, frame: Frame, period: float) -> None:
        """Take the estimate of the image `frame`, with the nominal frame period in s."""
        track = self._track
        parameters = track.parameters
        lens = self._cameras.lens
        # First lens and pose: the estimate is mapped by those of its own image.
        if lens is not None:
            track.set_lens(lens.lens)
        if parameters.from_tf:
            with contextlib.suppress(InputError):  # TF does not have it yet
                track.set_pose(self._cameras.poses.find(header.frame_id, parameters.frame_id))
        track.follow(estimate, stamp_ns(header), period)
        width, height = frame_size(frame)
        self._misfit = ""
        if lens is not None and lens.size != (width, height) and parameters.from_camera_info:
            self._misfit = (
                f"camera_info is for {lens.size[0]}x{lens.size[1]} px, "
                f"the image has {width}x{height}"
            )

    @property
    def has_road(self) -> bool:
        """True where a mapping to the road is asked for."""
        return self._track.has_road

    @property
    def road(self) -> RoadEstimate | None:
        """Last position on the road; None where there is none."""
        return None if self._misfit else self._track.road

    @property
    def road_frame_id(self) -> str:
        """Frame of positions on the road."""
        return self._track.parameters.frame_id

    @property
    def covariance(self) -> Array:
        """Covariance (2, 2) of the last estimate's position, px²."""
        return self._track.covariance

    @property
    def values(self) -> dict[str, object]:
        """Road position and speed for `~/mode` by name, or the reason why there are none."""
        if not self.has_road:
            return {}
        road = self.road
        objection = self._misfit or self._track.objection
        return {"road": objection or "ok", **(road.scalars() if road else {})}

    @property
    def words(self) -> str:
        """Speed for people; empty where there is none."""
        road = self.road
        return f"{road.speed:.1f} +- {road.speed_deviation:.1f} km/h" if road else ""


_COEFFICIENTS = {"rational_polynomial": 8, "equidistant": 4}
"""Numbers of coefficients of a model; what a driver writes after them must be zero."""


@dataclass(frozen=True, slots=True)
class ImageLens:
    """Lens of a camera, and the size of the images that it is for, px."""

    lens: Lens
    size: tuple[int, int]


def lens_of_info(message: CameraInfo, *, rectified: bool) -> ImageLens:
    """Read the lens of a CameraInfo, for the images that it goes with: binned and cut out.

    image_geometry does the same, but is in apt only, as tf2_ros is.

    Parameters
    ----------
    message : CameraInfo
        Calibration of the camera.
    rectified : bool
        True for images that were rectified: they have the projection matrix, and no distortion.

    Raises
    ------
    InputError
        If the camera is not calibrated, or its model is not known.
    """
    rows = np.reshape(message.p if rectified else message.k, (3, -1)).tolist()
    (fx, _, cx, *_), (_, fy, cy, *_) = rows[:2]
    if not (fx > 0 and fy > 0):
        raise InputError("camera_info has no calibration: its focal length is not above 0")
    across = max(message.binning_x, 1)
    down = max(message.binning_y, 1)
    model, coefficients = _distortion(message, rectified=rectified)
    centre = _binned(cx, message.roi.x_offset, across), _binned(cy, message.roi.y_offset, down)
    lens = Lens((fx / across, fy / down), centre, model, coefficients)
    width = message.roi.width or message.width  # 0 of a whole image
    height = message.roi.height or message.height
    return ImageLens(lens, (width // across, height // down))


def _distortion(message: CameraInfo, *, rectified: bool) -> tuple[str, tuple[float, ...]]:
    coefficients = tuple(map(float, message.d))
    if rectified or (not any(coefficients) and message.distortion_model != "equidistant"):
        return "none", ()
    count = _COEFFICIENTS.get(message.distortion_model, len(coefficients))
    if any(coefficients[count:]):
        raise InputError(
            f"camera_info has {len(coefficients)} coefficients of {message.distortion_model}; "
            f"those after the first {count} must be 0"
        )
    return message.distortion_model, coefficients[:count]


def _binned(centre: float, offset: int, factor: int) -> float:
    """Move a principal point to a part of the image, and bin it; pixels have corners."""
    return (centre + FIRST_PIXEL - offset) / factor - FIRST_PIXEL

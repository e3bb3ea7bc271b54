# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Outputs of a node of one target: everything that it publishes for an image."""

from __future__ import annotations

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped, Vector3Stamped
from rclpy.lifecycle import LifecycleNode
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.ros.node.answer import Answer, TrackerAnswer
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.node.publishers import (
    BEST_EFFORT_QOS,
    RELIABLE_QOS,
    Publishers,
    in_frame,
    in_pixels,
)
from vehicle_pf_tracker.ros.node.stream_localisation import StreamLocalisation
from vehicle_pf_tracker.showing.target_drawing import Annotator, write_mode
from vehicle_pf_tracker.trackers.estimate import Estimate


class TrackerOutputs:
    """Everything that a configured node of one target publishes.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Topic of the images, for `~/mode`.
    localisation : StreamLocalisation
        Uncertainty of the estimates, and the road.
    journal : Journal
        Log and counts.
    """

    def __init__(
        self,
        node: LifecycleNode,
        hardware_id: str,
        localisation: StreamLocalisation,
        journal: Journal,
    ) -> None:
        more = {
            "particles": (PointCloud2, BEST_EFFORT_QOS),
            "pose_with_covariance": (PoseWithCovarianceStamped, RELIABLE_QOS),
            "road_position": (PointStamped, RELIABLE_QOS),
            "road_velocity": (Vector3Stamped, RELIABLE_QOS),
            "detection": (messages.detection_type(), RELIABLE_QOS),
        }
        self._publishers = Publishers(node, hardware_id, more)
        self._localisation = localisation
        self._journal = journal
        self._annotator = Annotator(particles=True)
        self._track = 0

    def close(self) -> None:
        """Destroy the publishers."""
        self._publishers.close()

    def send(self, answer: Answer, own: NodeParameters, *, is_kept: bool) -> DiagnosticArray | None:
        """Publish an answer, its `~/mode` last; returns that, if it was made."""
        if isinstance(answer, TrackerAnswer):
            # Results before the picture: whoever acts on them does not wait for a drawing.
            if answer.estimate is not None:
                self._publish_estimate(answer.header, answer.estimate, own, answer.period)
            if own.publish.overlay:
                with self._journal.drawing("the overlay"):
                    self._publish_overlay(answer)
        return self._publishers.publish_mode(answer, is_kept=is_kept)

    def _publish_estimate(
        self, header: Header, estimate: Estimate, own: NodeParameters, period: float
    ) -> None:
        """Publish where the vehicle is; the frame `period` in s makes px/frame to px/s."""
        if estimate.begins:
            self._track += 1
            self._annotator.follow(None)  # a new path
        self._annotator.follow(estimate)
        publish = self._publishers.publish
        header = in_pixels(header, own)
        self._publishers.publish_vehicle(header, estimate, own, period)
        if own.publish.particles:
            publish("particles", messages.particles_message, header, estimate)
        publish("detection", messages.detection_message, header, estimate, str(self._track))
        localisation = self._localisation
        road = localisation.road
        if road is not None:
            there = in_frame(header, localisation.road_frame_id)
            publish(
                "pose_with_covariance", messages.pose_message, there, road.position, road.covariance
            )
            publish("road_position", messages.point_message, there, road.position)
            publish("road_velocity", messages.velocity_message, there, road.velocity)
        # Without a road in px; with one that gives no position now, no pose at all: the unit must
        # not change on the way.
        elif not localisation.has_road and self._publishers.is_heard("pose_with_covariance"):
            position = np.asarray(estimate.position)
            covariance = localisation.covariance
            publish("pose_with_covariance", messages.pose_message, header, position, covariance)

    def _publish_overlay(self, answer: TrackerAnswer) -> None:
        """Publish the drawn-on image, if anybody looks; the speed stands after the mode."""
        if not self._publishers.is_heard("overlay"):
            return
        mode = answer.mode
        estimate = answer.estimate
        # A copy: the frame is a view of the message, which others may have, too.
        picture: Frame = np.array(answer.frame, order="C")
        words = mode
        if estimate is not None:
            words = f"{mode} {estimate.confidence:.2f}  {self._localisation.words}".rstrip()
        if not self._annotator.draw(picture, estimate, words):
            write_mode(picture, mode, words, row=1)
        self._publishers.publish("overlay", messages.image_message, answer.header, picture)

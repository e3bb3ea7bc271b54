# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Everything that a node of many vehicles publishes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.lifecycle import LifecycleNode
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros.messages import detections_type, image_message
from vehicle_pf_tracker.ros.node.answer import Answer
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.node.publishers import RELIABLE_QOS, Publishers, in_pixels
from vehicle_pf_tracker.ros.traffic import messages
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.showing.drawing import Colour, draw_box, line_width
from vehicle_pf_tracker.showing.live_page import LivePage

_SELECTED: Colour = (255, 255, 255)
"""Colour of the selected vehicle's frame: white, which no vehicle's number gives it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrafficAnswer(Answer):
    """Answer of all vehicles to an image that they could be followed in.

    Attributes
    ----------
    frame : (H, W, 3) array
        The image.
    period : float
        Nominal time between images, s.
    """

    frame: Frame
    period: float


class TrafficOutputs:
    """Everything that a configured node of many vehicles publishes.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Topic of the images, for the statuses.
    vehicles : Vehicles
        All vehicles.
    page : LivePage or None
        Page that shows them.
    journal : Journal
        Log and counts.
    """

    def __init__(
        self,
        node: LifecycleNode,
        hardware_id: str,
        vehicles: Vehicles,
        page: LivePage | None,
        journal: Journal,
    ) -> None:
        more = {
            "tracks": (PointCloud2, RELIABLE_QOS),
            "modes": (DiagnosticArray, RELIABLE_QOS),
            "counts": (DiagnosticArray, RELIABLE_QOS),
            "detections": (detections_type(), RELIABLE_QOS),
            "markers": (MarkerArray, RELIABLE_QOS),
        }
        self._publishers = Publishers(node, hardware_id, more)
        self._vehicles = vehicles
        self._journal = journal
        self.page = page

    def close(self) -> None:
        """Destroy the publishers; the page is its owner's."""
        self._publishers.close()

    def send(self, answer: Answer, own: NodeParameters, *, is_kept: bool) -> DiagnosticArray | None:
        """Publish an answer, its `~/mode` last; returns that, if it was made."""
        if isinstance(answer, TrafficAnswer):
            there = in_pixels(answer.header, own)
            selected = self._vehicles.selected
            self._publish_vehicles(answer.header, there, answer.period)
            if selected is not None:
                self._publishers.publish_vehicle(there, selected, own, answer.period)
            self._show(answer, own)
        return self._publishers.publish_mode(answer, is_kept=is_kept)

    def _publish_vehicles(self, header: Header, there: Header, period: float) -> None:
        """Publish all vehicles, px under the header `there`, and what was counted.

        The frame `period` is in s.
        """
        publish = self._publishers.publish
        statuses = self._publishers.statuses
        counter = self._vehicles.counter
        estimates = self._vehicles.estimates
        publish("tracks", messages.tracks_message, there, estimates, period)
        publish("modes", statuses, header, messages.mode_statuses(estimates))
        publish("detections", messages.detections_message, there, estimates)
        publish("markers", messages.markers_message, there, estimates)
        if counter.plan.is_counting:
            counts = messages.count_statuses(counter, self._vehicles.latest)
            publish("counts", statuses, header, counts)

    def _show(self, answer: TrafficAnswer, own: NodeParameters) -> None:
        """Draw the image for those who look at it."""
        if own.publish.overlay:
            with self._journal.drawing("the overlay"):
                self._publish_overlay(answer)
        if self.page is not None:
            with self._journal.drawing("the live page"):
                self.page.show(
                    partial(self._vehicles.counted.shown, answer.frame),
                    self._vehicles.counted.page_facts,
                )

    def _publish_overlay(self, answer: TrafficAnswer) -> None:
        """Publish the drawn-on image, if anybody looks; the selected vehicle has a white frame."""
        if not self._publishers.is_heard("overlay"):
            return
        frame = answer.frame
        selected = self._vehicles.selected
        if selected is not None:
            frame = np.array(frame, order="C")
            draw_box(frame, selected.box, _SELECTED, 3 * line_width(frame))
        self._publishers.publish(
            "overlay", image_message, answer.header, self._vehicles.counted.drawn(frame)
        )

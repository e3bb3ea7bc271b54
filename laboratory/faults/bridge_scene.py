# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that drive in lanes under a bridge: their images, and what a detector sees of them."""

from __future__ import annotations

from geometry_msgs.msg import Point32, PolygonStamped
from sensor_msgs.msg import Image

from laboratory.faults.drive import FIRST_NS, header_at
from laboratory.faults.lanes import Corners, Road, Traffic
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.ros.messages import image_message

WIDTH, HEIGHT = 320, 180
"""Size of the images, px: both nodes keep up with it beside the load."""
BRIDGE = slice(150, 180)
"""Columns under the bridge: a vehicle of 32 px is hidden for a few images."""
BRIDGE_GREY = 60
"""Grey level of the bridge: darker than the road, as a shadow is."""
LEAST_WIDTH = 3.0
"""Least width in px that the detector sees of a vehicle that enters."""


class BridgeScene:
    """Vehicles that drive through in lanes, under a bridge.

    Parameters
    ----------
    total : int
        Number of vehicles.
    every : float
        Images from one vehicle to the next.
    rate : float
        Images per second.
    """

    def __init__(self, total: int, every: float, rate: float) -> None:
        self.road = Road(WIDTH, HEIGHT, lanes=6, size=(32.0, 20.0), speed=4.0, every=every)
        self.traffic = Traffic(self.road, total, 0)
        self.corners: Corners = {}
        self._period_ns = round(1e9 / rate)
        self._empty = self.road.empty()
        self._empty[:, BRIDGE] = BRIDGE_GREY
        self._frame = self._empty

    def step(self, number: int) -> Image:
        """Drive on to the image `number`."""
        self.corners = self.traffic.step(number)
        # The bridge after the vehicles: it covers them.
        self._frame = self.road.with_vehicles(self._empty, self.corners)
        self._frame[:, BRIDGE] = BRIDGE_GREY
        return self.image(number)

    def image(self, number: int) -> Image:
        """Make the image `number` of where the vehicles are now."""
        return image_message(header_at(FIRST_NS + number * self._period_ns), self._frame)

    def detect(self) -> Array:
        """Detect the vehicles that no bridge hides."""
        boxes = self.traffic.detect(self.corners)
        # By the middle of the box: a vehicle that is half under the bridge is still found.
        middle = boxes[:, 0] + boxes[:, 2] / 2
        is_hidden = (middle >= BRIDGE.start) & (middle < BRIDGE.stop)
        return boxes[~is_hidden & (boxes[:, 2] >= LEAST_WIDTH)]

    def target(self) -> PolygonStamped | None:
        """Return a vehicle that has just come; None where there is none."""
        # In the first part of the road, so that it is followed through the bridge.
        for x, y in self.corners.values():
            if 0 < x < BRIDGE.start / 2:
                outline = PolygonStamped(header=header_at(0))
                width, height = self.road.size
                outline.polygon.points = [Point32(x=x, y=y), Point32(x=x + width, y=y + height)]
                return outline
        return None

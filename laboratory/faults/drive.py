# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Good images of one vehicle that drives to and fro, and the target in them."""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.ros.messages import image_message

WIDTH, HEIGHT = 64, 48
"""Size of the right images, px: small, so that thousands are sent in a minute."""
TARGET_BOX = (4.0, 18.0, 12.0, 10.0)
"""Target in them: x, y, width, height, px."""
PERIOD_NS = 33_000_000
"""Time from one image to the next, ns: 30 Hz."""
FIRST_NS = 1_700_000_000_000_000_000
"""Stamp of the first image, ns: of today, whose digits a float64 does not hold."""
_TURN = 36
"""Images from one end of the way to the other: the vehicle drives to and fro."""


def header_at(nanoseconds: int, frame_id: str = "camera") -> Header:
    """Make a header with this stamp."""
    made = Header(frame_id=frame_id)
    made.stamp.sec, made.stamp.nanosec = divmod(nanoseconds, 1_000_000_000)
    return made


class Drive:
    """Good images for ever: a vehicle that drives to and fro over noise."""

    def __init__(self) -> None:
        noise = np.random.default_rng(7).integers(90, 130, (HEIGHT, WIDTH, 3), np.uint8)
        self._frames = [self._frame(noise, offset) for offset in range(_TURN)]

    def frame(self, number: int) -> Frame:
        """Frame of the image `number`."""
        # To and fro: the way back is the way there, without its two ends.
        step = number % (2 * _TURN - 2)
        return self._frames[min(step, 2 * _TURN - 2 - step)]

    def image(self, number: int) -> Image:
        """Make the image `number`."""
        return image_message(header_at(FIRST_NS + number * PERIOD_NS), self.frame(number))

    @staticmethod
    def _frame(noise: Frame, offset: int) -> Frame:
        frame: Frame = noise.copy()
        x, y, width, height = (int(value) for value in TARGET_BOX)
        frame[y : y + height, x + offset : x + offset + width] = (200, 40, 30)
        frame[y : y + height // 2, x + offset : x + offset + width] = (30, 60, 210)
        return frame

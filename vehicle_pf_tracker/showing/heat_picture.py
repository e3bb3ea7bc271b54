# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of where vehicles drove and where they stood."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.counting.counter import CONFIRMED
from vehicle_pf_tracker.results.output_files import write_picture
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_STANDING = 0.2
"""Speed in widths per s below which a vehicle stands: a third of a metre per s, slower than anybody
drives, and what the noise of a standing vehicle's box leaves of its speed."""
_LONGEST_GAP = 1.0
"""Longest time in s that a frame stands for; over a longer one nobody knows who was there."""
_FOOTPRINT = 0.3
"""Lower part of a box, as a share of its height, that is taken for the road below the vehicle."""
_DROVE, _STOOD = (40, 160, 255), (255, 60, 30)
_MOST_OPAQUE = 0.8
"""Opacity of the place with the longest time, so that the road can be seen below it."""


class HeatPicture:
    """Shows where vehicles drove and where they stood, by the time that they were there."""

    def __init__(self) -> None:
        self._seconds = np.zeros((2, 0, 0), np.float32)
        self._last_ns = 0

    def add(
        self, frame: Frame, estimates: Sequence[TrackEstimate], stamp_ns: int, period: float
    ) -> None:
        """Take the next frame and the nominal period in s; another size begins anew."""
        gap, self._last_ns = (stamp_ns - self._last_ns) * 1e-9, stamp_ns
        seconds = gap if 0 < gap < _LONGEST_GAP else period
        if self._seconds.shape[1:] != frame.shape[:2]:
            self._seconds = np.zeros((2, *frame.shape[:2]), np.float32)
        width, height = frame_size(frame)
        for one in estimates:
            if one.mode in CONFIRMED:
                box, speed = one.box, float(np.hypot(*one.velocity)) / period
                (left, _), (right, bottom) = box.corners[0], box.corners[2]
                edges = [left, bottom - _FOOTPRINT * box.height, right, bottom]
                within = np.clip(np.round(edges), 0, [width, height] * 2)
                left, top, right, bottom = within.astype(int).tolist()
                stands = int(speed < _STANDING * box.width)
                self._seconds[stands, top:bottom, left:right] += seconds

    def write(self, path: Path, ground: Frame) -> None:
        """Write the picture, over `ground` in grey.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        grey = cv2.cvtColor(ground, cv2.COLOR_RGB2GRAY)
        picture = np.repeat(grey[:, :, None], 3, axis=2).astype(np.float32)
        for seconds, colour in zip(self._seconds, (_DROVE, _STOOD), strict=True):
            # By the logarithm: a car that is parked for an hour leaves the others visible.
            opacity = np.log1p(seconds) / max(np.log1p(seconds.max()), 1e-9) * _MOST_OPAQUE
            picture += opacity[:, :, None] * (np.array(colour, np.float32) - picture)
        drawn: Frame = picture.astype(np.uint8)
        width = drawing.line_width(drawn)
        for row, words in enumerate(("drove (blue)", "stood (red)"), start=1):
            line = f"{words}: at most {self._seconds[row - 1].max():.1f} s"
            drawing.write_words(drawn, line, (5 * width, 16 * width * row), drawing.NEUTRAL, width)
        write_picture(path, drawn)

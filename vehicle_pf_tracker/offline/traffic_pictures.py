# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Pictures of a whole run over many vehicles: all paths, and where vehicles drove and stood."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.offline.drawing import NEUTRAL, line_width, pixels_at, write_words
from vehicle_pf_tracker.offline.output_files import write_picture
from vehicle_pf_tracker.offline.traffic_drawing import draw_counts, draw_vehicle, identity_colour
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_LEAST_WIDTH = 640
"""Width in px below which the picture is enlarged, so that numbers are smaller than vehicles."""
_HIDDEN = 0.4
"""Brightness of a path's hidden parts."""


class PathPicture:
    """Draws the path of every confirmed vehicle over the frame that shows the most of them.

    Paths are drawn as they grow: memory depends on the number of vehicles, not on the time.

    Attributes
    ----------
    ground : Frame or None
        The frame that shows the most vehicles; None before the first.
    """

    def __init__(self) -> None:
        self._begin((0, 0), 1)

    def _begin(self, size: tuple[int, int], scale: int) -> None:
        """Begin anew for frames of (height, width) px, enlarged `scale` times."""
        self._size, self._scale = size, scale
        self._ends: dict[int, tuple[int, int]] = {}
        self._layer: Frame = np.zeros((size[0] * scale, size[1] * scale, 3), np.uint8)
        self.ground: Frame | None = None
        self._on_ground: list[TrackEstimate] = []

    def add(self, frame: Frame, estimates: Sequence[TrackEstimate]) -> None:
        """Take the next frame; one of another size begins the picture anew."""
        size = frame.shape[0], frame.shape[1]
        if size != self._size:
            self._begin(size, max(1, round(_LEAST_WIDTH / frame.shape[1])))
        visible = [one for one in estimates if one.mode is TrackMode.TRACKING]
        if self.ground is None or len(visible) > len(self._on_ground):
            self.ground, self._on_ground = frame.copy(), visible
        for one in estimates:
            if one.mode in CONFIRMED:
                self._extend(one)

    def write(self, path: Path, counter: Counter) -> None:
        """Write the picture, where there was a frame.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        if self.ground is None:
            return
        scale, (height, width) = self._scale, self._size
        enlarged = cv2.resize(
            self.ground, (width * scale, height * scale), interpolation=cv2.INTER_CUBIC
        )
        picture: Frame = np.asarray(enlarged, np.uint8)
        drawn = self._layer.any(axis=2)
        picture[drawn] = self._layer[drawn]
        for one in self._on_ground:
            box = Box(*(scale * value for value in astuple(one.box)))
            draw_vehicle(picture, replace(one, box=box))
        draw_counts(picture, counter, scale)
        write_picture(path, picture)

    def _extend(self, estimate: TrackEstimate) -> None:
        (end,) = pixels_at(np.array([estimate.box.centre]) * self._scale)
        begin = self._ends.get(estimate.identity, end)
        share = _HIDDEN if estimate.mode is TrackMode.OCCLUDED else 1.0
        red, green, blue = (int(share * value) for value in identity_colour(estimate.identity))
        cv2.line(self._layer, begin, end, (red, green, blue), line_width(self._layer))
        self._ends[estimate.identity] = end


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
                ends = (box.x, box.x + box.width), (
                    box.y + (1 - _FOOTPRINT) * box.height, box.y + box.height,
                )  # fmt: skip
                (left, right), (top, bottom) = np.clip(
                    np.round(ends), 0, [[width], [height]]
                ).astype(int)
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
        width = line_width(drawn)
        most = [f"{seconds.max():.1f} s" for seconds in self._seconds]
        words = f"drove (blue): at most {most[0]}", f"stood (red): at most {most[1]}"
        for row, line in enumerate(words, start=1):
            write_words(drawn, line, (5 * width, 16 * width * row), NEUTRAL, width)
        write_picture(path, drawn)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of where vehicles drove and where they stood."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.counting.counter import COUNTED_MODES
from vehicle_pf_tracker.results.output_files import write_picture
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_STANDING = 0.2
"""Speed in widths per s below which a vehicle stands: a third of a metre per s, slower than anybody
drives, and what the noise of a standing vehicle's box leaves of its speed."""
_LONGEST_GAP = 1.0
"""Longest time in s that a frame stands for; over a longer one nobody knows who was there."""
_FOOTPRINT = 0.3
"""Lower part of a box, as a share of its height, that is taken for the road below the vehicle: what
a camera on a mast sees of a car's length is about as high."""
_COLOURS: tuple[tuple[str, drawing.Colour], ...] = (
    ("drove", (40, 160, 255)),
    ("stood", (255, 60, 30)),
)
"""Words and colour of each layer: blue and red, which the colour-blind distinguish."""
_MOST_OPAQUE = 0.8
"""Opacity of the place with the longest time, so that the road can be seen below it."""
_LEAST_SCALE = 1.0
"""Time in s at the end of the scale at least: a run without a stop or a jam is not dramatic."""
_BAR = (80, 7)
"""Length and height of a colour bar, in widths of a letter's stroke: as wide as the words."""


class HeatPicture:
    """Picture of where vehicles drove and where they stood, by the time that they were there.

    Both are on one scale, which bars in the corner show.
    """

    def __init__(self) -> None:
        self._seconds = np.zeros((2, 0, 0), np.float32)
        self._last_ns = 0

    def add(
        self, frame: Frame, estimates: Sequence[TrackEstimate], stamp_ns: int, period: float
    ) -> None:
        """Take the next frame and the nominal period in s; another size begins anew."""
        gap = (stamp_ns - self._last_ns) * 1e-9
        self._last_ns = stamp_ns
        seconds = gap if 0 < gap < _LONGEST_GAP else period
        if self._seconds.shape[1:] != frame.shape[:2]:
            self._seconds = np.zeros((2, *frame.shape[:2]), np.float32)
        width, height = frame_size(frame)
        for estimate in estimates:
            if estimate.mode in COUNTED_MODES:
                box = estimate.box
                speed = float(np.hypot(*estimate.velocity)) / period
                left, _ = box.corners[0]
                right, bottom = box.corners[2]
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
        longest = max(float(self._seconds.max()), _LEAST_SCALE)
        for seconds, (_, colour) in zip(self._seconds, _COLOURS, strict=True):
            picture += _opacity(seconds, longest) * (np.array(colour, np.float32) - picture)
        drawn: Frame = picture.astype(np.uint8)
        for row, (words, colour) in enumerate(_COLOURS, start=1):
            _draw_bar(drawn, row, words, colour, longest)
        write_picture(path, drawn)


def _opacity(seconds: npt.NDArray[Any], longest: float) -> npt.NDArray[Any]:
    """Return the opacity (..., 1) of times on the scale that ends with the longest, s."""
    # By the logarithm: a car that is parked for an hour leaves the others visible.
    opacity: npt.NDArray[Any] = (np.log1p(seconds) / np.log1p(longest) * _MOST_OPAQUE)[..., None]
    return opacity


def _draw_bar(picture: Frame, row: int, words: str, colour: drawing.Colour, longest: float) -> None:
    """Draw the colours of the scale, from no time to the longest in s, with its meaning."""
    unit = drawing.letter_width(picture)
    length, height = (round(side * unit) for side in _BAR)
    left = round(5 * unit)
    bottom = round(16 * unit * row)
    bar = picture[max(bottom - height, 0) : bottom, left : left + length]
    times = np.expm1(np.linspace(0.0, np.log1p(longest), bar.shape[1]))
    ground = np.full(3, 128.0)  # the middle of the grey that the picture has
    bar[:] = ground + _opacity(times, longest) * (np.array(colour, float) - ground)
    corner = left + length + round(4 * unit), bottom
    text = f"{words}: 0 to {longest:.1f} s, log."
    drawing.write_words(picture, text, corner, drawing.NEUTRAL, unit, shaded=True)

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

"""Vehicles, lines and zones drawn into images, and a picture of all paths of a run."""

from __future__ import annotations

import colorsys
import functools
from collections.abc import Iterable, Sequence
from dataclasses import astuple, replace
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.drawing import (
    NEUTRAL,
    Colour,
    draw_box,
    line_width,
    pixels_at,
    write_words,
)
from vehicle_pf_tracker.offline.output_files import write_picture
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.watches import ENTRY, EXIT

_PLAN: Colour = (255, 255, 255)
_GOLDEN = 0.6180339887498949
"""Golden ratio: multiples of it modulo 1 stay apart as far as their number allows."""
_LETTER = 14
"""Height of a line of words, in line widths."""


@functools.lru_cache(maxsize=1024)
def identity_colour(identity: int) -> Colour:
    """Return the colour of a vehicle; numbers that follow each other have unlike ones."""
    red, green, blue = colorsys.hsv_to_rgb(identity * _GOLDEN % 1.0, 0.75, 1.0)
    return round(255 * red), round(255 * green), round(255 * blue)


def draw_vehicle(picture: Frame, estimate: TrackEstimate) -> None:
    """Draw box and number of a vehicle.

    The box is in the colour of its number, dashed where it is predicted, and grey without a number
    while it is tentative; a lost vehicle has none.
    """
    if estimate.mode is TrackMode.LOST:
        return
    width = line_width(picture)
    if estimate.mode is TrackMode.TENTATIVE:
        draw_box(picture, estimate.box, NEUTRAL, width)
        return
    colour, is_hidden = identity_colour(estimate.identity), estimate.mode is TrackMode.OCCLUDED
    draw_box(picture, estimate.box, colour, width, dashed=is_hidden)
    ((x, y),) = pixels_at(np.array([[estimate.box.x, estimate.box.y]]))
    words = f"{estimate.identity} {estimate.label}".rstrip()
    words = f"{words} {estimate.mode.value}" if is_hidden else words
    write_words(picture, words, (max(x, 0), max(y - 3 * width, _LETTER * width)), colour, width)


def draw_counts(picture: Frame, counter: Counter, scale: float = 1.0) -> None:
    """Draw lines with the crossings of each direction, and zones with their occupancy.

    Parameters
    ----------
    picture : Frame
        Written to.
    counter : Counter
        Counts, with their lines and zones.
    scale : float
        Pixels of `picture` per pixel of the images.
    """
    width = line_width(picture)
    for line in counter.plan.lines:
        start, end = pixels_at(np.array([line.start, line.end]) * scale)
        cv2.line(picture, start, end, _PLAN, width, cv2.LINE_AA)
        counts = ", ".join(f"{counter.count(line.name, to)} {to}" for to in line.directions)
        _write_at(picture, f"{line.name}: {counts}", start)
    for zone in counter.plan.zones:
        corners = pixels_at(np.array(zone.corners) * scale)
        outline = np.array(corners, np.int32).reshape(-1, 1, 2)
        cv2.polylines(picture, [outline], True, _PLAN, width, cv2.LINE_AA)
        entries, exits = (counter.count(zone.name, to) for to in (ENTRY, EXIT))
        there = counter.occupancy[zone.name]
        words = f"{zone.name}: {there} ({entries} entered, {exits} left)"
        _write_at(picture, words, min(corners, key=lambda corner: corner[1]))


def annotated(
    frame: Frame, words: str, estimates: Iterable[TrackEstimate], counter: Counter | None = None
) -> Frame:
    """Return a copy of `frame` with counts, vehicles and a line of words."""
    picture: Frame = np.array(frame, order="C")
    if counter is not None:
        draw_counts(picture, counter)
    for estimate in estimates:
        draw_vehicle(picture, estimate)
    width = line_width(picture)
    write_words(picture, words, (5 * width, 16 * width), NEUTRAL, width)
    return picture


def _write_at(picture: Frame, words: str, point: tuple[int, int]) -> None:
    """Write words above a point, moved into the picture where it is outside."""
    width, (height, across) = line_width(picture), picture.shape[:2]
    x = min(max(point[0] + 3 * width, 0), 0.8 * across)
    # Not in the topmost line, which has the time.
    y = min(max(point[1] - 3 * width, 2.3 * _LETTER * width), height - 3 * width)
    write_words(picture, words, (int(x), int(y)), _PLAN, width)


_LEAST_WIDTH = 640
"""Width in px below which the picture is enlarged, so that numbers are smaller than vehicles."""
_HIDDEN = 0.4
"""Brightness of a path's hidden parts."""


class PathPicture:
    """Draws the path of every confirmed vehicle over the frame that shows the most of them.

    Paths are drawn as they grow: memory depends on the number of vehicles, not on the time.
    """

    def __init__(self) -> None:
        self._begin((0, 0), 1)

    def _begin(self, size: tuple[int, int], scale: int) -> None:
        """Begin anew for frames of (height, width) px, enlarged `scale` times."""
        self._size, self._scale = size, scale
        self._ends: dict[int, tuple[int, int]] = {}
        self._layer: Frame = np.zeros((size[0] * scale, size[1] * scale, 3), np.uint8)
        self._ground: Frame | None = None
        self._on_ground: list[TrackEstimate] = []

    def add(self, frame: Frame, estimates: Sequence[TrackEstimate]) -> None:
        """Take the next frame; one of another size begins the picture anew."""
        size = frame.shape[0], frame.shape[1]
        if size != self._size:
            self._begin(size, max(1, round(_LEAST_WIDTH / frame.shape[1])))
        visible = [one for one in estimates if one.mode is TrackMode.TRACKING]
        if self._ground is None or len(visible) > len(self._on_ground):
            self._ground, self._on_ground = frame.copy(), visible
        for one in estimates:
            if one.mode in CONFIRMED:
                self._extend(one)

    def write(self, path: Path, counter: Counter | None = None) -> bool:
        """Write the picture; False where there was no frame.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        if self._ground is None:
            return False
        scale, (height, width) = self._scale, self._size
        enlarged = cv2.resize(
            self._ground, (width * scale, height * scale), interpolation=cv2.INTER_CUBIC
        )
        picture: Frame = np.asarray(enlarged, np.uint8)
        drawn = self._layer.any(axis=2)
        picture[drawn] = self._layer[drawn]
        for one in self._on_ground:
            box = Box(*(scale * value for value in astuple(one.box)))
            draw_vehicle(picture, replace(one, box=box))
        if counter is not None:
            draw_counts(picture, counter, scale)
        write_picture(path, picture)
        return True

    def _extend(self, estimate: TrackEstimate) -> None:
        (end,) = pixels_at(np.array([estimate.box.centre]) * self._scale)
        begin = self._ends.get(estimate.identity, end)
        share = _HIDDEN if estimate.mode is TrackMode.OCCLUDED else 1.0
        red, green, blue = (int(share * value) for value in identity_colour(estimate.identity))
        cv2.line(self._layer, begin, end, (red, green, blue), line_width(self._layer))
        self._ends[estimate.identity] = end

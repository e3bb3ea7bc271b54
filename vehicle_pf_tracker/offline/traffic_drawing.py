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
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

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


_PLACES = 16
"""Points of a path that its number may stand at."""
_MOST_NUMBERS = 200
"""Numbers written, those of the longest paths: more of them hide the road."""
_LEAST_WIDTH = 640
"""Width in px below which the picture is enlarged, so that numbers are smaller than vehicles."""
_HIDDEN = 0.4
"""Brightness of a path's hidden parts."""

Pixel: TypeAlias = tuple[int, int]


@dataclass(slots=True)
class _Path:
    """An even choice of a path's points, for its number; its lines are drawn already."""

    last: Pixel
    places: list[Pixel] = field(default_factory=list)
    length: int = 0
    stride: int = 1

    def add(self, point: Pixel) -> None:
        if self.length % self.stride == 0:
            self.places.append(point)
        if len(self.places) > _PLACES:
            self.places, self.stride = self.places[::2], 2 * self.stride
        self.last = point
        self.length += 1

    def from_middle(self) -> list[Pixel]:
        """Return the points, those next to the middle first."""
        middle = len(self.places) // 2
        order = sorted(range(len(self.places)), key=lambda index: abs(index - middle))
        return [self.places[index] for index in order]


class PathPicture:
    """Draws the path of every confirmed vehicle over the frame that shows the most of them.

    Paths are drawn as they grow: memory depends on the number of vehicles, not on the time.
    """

    def __init__(self) -> None:
        self._begin((0, 0), 1)

    def _begin(self, size: tuple[int, int], scale: int) -> None:
        """Begin anew for frames of (height, width) px, enlarged `scale` times."""
        self._size, self._scale = size, scale
        self.paths: dict[int, _Path] = {}
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
        picture = self._enlarged(self._ground)
        drawn = self._layer.any(axis=2)
        picture[drawn] = self._layer[drawn]
        width = line_width(picture)
        for one in self._on_ground:
            draw_box(picture, self._scaled(one.box), identity_colour(one.identity), width)
        self._write_numbers(picture)
        if counter is not None:
            draw_counts(picture, counter, self._scale)
        write_picture(path, picture)
        return True

    def _extend(self, estimate: TrackEstimate) -> None:
        ((x, y),) = pixels_at(np.array([estimate.box.centre]) * self._scale)
        path = self.paths.get(estimate.identity)
        if path is None:
            path = self.paths[estimate.identity] = _Path((x, y))
        red, green, blue = identity_colour(estimate.identity)
        share = _HIDDEN if estimate.mode is TrackMode.OCCLUDED else 1.0
        colour = int(share * red), int(share * green), int(share * blue)
        cv2.line(self._layer, path.last, (x, y), colour, line_width(self._layer))
        path.add((x, y))

    def _write_numbers(self, picture: Frame) -> None:
        """Write each number once: above its box, else on its path where no other number is."""
        width, taken = line_width(picture), np.zeros(picture.shape[:2], bool)
        places: dict[int, list[Pixel]] = {}
        for one in self._on_ground:
            ((x, y),) = pixels_at(np.array([[one.box.x, one.box.y]]) * self._scale)
            places[one.identity] = [(max(x, 0), max(y - 3 * width, 14 * width))]
        longest = sorted(self.paths, key=lambda identity: -self.paths[identity].length)
        for identity in longest[:_MOST_NUMBERS]:
            places.setdefault(identity, self.paths[identity].from_middle())
        for identity, of_path in places.items():
            words = str(identity)
            size = 9 * width * len(words), 13 * width
            x, y = next((at for at in of_path if _is_free(taken, at, size)), of_path[-1])
            taken[max(y - size[1], 0) : max(y, 0), max(x, 0) : max(x + size[0], 0)] = True
            write_words(picture, words, (x, y), identity_colour(identity), width)

    def _enlarged(self, frame: Frame) -> Frame:
        size = frame.shape[1] * self._scale, frame.shape[0] * self._scale
        enlarged: Frame = cv2.resize(frame, size, interpolation=cv2.INTER_CUBIC)  # type: ignore[assignment]
        return enlarged

    def _scaled(self, box: Box) -> Box:
        return Box(*(value * self._scale for value in (box.x, box.y, box.width, box.height)))


def _is_free(taken: npt.NDArray[np.bool_], place: Pixel, size: tuple[int, int]) -> bool:
    """Test whether words of this size fit at `place`, inside the picture and over no others."""
    (x, y), (width, height) = place, size
    if x < 0 or y - height < 0 or x + width > taken.shape[1] or y > taken.shape[0]:
        return False
    return not taken[y - height : y, x : x + width].any()

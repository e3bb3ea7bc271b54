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

"""Vehicles, lines and zones drawn into images."""

from __future__ import annotations

import colorsys
import functools
from collections.abc import Iterable

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.lettering import line_width, write_words
from vehicle_pf_tracker.image.outlines import Colour, draw_box, pixels_at
from vehicle_pf_tracker.trackers.traffic.counting import Counter
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.zone_watch import ENTRY, EXIT

NEUTRAL: Colour = (200, 200, 200)
"""Colour of words, and of vehicles that are not confirmed."""
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

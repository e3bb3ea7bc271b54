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
from collections import deque
from collections.abc import Iterable

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.drawing import (
    LETTER,
    NEUTRAL,
    Colour,
    draw_box,
    draw_path,
    line_width,
    write_above,
    write_words,
)
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter, reference_point
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.watches import ENTRY, EXIT

_PLAN: Colour = (255, 255, 255)
_GOLDEN = 0.6180339887498949
"""Golden ratio: multiples of it modulo 1 stay apart as far as their number allows."""
_TRAIL = 60
"""Positions of a trail: two seconds of 30 Hz, about a car's way through the picture."""


@functools.lru_cache(maxsize=1024)
def identity_colour(identity: int) -> Colour:
    """Return the colour of a vehicle; numbers that follow each other have unlike ones."""
    red, green, blue = colorsys.hsv_to_rgb(identity * _GOLDEN % 1.0, 0.75, 1.0)
    return round(255 * red), round(255 * green), round(255 * blue)


class Trails:
    """Paths of the vehicles over the last images, drawn behind them."""

    def __init__(self) -> None:
        self.of: dict[int, deque[Position]] = {}

    def add(self, estimates: Iterable[TrackEstimate]) -> None:
        """Take the next image; the trail of a vehicle that is not in sight of it ends."""
        before, self.of = self.of, {}
        for one in estimates:
            if one.mode in CONFIRMED:
                self.of[one.serial] = before.get(one.serial) or deque(maxlen=_TRAIL)
                self.of[one.serial].append(reference_point(one.box))


def draw_vehicle(
    picture: Frame,
    estimate: TrackEstimate,
    kmh: float | None = None,
    trail: Iterable[Position] = (),
) -> None:
    """Draw box, number, class, speed and trail of a vehicle.

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
    draw_path(picture, trail, colour)
    draw_box(picture, estimate.box, colour, width, dashed=is_hidden)
    words = [str(estimate.identity), estimate.label, "" if kmh is None else f"{kmh:.0f} km/h"]
    words += [estimate.mode.value] if is_hidden else []
    write_above(picture, " ".join(filter(None, words)), estimate.box, colour)


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
    for line in counter.plan.lines:
        ends = np.array([line.start, line.end]) * scale
        draw_path(picture, ends, _PLAN)
        counts = ", ".join(f"{counter.count(line.name, to)} {to}" for to in line.directions)
        _write_at(picture, f"{line.name}: {counts}", ends[0])
    for zone in counter.plan.zones:
        corners = np.array(zone.corners) * scale
        draw_path(picture, corners, _PLAN, closed=True)
        entries, exits = (counter.count(zone.name, to) for to in (ENTRY, EXIT))
        there = counter.occupancy[zone.name]
        words = f"{zone.name}: {there} ({entries} entered, {exits} left)"
        _write_at(picture, words, corners[corners[:, 1].argmin()])


def annotated(
    frame: Frame,
    words: str,
    estimates: Iterable[TrackEstimate],
    counter: Counter,
    trails: Trails | None = None,
) -> Frame:
    """Return a copy of `frame` with counts, vehicles and a line of words."""
    picture: Frame = np.array(frame, order="C")
    draw_counts(picture, counter)
    for one in estimates:
        trail = trails.of.get(one.serial, ()) if trails is not None else ()
        draw_vehicle(picture, one, counter.speed_kmh(one.serial), trail)
    width = line_width(picture)
    write_words(picture, words, (5 * width, 16 * width), NEUTRAL, width)
    return picture


def _write_at(picture: Frame, words: str, point: Array) -> None:
    """Write words above a point, moved into the picture where it is outside."""
    width, (height, across) = line_width(picture), picture.shape[:2]
    x = min(max(point[0] + 3 * width, 0), 0.8 * across)
    # Not in the topmost line, which has the time.
    y = min(max(point[1] - 3 * width, 2.3 * LETTER * width), height - 3 * width)
    write_words(picture, words, (int(x), int(y)), _PLAN, width)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles, lines and zones drawn into images."""

from __future__ import annotations

import colorsys
import functools
from collections import deque
from collections.abc import Iterable

import numpy as np

from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.counting.foot_point import foot_of
from vehicle_pf_tracker.counting.zone_watch import ZONE_ENTRY, ZONE_EXIT
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.drawing import Labels
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_PLAN: drawing.Colour = (255, 255, 255)
"""Colour of lines and zones: white, which no vehicle's number gives."""
_GOLDEN = 0.6180339887498949
"""Golden ratio: multiples of it modulo 1 stay apart as far as their number allows."""
_TRAIL = 60
"""Positions of a trail: two seconds of 30 Hz, about a car's way through the picture."""


@functools.lru_cache(maxsize=1024)
def identity_colour(identity: int) -> drawing.Colour:
    """Return the colour of a vehicle; numbers that follow each other have unlike ones."""
    hue = identity * _GOLDEN % 1.0
    # Paler from blue to violet, which the eye sees darker: thin words of full blue are illegible.
    red, green, blue = colorsys.hsv_to_rgb(hue, 0.5 if 0.58 < hue < 0.85 else 0.75, 1.0)
    return round(255 * red), round(255 * green), round(255 * blue)


class Trails:
    """Paths of the vehicles over the last images, drawn behind them."""

    def __init__(self) -> None:
        self.of: dict[int, deque[Position]] = {}

    def add(self, estimates: Iterable[TrackEstimate]) -> None:
        """Take the next image; the trail of a vehicle that is lost or no longer followed ends."""
        before = self.of
        self.of = {}
        for estimate in estimates:
            if estimate.mode in COUNTED_MODES:
                self.of[estimate.serial] = before.get(estimate.serial) or deque(maxlen=_TRAIL)
                self.of[estimate.serial].append(foot_of(estimate.box))


def draw_vehicle(
    picture: Frame, labels: Labels, estimate: TrackEstimate, kmh: float | None = None
) -> None:
    """Draw the box of a vehicle, and label it with number, class and speed.

    The box is in the colour of its number, and dashed where it is predicted; a vehicle that is
    tentative or lost has none.
    """
    if estimate.mode not in COUNTED_MODES:
        return
    width = drawing.line_width(picture)
    colour = identity_colour(estimate.identity)
    is_hidden = estimate.mode is TrackMode.OCCLUDED
    drawing.draw_box(picture, estimate.box, colour, width, dashed=is_hidden)
    number = f"#{estimate.identity}"
    speed = "" if kmh is None else f"{kmh:.0f} km/h"
    named = f"{number} {estimate.label}".rstrip()
    words = "  ".join(filter(None, (named, speed, "hidden" if is_hidden else "")))
    labels.append((estimate.box, colour, (words, number)))


def draw_counts(picture: Frame, labels: Labels, counter: Counter, scale: float = 1.0) -> None:
    """Draw lines with the crossings of each direction, and zones with their occupancy.

    Parameters
    ----------
    picture : Frame
        Written to.
    labels : list of Label
        Takes the words.
    counter : Counter
        Counts, with their lines and zones.
    scale : float
        Pixels of `picture` per pixel of the images.
    """
    for line in counter.plan.lines:
        ends = np.array([line.start, line.end]) * scale
        drawing.draw_path(picture, ends, _PLAN)
        counts = ", ".join(f"{counter.count(line.name, to)} {to}" for to in line.directions)
        labels.append((Box.around(ends[0].tolist(), 0, 0), _PLAN, (f"{line.name}: {counts}",)))
    for zone in counter.plan.zones:
        corners = np.array(zone.corners) * scale
        drawing.draw_path(picture, corners, _PLAN, closed=True)
        entries, exits = (counter.count(zone.name, to) for to in (ZONE_ENTRY, ZONE_EXIT))
        there = counter.occupancy[zone.name]
        words = f"{zone.name}: {there} ({entries} entered, {exits} left)"
        highest = corners[corners[:, 1].argmin()].tolist()
        labels.append((Box.around(highest, 0, 0), _PLAN, (words,)))


def frame_with_vehicles(
    frame: Frame, words: str, estimates: Iterable[TrackEstimate], counter: Counter, trails: Trails
) -> Frame:
    """Return a copy of `frame` with counts, vehicles and a line of words, if there are any."""
    picture: Frame = np.array(frame, order="C")
    width = drawing.letter_width(picture)
    labels: Labels = []
    if words:
        labels.append((Box(5 * width, 19 * width, 0, 0), drawing.NEUTRAL, (words,)))
    draw_counts(picture, labels, counter)
    for estimate in estimates:
        trail = trails.of.get(estimate.serial, ())
        colour = identity_colour(estimate.identity)
        drawing.draw_path(picture, trail, colour)
        draw_vehicle(picture, labels, estimate, counter.speed_kmh(estimate.serial))
    drawing.write_labels(picture, labels)
    return picture

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles, lines and zones drawn into images."""

from __future__ import annotations

import colorsys
import functools
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import astuple, replace
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.counting.counter import CONFIRMED, Counter, reference_point
from vehicle_pf_tracker.counting.watches import ENTRY, EXIT
from vehicle_pf_tracker.results.output_files import write_picture
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.drawing import Labels
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_PLAN: drawing.Colour = (255, 255, 255)
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
        """Take the next image; the trail of a vehicle that is not in sight of it ends."""
        before, self.of = self.of, {}
        for one in estimates:
            if one.mode in CONFIRMED:
                self.of[one.serial] = before.get(one.serial) or deque(maxlen=_TRAIL)
                self.of[one.serial].append(reference_point(one.box))


def draw_vehicle(
    picture: Frame, labels: Labels, estimate: TrackEstimate, kmh: float | None = None
) -> None:
    """Draw the box of a vehicle, and label it with number, class and speed.

    The box is in the colour of its number, and dashed where it is predicted; a vehicle that is
    tentative or lost has none.
    """
    if estimate.mode not in CONFIRMED:
        return
    width = drawing.line_width(picture)
    colour, is_hidden = identity_colour(estimate.identity), estimate.mode is TrackMode.OCCLUDED
    drawing.draw_box(picture, estimate.box, colour, width, dashed=is_hidden)
    words = [str(estimate.identity), estimate.label, "" if kmh is None else f"{kmh:.0f} km/h"]
    words += [estimate.mode.value] if is_hidden else []
    labels.append((estimate.box, colour, (" ".join(filter(None, words)), words[0])))


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
        entries, exits = (counter.count(zone.name, to) for to in (ENTRY, EXIT))
        there = counter.occupancy[zone.name]
        words = f"{zone.name}: {there} ({entries} entered, {exits} left)"
        highest = corners[corners[:, 1].argmin()].tolist()
        labels.append((Box.around(highest, 0, 0), _PLAN, (words,)))


def annotated(
    frame: Frame, words: str, estimates: Iterable[TrackEstimate], counter: Counter, trails: Trails
) -> Frame:
    """Return a copy of `frame` with counts, vehicles and a line of words."""
    picture: Frame = np.array(frame, order="C")
    width = drawing.line_width(picture)
    labels: Labels = [(Box(5 * width, 19 * width, 0, 0), drawing.NEUTRAL, (words,))]
    draw_counts(picture, labels, counter)
    for one in estimates:
        trail, colour = trails.of.get(one.serial, ()), identity_colour(one.identity)
        drawing.draw_path(picture, trail, colour)
        draw_vehicle(picture, labels, one, counter.speed_kmh(one.serial))
    drawing.write_labels(picture, labels)
    return picture


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
                (end,) = drawing.pixels_at(np.array([one.box.centre]) * self._scale)
                begin, self._ends[one.identity] = self._ends.get(one.identity, end), end
                share = _HIDDEN if one.mode is TrackMode.OCCLUDED else 1.0
                colour = [int(share * value) for value in identity_colour(one.identity)]
                cv2.line(self._layer, begin, end, colour, drawing.line_width(self._layer))

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
        size = width * scale, height * scale
        picture = np.asarray(cv2.resize(self.ground, size, interpolation=cv2.INTER_CUBIC), np.uint8)
        drawn = self._layer.any(axis=2)
        picture[drawn] = self._layer[drawn]
        labels: Labels = []
        draw_counts(picture, labels, counter, scale)
        for one in self._on_ground:
            box = Box(*(scale * value for value in astuple(one.box)))
            draw_vehicle(picture, labels, replace(one, box=box))
        drawing.write_labels(picture, labels)
        write_picture(path, picture)


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

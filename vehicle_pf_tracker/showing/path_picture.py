# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of the paths of all vehicles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.results.output_files import write_picture
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.drawing import Labels
from vehicle_pf_tracker.showing.lanes import Lanes
from vehicle_pf_tracker.showing.traffic_drawing import draw_counts, draw_vehicle, identity_colour
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_LEAST_WIDTH = 640
"""Width in px below which the picture is enlarged, so that numbers are smaller than vehicles."""
_HIDDEN = 0.4
"""Brightness of a path's hidden parts: they are guesses, and less sure than the rest."""
_LANES_FROM = 12
"""Number of vehicles above which lanes are drawn: more lines of their own are a skein."""
_STEP = 2.0
"""Longest step that is drawn, in diagonals of the box: over a longer one, as of a vehicle that was
found again elsewhere, nobody knows the way."""
_LANE_WIDTH = 5
"""Width of a lane in widths of a line: the paths of a lane's vehicles lie about so far apart."""


class PathPicture:
    """Picture of the path of every confirmed vehicle, over the frame that shows the most of them.

    Few vehicles have lines of their colours, many are lanes coloured by their heading. Paths are
    drawn as they grow: memory depends on the number of vehicles, not on the time.

    Attributes
    ----------
    ground : Frame or None
        The frame that shows the most vehicles; None before the first.
    """

    def __init__(self) -> None:
        self._begin((0, 0), 1)

    def _begin(self, size: tuple[int, int], scale: int) -> None:
        """Begin anew for frames of (height, width) px, enlarged `scale` times."""
        self._size = size
        self._scale = scale
        self._ends: dict[int, tuple[int, int]] = {}
        self._layer: Frame = np.zeros((size[0] * scale, size[1] * scale, 3), np.uint8)
        self._lanes = Lanes(self._layer.shape[:2])
        self.ground: Frame | None = None
        self._on_ground: list[TrackEstimate] = []

    def add(self, frame: Frame, estimates: Sequence[TrackEstimate]) -> None:
        """Take the next frame; one of another size begins the picture anew."""
        size = frame.shape[0], frame.shape[1]
        if size != self._size:
            self._begin(size, max(1, round(_LEAST_WIDTH / frame.shape[1])))
        visible = [estimate for estimate in estimates if estimate.mode is TrackMode.TRACKING]
        if self.ground is None or len(visible) > len(self._on_ground):
            self.ground = frame.copy()
            self._on_ground = visible
        for vehicle in estimates:
            if vehicle.mode in COUNTED_MODES:
                (end,) = drawing.pixels_at(np.array([vehicle.box.centre]) * self._scale)
                begin = self._ends.get(vehicle.identity, end)
                self._ends[vehicle.identity] = end
                reach = _STEP * self._scale * math.hypot(vehicle.box.width, vehicle.box.height)
                if math.dist(begin, end) > reach:
                    continue
                self._lanes.add(begin, end, _LANE_WIDTH * drawing.line_width(self._layer))
                share = _HIDDEN if vehicle.mode is TrackMode.OCCLUDED else 1.0
                colour = [int(share * value) for value in identity_colour(vehicle.identity)]
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
        scale = self._scale
        height, width = self._size
        size = width * scale, height * scale
        picture = np.asarray(cv2.resize(self.ground, size, interpolation=cv2.INTER_CUBIC), np.uint8)
        if len(self._ends) >= _LANES_FROM:
            self._lanes.draw(picture)
        else:
            drawn = self._layer.any(axis=2)
            picture[drawn] = self._layer[drawn]
        labels: Labels = []
        draw_counts(picture, labels, counter, scale)
        for vehicle in self._on_ground:
            box = Box(*(scale * value for value in astuple(vehicle.box)))
            draw_vehicle(picture, labels, replace(vehicle, box=box))
        drawing.write_labels(picture, labels)
        write_picture(path, picture)

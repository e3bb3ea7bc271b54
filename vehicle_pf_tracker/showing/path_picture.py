# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of the paths of all vehicles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.counting.counter import CONFIRMED, Counter
from vehicle_pf_tracker.results.output_files import write_picture
from vehicle_pf_tracker.showing import drawing
from vehicle_pf_tracker.showing.drawing import Labels
from vehicle_pf_tracker.showing.traffic_drawing import draw_counts, draw_vehicle, identity_colour
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

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

"""Estimates drawn over the images of a run: box, path and mode of each target."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.mode_spans import clock_words
from vehicle_pf_tracker.image.lettering import line_width, write_words
from vehicle_pf_tracker.image.outlines import Colour, draw_box, pixels_at
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

COLOURS: dict[str, Colour] = {
    Mode.TRACKING.value: (64, 220, 64),
    Mode.OCCLUDED.value: (255, 176, 0),
    Mode.LOST.value: (255, 48, 48),
}
"""Colour of each mode, (red, green, blue); `NEUTRAL` for frames without an estimate."""
NEUTRAL: Colour = (200, 200, 200)
_PARTICLE: Colour = (96, 160, 255)
_PATH_LENGTH = 300
"""Positions shown of a path: ten seconds of video, longer ones hide the road."""


class Annotator:
    """Draws one target; keeps its path.

    Parameters
    ----------
    name : str
        Name of the target; empty where there is only one.
    particles : bool
        Draw the particles too.
    """

    def __init__(self, name: str = "", *, particles: bool = False) -> None:
        self._name = name
        self._shows_particles = particles
        self._path: deque[tuple[float, float]] = deque(maxlen=_PATH_LENGTH)

    def follow(self, estimate: Estimate | None) -> None:
        """Continue the path; a lost target ends it."""
        if estimate is None or estimate.mode is Mode.LOST:
            self._path.clear()
        else:
            self._path.append(estimate.position)

    def draw(self, picture: Frame, estimate: Estimate | None) -> None:
        """Draw a frame's estimate into `picture`.

        A predicted position, under an occluder, is dashed; a lost target has neither box nor path.
        """
        if estimate is None or estimate.mode is Mode.LOST:
            return
        colour, width = COLOURS[estimate.mode.value], line_width(picture)
        if self._shows_particles:
            for centre in pixels_at(estimate.particles):
                cv2.circle(picture, centre, width, _PARTICLE, -1)
        path = np.array(pixels_at(np.asarray(self._path).reshape(-1, 2)), np.int32).reshape(
            -1, 1, 2
        )
        cv2.polylines(picture, [path], False, colour, width, cv2.LINE_AA)
        is_predicted = estimate.mode is Mode.OCCLUDED
        draw_box(picture, estimate.box, colour, width, dashed=is_predicted)
        if self._name:
            x, y = pixels_at(np.asarray(estimate.box.corners))[0]
            write_words(picture, self._name, (x, max(y - 3 * width, 14 * width)), colour, width)

    def words(self, row: EstimateRow) -> str:
        """Return the target's name, mode and confidence in one line."""
        confidence = "" if row.confidence is None else f" {row.confidence:.2f}"
        return f"{self._name} {row.mode}{confidence}".lstrip()


def annotated(
    frame: Frame,
    elapsed_ns: int,
    states: Iterable[tuple[Annotator, EstimateRow, Estimate | None]],
) -> Frame:
    """Return a copy of `frame` with all targets, and a line for the time and for each of them."""
    picture: Frame = np.array(frame, order="C")
    number, lines = 0, []
    for annotator, row, estimate in states:
        annotator.draw(picture, estimate)
        lines.append((annotator.words(row), COLOURS.get(row.mode, NEUTRAL)))
        number = row.frame
    width = line_width(picture)
    head = (f"{clock_words(elapsed_ns)}  frame {number}", NEUTRAL)
    for index, (words, colour) in enumerate([head, *lines], start=1):
        write_words(picture, words, (5 * width, 16 * width * index), colour, width)
    return picture

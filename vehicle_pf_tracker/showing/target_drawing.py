# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Single targets drawn into images: box, path, particles, mode and confidence."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import TypeAlias

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.results.estimates import EstimateRow, clock_words
from vehicle_pf_tracker.showing.drawing import (
    NEUTRAL,
    Colour,
    Labels,
    draw_box,
    draw_path,
    line_width,
    pixels_at,
    write_labels,
    write_line,
)
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

MODE_COLOURS: dict[str, Colour] = {
    Mode.TRACKING.value: (64, 220, 64),
    Mode.OCCLUDED.value: (255, 176, 0),
    Mode.LOST.value: (255, 48, 48),
}
"""Colour of each mode, (red, green, blue); `NEUTRAL` for frames without an estimate."""
_PARTICLE: Colour = (96, 160, 255)
"""Colour of particles: blue, which no mode has."""
_PATH_LENGTH = 300
"""Positions shown of a path: ten seconds of video, longer ones hide the road."""


class Annotator:
    """Drawing of one target in frame after frame, with the path behind it.

    Parameters
    ----------
    name : str
        Name of the target; empty where there is only one.
    particles : bool
        Draw the particles too.
    """

    def __init__(self, name: str = "", *, particles: bool = False) -> None:
        self.name = name
        self._shows_particles = particles
        self._path: deque[tuple[float, float]] = deque(maxlen=_PATH_LENGTH)

    def follow(self, estimate: Estimate | None) -> None:
        """Continue the path; a lost target ends it."""
        if estimate is None or estimate.mode is Mode.LOST:
            self._path.clear()
        else:
            self._path.append(estimate.position)

    def draw(
        self,
        picture: Frame,
        estimate: Estimate | None,
        words: str = "",
        labels: Labels | None = None,
    ) -> bool:
        """Draw a frame's estimate into `picture`, with `words` beside it, or put into `labels`.

        A predicted position, under an occluder, is dashed; a lost target has neither box nor path,
        nor words. Returns whether anything was drawn.
        """
        if estimate is None or estimate.mode is Mode.LOST:
            return False
        colour = MODE_COLOURS[estimate.mode.value]
        width = line_width(picture)
        if self._shows_particles:
            for centre in pixels_at(estimate.particles):
                cv2.circle(picture, centre, width, _PARTICLE, -1)
        draw_path(picture, self._path, colour)
        is_predicted = estimate.mode is Mode.OCCLUDED
        draw_box(picture, estimate.box, colour, width, dashed=is_predicted)
        if label := words or self.name:
            own: Labels = [(estimate.box, colour, (label,))]
            if labels is None:
                write_labels(picture, own)
            else:
                labels += own
        return True


def write_mode(picture: Frame, mode: str, words: str, row: int) -> None:
    """Write what is to be said of a target without a box into a row at the upper left."""
    write_line(picture, words, MODE_COLOURS.get(mode, NEUTRAL), row)


def estimate_words(name: str, row: EstimateRow) -> str:
    """Return name, mode and confidence of a target in one line; the name may be empty."""
    confidence = "" if row.confidence is None else f" {row.confidence:.2f}"
    return f"{name} {row.mode}{confidence}".lstrip()


TargetState: TypeAlias = tuple[Annotator, EstimateRow, Estimate | None]
"""Drawing of a target, its row, and its estimate, None where it has none."""


def frame_with_targets(
    frame: Frame, elapsed_ns: int | None, states: Iterable[TargetState]
) -> Frame:
    """Return a copy of `frame` with all targets, their modes beside them, and a line for the time.

    A target without a box has a line below that. Where no time is given, there is no such line.
    """
    picture: Frame = np.array(frame, order="C")
    number = 0
    line = 1 if elapsed_ns is None else 2
    # Written together, so that they do not cover each other.
    labels: Labels = []
    for annotator, row, estimate in states:
        words = estimate_words(annotator.name, row)
        if not annotator.draw(picture, estimate, words, labels):
            write_mode(picture, row.mode, words, line)
            line += 1
        number = row.frame
    write_labels(picture, labels)
    if elapsed_ns is not None:
        write_line(picture, f"{clock_words(elapsed_ns)}  frame {number}", NEUTRAL)
    return picture

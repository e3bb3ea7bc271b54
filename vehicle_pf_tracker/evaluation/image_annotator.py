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

"""Estimates as annotations that Foxglove draws over the images: box, path and words by mode."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.annotation import COLOURS, NEUTRAL
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.image.lettering import line_width_of
from vehicle_pf_tracker.recordings.image_annotations import (
    LINE_LIST,
    LINE_LOOP,
    LINE_STRIP,
    Label,
    Line,
    Point,
    image_annotations,
)
from vehicle_pf_tracker.trackers.estimate import Mode

_PATH_LENGTH = 60
"""Positions in a path. Every message repeats them: 60 cost 1 kB, and show two seconds of video."""
_DASH = 4
"""Length of a dash and of a gap, in line widths."""
_LETTERS = 12
"""Height of letters, in line widths."""


class ImageAnnotator:
    """Makes the annotations of one track; keeps its path.

    Every image gets words with the mode, so that a viewer which waits for annotations of the same
    stamp shows images without an estimate too.

    Parameters
    ----------
    name : str
        Name of the track in the words; may be empty.
    size : (int, int)
        Width and height of the images in px, which lines and letters grow with.
    position : int
        Number of the track, from 0: its line in the corner where words without a box stand.
    """

    def __init__(self, name: str, size: tuple[int, int], position: int = 0) -> None:
        self._name = name
        self._width = line_width_of(size)
        self._position = position
        self._path: deque[Point] = deque(maxlen=_PATH_LENGTH)

    def annotate(self, row: EstimateRow) -> Any:
        """Continue the path with `row`, and return the message for its image."""
        box = None if row.mode == Mode.LOST else row.box
        if box is None:
            self._path.clear()
            return image_annotations(row.stamp_ns, [], [self._words(row, None)])
        self._path.append(box.centre)
        return image_annotations(row.stamp_ns, self._lines(row, box), [self._words(row, box)])

    def _lines(self, row: EstimateRow, box: Box) -> Iterator[Line]:
        colour = COLOURS[row.mode]
        corners = [(float(x), float(y)) for x, y in box.corners]
        if row.mode == Mode.OCCLUDED:
            dashes = _dashes(corners, float(_DASH * self._width))
            yield Line(LINE_LIST, dashes, colour, self._width)
        else:
            yield Line(LINE_LOOP, corners, colour, self._width)
        if len(self._path) > 1:
            yield Line(LINE_STRIP, list(self._path), colour, self._width)

    def _words(self, row: EstimateRow, box: Box | None) -> Label:
        confidence = "" if row.confidence is None else f" {row.confidence:.2f}"
        text = f"{self._name} {row.mode}{confidence}".lstrip()
        height = float(_LETTERS * self._width)
        if box is None:
            corner = (height / 2, 1.5 * height * (self._position + 1))
        else:
            corner = (max(box.x, 0.0), max(box.y - 2.0 * self._width, height))
        return Label(text, corner, COLOURS.get(row.mode, NEUTRAL), height)


def _dashes(corners: Sequence[Point], dash: float) -> list[Point]:
    """Return the ends of the dashes of a closed line, in pairs."""
    ends: list[Point] = []
    for (x, y), (to_x, to_y) in zip(corners, [*corners[1:], corners[0]], strict=True):
        length = max(abs(to_x - x), abs(to_y - y))  # the sides of a box are level or upright
        for start in range(0, int(length / dash) + 1, 2):
            for along in (start * dash, min((start + 1) * dash, length)):
                share = along / length if length else 0.0
                ends.append((x + share * (to_x - x), y + share * (to_y - y)))
    return ends

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

"""Contact sheet of a run: its key frames in one picture.

Modes of a run as stretches of time, for people.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.offline.output_files import write_picture
from vehicle_pf_tracker.trackers.estimate import Mode

THUMB_WIDTH = 400
"""Width of a key frame on the sheet, px: three of them fill a page's width."""
_COLUMNS = 3
_MOST = 12
"""Key frames on a sheet: four rows."""
_KEPT = 200
"""Key frames kept in memory, 50 MB of them, of which the sheet shows an even choice."""


class ContactSheet:
    """Keeps the first and the last frame, and those in which a mode changes."""

    def __init__(self) -> None:
        self._kept: list[Frame] = []
        self._last: Callable[[], Frame] | None = None
        self._modes: tuple[str, ...] | None = None

    def add(self, modes: tuple[str, ...], draw: Callable[[], Frame]) -> None:
        """Take the next frame: the mode of each target, and a function that draws it.

        Before and after a change both frames are kept: an occlusion's way in and its way out.
        """
        changes = modes != self._modes
        if changes and len(self._kept) < _KEPT:
            if self._modes is not None and self._last is not None:
                self._kept.append(_thumb(self._last()))
            self._kept.append(_thumb(draw()))
            self._last = None
        else:
            self._last = draw
        self._modes = modes

    def write(self, path: Path) -> bool:
        """Write the sheet; False where there was no frame.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        thumbs = [*self._kept, *([] if self._last is None else [_thumb(self._last())])]
        if not thumbs:
            return False
        chosen = np.unique(np.linspace(0, len(thumbs) - 1, min(len(thumbs), _MOST)).round())
        write_picture(path, _tiled([thumbs[int(index)] for index in chosen]))
        return True


def _thumb(picture: Frame) -> Frame:
    height = max(1, round(THUMB_WIDTH * picture.shape[0] / picture.shape[1]))
    thumb: Frame = cv2.resize(picture, (THUMB_WIDTH, height), interpolation=cv2.INTER_AREA)  # type: ignore[assignment]
    return thumb


def _tiled(thumbs: list[Frame]) -> Frame:
    height = max(thumb.shape[0] for thumb in thumbs)
    columns = min(_COLUMNS, len(thumbs))
    rows = -(-len(thumbs) // columns)
    sheet: Frame = np.full((rows * height, columns * THUMB_WIDTH, 3), 24, np.uint8)
    for index, thumb in enumerate(thumbs):
        top, left = index // columns * height, index % columns * THUMB_WIDTH
        sheet[top : top + thumb.shape[0], left : left + THUMB_WIDTH] = thumb
    return sheet


_MOST_SPANS = 12
"""Spans in a summary; more are counted, since nobody reads a line of hundreds."""


@dataclass(frozen=True, slots=True)
class ModeSpan:
    """Consecutive frames of one mode.

    Attributes
    ----------
    mode : str
        The mode.
    first, last : EstimateRow
        Rows of its first and its last frame.
    """

    mode: str
    first: EstimateRow
    last: EstimateRow


def mode_spans(rows: Sequence[EstimateRow]) -> list[ModeSpan]:
    """Group consecutive rows of one mode."""
    groups = ((mode, list(group)) for mode, group in groupby(rows, key=lambda row: row.mode))
    return [ModeSpan(mode, group[0], group[-1]) for mode, group in groups]


def summary(rows: Sequence[EstimateRow]) -> str:
    """Return the modes of a run in one sentence, times in min:s after its first frame."""
    if not rows:
        return "no frames"
    spans, start = mode_spans(rows), rows[0].stamp_ns
    words = [_words(span, start, is_last=span is spans[-1]) for span in spans[:_MOST_SPANS]]
    if len(spans) > _MOST_SPANS:
        words.append(f"and {len(spans) - _MOST_SPANS} more changes of the mode")
    tracked = sum(row.mode == Mode.TRACKING.value for row in rows)
    return f"{', '.join(words)}; {tracked} of {len(rows)} frames tracked"


def clock_words(nanoseconds: int) -> str:
    """Return a time as min:s with tenths, as ``1:07.5``."""
    tenths = round(nanoseconds / 1e8)
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def _words(span: ModeSpan, start: int, *, is_last: bool) -> str:
    first, last = (clock_words(row.stamp_ns - start) for row in (span.first, span.last))
    if is_last and span.mode == Mode.LOST.value:
        return f"LOST from {first}"
    return f"{span.mode} {first}-{last}"

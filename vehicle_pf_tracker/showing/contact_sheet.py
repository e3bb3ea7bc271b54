# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sheet of a run's key frames: its first and last, and those in which a mode changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.results.output_files import write_picture

THUMB_WIDTH = 400
"""Width of a key frame on the sheet, px: words and boxes in it can still be read."""
_COLUMNS = 3
"""Key frames beside each other: they fill the width of a page or a screen."""
_FRAMES_SHOWN = 12
"""Key frames on a sheet: four rows."""
_FRAMES_KEPT = 200
"""Key frames kept in memory, 50 MB of them, of which the sheet shows an even choice."""


class ContactSheet:
    """Sheet of the first and the last frame, and of those in which a mode changes."""

    def __init__(self) -> None:
        self._kept: list[Frame] = []
        self._last: Callable[[], Frame] | None = None
        self._modes: tuple[str, ...] | None = None

    def add(self, modes: tuple[str, ...], draw: Callable[[], Frame]) -> None:
        """Take the next frame: the mode of each target, and a function that draws it.

        Before and after a change both frames are kept: an occlusion's way in and its way out.
        """
        changes = modes != self._modes
        if changes and len(self._kept) < _FRAMES_KEPT:
            if self._modes is not None and self._last is not None:
                self._kept.append(thumbnail(self._last()))
            self._kept.append(thumbnail(draw()))
            self._last = None
        else:
            self._last = draw
        self._modes = modes

    def write(self, path: Path) -> None:
        """Write the sheet, where there was a frame.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        thumbs = [*self._kept, *([] if self._last is None else [thumbnail(self._last())])]
        if not thumbs:
            return
        chosen = np.unique(np.linspace(0, len(thumbs) - 1, min(len(thumbs), _FRAMES_SHOWN)).round())
        shown = [thumbs[int(index)] for index in chosen]
        height = max(thumb.shape[0] for thumb in shown)
        columns = min(_COLUMNS, len(shown))
        rows = -(-len(shown) // columns)
        sheet: Frame = np.full((rows * height, columns * THUMB_WIDTH, 3), 24, np.uint8)
        for index, thumb in enumerate(shown):
            row, column = divmod(index, columns)
            top = row * height
            left = column * THUMB_WIDTH
            sheet[top : top + thumb.shape[0], left : left + THUMB_WIDTH] = thumb
        write_picture(path, sheet)


def thumbnail(picture: Frame) -> Frame:
    """Scale a picture to `THUMB_WIDTH`."""
    height = max(1, round(THUMB_WIDTH * picture.shape[0] / picture.shape[1]))
    thumb: Frame = cv2.resize(picture, (THUMB_WIDTH, height), interpolation=cv2.INTER_AREA)  # type: ignore[assignment]
    return thumb

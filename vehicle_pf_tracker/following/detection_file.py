# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""File of detections in MOTChallenge's format."""

from __future__ import annotations

from array import array
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.recordings.box_sizes import misfit
from vehicle_pf_tracker.recordings.text_tables import numbers_in, table_rows

_LAST_FRAME = 10**9
"""Largest number of a frame: a year of video."""


class DetectionFile:
    """Detections by the number of their frame.

    Parameters
    ----------
    path : Path
        Text file with a row per detection: frame from 1, id (not used), left, top, width and height
        in px, score (1 where it is missing); columns after these are not used. Rows may be in any
        order.

    Attributes
    ----------
    notices : list of str
        Irregularities, a sentence each.

    Raises
    ------
    InputError
        If it cannot be read, or a row is not of this form; the row is named by its number.
    """

    def __init__(self, path: Path) -> None:
        numbers = array("d")  # 48 bytes per row: a list of a million rows would take ten times that
        text = read_text(path, "the detections")
        for where, cells in table_rows(path, text, 6, "the detections"):
            frame, _, *box = numbers_in(where, cells[:7])
            # A frame of 0 or a fraction is another format, and to be refused; a box without area
            # is an irregularity.
            if not (1 <= frame <= _LAST_FRAME and frame.is_integer()):
                raise InputError(f"{where} has the frame {frame:g}; frames are integers from 1")
            numbers.extend((frame, *box[:4], box[4] if len(box) > 4 else 1.0))
        rows: Array = np.frombuffer(numbers, np.float64).reshape(-1, 6)
        # Sorted once, to be found by bisection; within a frame the order of the file stays,
        # so that each run has the same ties.
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        self.notices: list[str] = []
        usable = np.isfinite(rows).all(axis=1) & (rows[:, 3:5] > 0).all(axis=1)
        if not usable.all():
            self.notices.append(
                f"{np.count_nonzero(~usable)} of {len(rows)} detections in {path} have no area, or "
                "numbers that are not finite, and are left out"
            )
        self._path = path
        self._frames = rows[usable, 0]
        self._rows = rows[usable, 1:]

    def misfit(self, size: tuple[int, int]) -> str:
        """Return why the boxes do not fit images of a size (px); empty where they do."""
        doubt = misfit(self._rows[:, :4], size)
        return f"the detections {self._path}: {doubt.sentence}" if doubt else ""

    def of(self, frame: int) -> Detections:
        """Return the detections of a frame; one without rows is one without vehicles."""
        begin, end = np.searchsorted(self._frames, [frame, frame + 1])
        return Detections.make(self._rows[begin:end, :4], self._rows[begin:end, 4])

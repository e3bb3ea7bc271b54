"""What a still camera saw at a place while the target was elsewhere.

A place that looks as it did then shows the background, however alike it may be to the target: a
sign at the roadside, or the part of a bridge that the vehicle has gone under.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.small_grey import SmallGrey

_KEPT = 60
_FEWEST = 6
_INNER = 0.4
"""Half side of what is compared, of the box."""
_LEAST = 2
"""px of the small frame along each side."""
_UNMOVED = 0.6
"""Share of the usual change below which a place counts as unchanged."""
_RATE = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class _Shot:
    small: SmallGrey
    target: Box


class Background:
    """The last clear frames of a camera that stands still."""

    def __init__(self) -> None:
        self._shots: deque[_Shot] = deque(maxlen=_KEPT)
        self._usual: float | None = None

    def forget(self) -> None:
        """Forget all frames, since the camera has moved."""
        self._shots.clear()

    def keep(self, small: SmallGrey, target: Box) -> None:
        """Keep a frame in which the target is where it is said to be."""
        change = self.change(small, target)
        if change is not None:
            usual = change if self._usual is None else self._usual
            self._usual = usual + _RATE * (change - usual)
        self._shots.append(_Shot(small, target))

    def shows(self, small: SmallGrey, place: Box) -> bool:
        """Whether the background is what is seen in a box; False where that is not known."""
        change = self.change(small, place)
        return change is not None and self._usual is not None and change < _UNMOVED * self._usual

    def change(self, small: SmallGrey, place: Box) -> float | None:
        """Mean change in a box since the target last stood wholly beside it, grey levels.

        None where it never did, or where too little of the box is in the image.
        """
        if len(self._shots) < _FEWEST:
            return None
        for shot in reversed(self._shots):
            if _apart(shot.target, place):
                return _mean_change(small, shot.small, place)
        return None


def _apart(one: Box, other: Box) -> bool:
    (x, y), (u, v) = one.centre, other.centre
    return (
        abs(x - u) > 0.5 * (one.width + other.width)
        or abs(y - v) > 0.5 * (one.height + other.height)
    )  # fmt: skip


def _mean_change(now: SmallGrey, then: SmallGrey, place: Box) -> float | None:
    if now.image.shape != then.image.shape:
        return None
    rows, columns = now.image.shape
    (x, y), zoom = place.centre, now.zoom
    left = max(int(zoom * (x - _INNER * place.width)), 0)
    top = max(int(zoom * (y - _INNER * place.height)), 0)
    right = min(int(zoom * (x + _INNER * place.width)) + 1, columns)
    bottom = min(int(zoom * (y + _INNER * place.height)) + 1, rows)
    if right - left < _LEAST or bottom - top < _LEAST:
        return None
    inside = np.s_[top:bottom, left:right]
    return float(np.mean(cv2.absdiff(now.image[inside], then.image[inside])))

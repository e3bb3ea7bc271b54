"""What stands out from the background of a camera that does not move."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

Mask = npt.NDArray[np.uint8]
Edges = npt.NDArray[np.float64]

_CLEARANCE = 0.35
"""What around the target may be its shadow or its blur, of its box."""
_DIFFERENT = 20
"""Difference in the strongest channel from which on a pixel is foreground."""
_ADAPTED_EVERY = 8
"""Frames between two steps of the background by one grey level."""
_MOST_PIXELS = 16000
"""Larger windows are looked at with fewer of their pixels."""
_LEAST_WINDOW = 6


@dataclass(frozen=True, slots=True)
class Span:
    """Part of the image: first and, exclusive, last columns and rows."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def inside(self) -> tuple[slice, slice]:
        """Index of its rows and columns."""
        return slice(self.top, self.bottom), slice(self.left, self.right)


def around(frame: Frame, box: Box, share: float) -> Span:
    """Box with `share` of its sides more to every side, cut at the border of the image."""
    width, height = frame_size(frame)
    x, y = share * box.width, share * box.height
    return Span(
        max(int(box.x - x), 0),
        max(int(box.y - y), 0),
        min(int(box.x + box.width + x) + 1, width),
        min(int(box.y + box.height + y) + 1, height),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Blob:
    """Connected foreground.

    Attributes
    ----------
    edges : (4,) array
        Left, top, right and bottom, px.
    area : float
        px².
    pixels : (n, 1, 3) array
        Its colours.
    """

    edges: Edges
    area: float
    pixels: Frame

    @property
    def centre(self) -> tuple[float, float]:
        """Middle of its bounding box, px."""
        left, top, right, bottom = self.edges.tolist()
        return (left + right) / 2, (top + bottom) / 2

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of its bounding box, px."""
        left, top, right, bottom = self.edges.tolist()
        return right - left, bottom - top


def joined(blobs: list[Blob]) -> Blob:
    """Take several blobs for one."""
    edges = np.array([one.edges for one in blobs])
    return Blob(
        np.concatenate([edges[:, :2].min(axis=0), edges[:, 2:].max(axis=0)]),
        sum(one.area for one in blobs),
        np.concatenate([one.pixels for one in blobs]),
    )


class Foreground:
    """The background of a still camera, learnt away from the target.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    target : Box
        Where nothing is known yet, until the target has left.
    """

    def __init__(self, frame: Frame, target: Box) -> None:
        self._background = np.array(frame)
        self._known = np.ones(frame.shape[:2], np.bool_)
        self._unknown: Span | None = around(frame, target, _CLEARANCE)
        self._known[self._unknown.inside] = False
        self._frames = 0

    def fits(self, frame: Frame) -> bool:
        """Whether it is of frames of this size."""
        return self._background.shape == frame.shape

    def knows(self, span: Span) -> bool:
        """Whether the background of a part of the image has been seen."""
        return bool(self._known[span.inside].all())

    def learn(self, frame: Frame, target: Box) -> None:
        """Follow slow changes of the light; take over what the target has uncovered."""
        self._frames += 1
        occupied = around(frame, target, _CLEARANCE)
        self._uncover(frame, occupied)
        if self._frames % _ADAPTED_EVERY:
            return
        behind = self._background[occupied.inside].copy()
        one = np.uint8(1)
        brighter, darker = frame > self._background, frame < self._background
        self._background += brighter.view(np.uint8) * one
        self._background -= darker.view(np.uint8) * one
        self._background[occupied.inside] = behind

    def _uncover(self, frame: Frame, occupied: Span) -> None:
        if self._unknown is None:
            return
        span = self._unknown
        fresh = ~self._known[span.inside]
        top, left = max(occupied.top - span.top, 0), max(occupied.left - span.left, 0)
        bottom, right = max(occupied.bottom - span.top, 0), max(occupied.right - span.left, 0)
        fresh[top:bottom, left:right] = False
        self._background[span.inside][fresh] = frame[span.inside][fresh]
        self._known[span.inside] |= fresh
        if self.knows(self._unknown):
            self._unknown = None

    def blobs(self, frame: Frame, span: Span, least: float) -> list[Blob]:
        """Find connected foreground of at least `least` px² in a part of the image."""
        width, height = span.right - span.left, span.bottom - span.top
        if min(width, height) < _LEAST_WINDOW:
            return []
        step = max(int(math.sqrt(width * height / _MOST_PIXELS)), 1)
        rows, columns = slice(span.top, span.bottom, step), slice(span.left, span.right, step)
        seen = np.ascontiguousarray(frame[rows, columns])
        mask = self._different(seen, rows, columns)
        _, labels, found, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
        blobs = []
        for label, (x, y, wide, high, count) in enumerate(found.tolist()):
            if label and count * step**2 >= least:
                edges = np.array([x, y, x + wide, y + high], np.float64) * step
                edges += [span.left, span.top, span.left, span.top]
                own = labels[y : y + high, x : x + wide] == label
                pixels = seen[y : y + high, x : x + wide][own][:, np.newaxis]
                blobs.append(Blob(edges, float(count * step**2), pixels))
        return blobs

    def _different(self, seen: Frame, rows: slice, columns: slice) -> Mask:
        known = self._background[rows, columns]
        away = cv2.absdiff(seen, np.ascontiguousarray(known)).max(axis=2)
        mask = ((away > _DIFFERENT) & self._known[rows, columns]).astype(np.uint8)
        pair, three = np.ones((2, 2), np.uint8), np.ones((3, 3), np.uint8)
        # An even kernel is anchored at one corner and then at the other, or it moves the mask.
        mask = cv2.dilate(cv2.erode(mask, pair, anchor=(0, 0)), pair, anchor=(1, 1))
        return np.asarray(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, three), np.uint8)

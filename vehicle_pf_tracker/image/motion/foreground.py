# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Foreground of a standing camera: what differs from the median of earlier frames.

Nothing is computed before it is asked for; `kept_frames.py` has the frames.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.carried_grey import CarriedGrey
from vehicle_pf_tracker.image.motion.kept_frames import KeptFrames
from vehicle_pf_tracker.image.motion.mask_parts import connected_parts
from vehicle_pf_tracker.image.motion.median_image import median
from vehicle_pf_tracker.image.motion.side_edges import edges_beyond
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

_LOOKED_AT = 4
"""Step between kept frames that are searched for other vehicles when one is hidden: with
`kept_frames._KEPT_EVERY` half a second at 30 Hz."""
_AROUND = 1.5
"""Half side of the square that is looked at around a box, in longer sides of it, a choice: the box
may have moved by its length, and what reaches the rim has no outline."""
_WIDER = 2.0
"""Times as far around what is hidden: it may be 1.5 diagonals away, and twice as large."""
_LEAST_CONTRAST = 12.0
"""Difference in grey levels from which a pixel is foreground, at least: that of a shadow's rim."""
_NOISE_FACTOR = 4.0
"""Least difference of a foreground pixel in median differences around, each two thirds of the
noise's standard deviation, so that the factor is 2.7 of these."""
_GROWN = 1.3
"""Factor to a box inside of which an outline has mostly to lie, a choice: the estimate may be off
by a seventh of its size on each side."""
_CLOSED = np.ones((3, 3), np.uint8)
"""Neighbourhood in px of the reduced frame within which gaps are closed, the smallest."""
_LEAST_PIECE = 4
"""Area in px of the reduced frame below which a connected piece is noise: 2 x 2, a choice."""


_STANDING = CameraMotion()


class Outline(NamedTuple):
    """Bounding box of what moves.

    Attributes
    ----------
    low, high : (2,) arrays
        Left and upper, right and lower side, px.
    """

    low: Array
    high: Array

    @property
    def centre(self) -> Array:
        """Centre, px."""
        return np.asarray((self.low + self.high) / 2)

    @property
    def size(self) -> Array:
        """Width and height, px."""
        return np.asarray(self.high - self.low)


class Around(NamedTuple):
    """Mask of the moving pixels around a box.

    Attributes
    ----------
    mask : (h, w) array of uint8
        1 where something moves, by px of a reduced frame.
    corner : (2,) array
        First column and row of it in that frame.
    zoom : float
        Px of the reduced frame per px of the frame.
    """

    mask: npt.NDArray[np.uint8]
    corner: Array
    zoom: float

    def outline(self, centre: Array, size: Array) -> Outline | None:
        """Outline of what moves in a box of this centre and size, px.

        None where nothing moves, or it reaches out of the neighbourhood.
        """
        # In px of the piece; the outline goes back to px of the frame.
        inner = centre * self.zoom - self.corner
        bounds = _bounds(self.mask, inner, size * self.zoom)
        if bounds is None:
            return None
        low, high = bounds
        return Outline((low + self.corner) / self.zoom, (high + self.corner) / self.zoom)

    def beyond(self, centre: Array, size: Array) -> Array | None:
        """Distances beyond the sides of a box of this centre and size, px; see `edges_beyond`."""
        middle = centre * self.zoom - self.corner
        half = size * (self.zoom / 2)
        return edges_beyond(self.mask, middle - half, middle + half)


class Foreground:
    """Tells what moves before a standing camera."""

    def __init__(self) -> None:
        self._kept = KeptFrames()
        self._learnt: CarriedGrey | None = None
        # Of the frame in which it was learnt.
        self._lasting: npt.NDArray[np.uint8] | None = None

    def keep(
        self,
        small: SmallGrey,
        camera: CameraMotion = _STANDING,
        *,
        stands: bool,
        elapsed: float = 1.0,
    ) -> None:
        """Keep a frame, `elapsed` periods after the last one.

        Earlier ones are discarded if they are of another size, or if the camera does not stand. If
        it stands and yet sways, by `camera` (px of the whole frame), they are carried along.
        """
        self._kept.keep(small, camera, elapsed, stands=stands)
        self._lasting = None
        if not stands:
            self._learnt = None
        elif self._learnt is not None and not camera.still:
            self._learnt.carry(camera)

    @property
    def present(self) -> SmallGrey:
        """The latest frame."""
        return self._kept.present

    @property
    def stands(self) -> bool:
        """True where the camera has not moved since the frame before."""
        return self._kept.number > 1

    @property
    def is_known(self) -> bool:
        """True once the background has been seen for long enough, by a camera that stands."""
        return self._kept.are_enough

    @property
    def extent(self) -> Array:
        """Width and height of the frames, px."""
        small = self._kept.present
        return np.array(small.image.shape[::-1]) / small.zoom

    def learn_background(self) -> None:
        """Learn the whole background from the frames that are kept now."""
        background = median([each.grey.image for each in self._kept.spread])
        self._learnt = CarriedGrey(SmallGrey(background, self._kept.present.zoom))
        self._lasting = median([each.grey.image for each in self._kept.lasting])

    def history(self) -> Iterator[tuple[float, Array]]:
        """Give the ages in periods of kept frames, and the boxes of what moves in them.

        The background has to be learnt.
        """
        kept = list(self._kept.spread)[::-1]
        return ((self._kept.age(each), self._boxes(each.grey.image)) for each in kept[::_LOOKED_AT])

    def periods_since(self, age: float) -> list[float] | None:
        """Periods between the latest frames; see `KeptFrames.periods_since`."""
        return self._kept.periods_since(age)

    def boxes(self) -> Array:
        """Find all that moves now, against the background that was learnt.

        Returns
        -------
        (N, 2, 2) array
            Left and upper, right and lower side of each connected piece, px.
        """
        return self._boxes(self._kept.present.image)

    def boxes_near(self, centre: Array, size: Array) -> Array:
        """Find what moves now within three of its longer sides of a box (px), as `boxes`."""
        small = self._kept.present
        rows, columns, corner = _neighbourhood(small, centre, _WIDER * size)
        piece = small.image[rows, columns]
        if min(piece.shape) < 3:
            return np.empty((0, 2, 2))
        moving = _moving(piece, self._background.piece(rows, columns))
        return (_pieces(moving) + corner) / small.zoom

    @property
    def _background(self) -> CarriedGrey:
        """The background that was learnt."""
        assert self._learnt is not None, "learn the background first"
        return self._learnt

    def _boxes(self, image: npt.NDArray[np.uint8]) -> Array:
        return _pieces(_moving(image, self._background.image)) / self._kept.present.zoom

    def outline(self, centre: Array, size: Array, ago: int = 0) -> Outline | None:
        """Outline of what moves in a box of this centre and size, px, some frames `ago`.

        None where there is no background, nothing moves, or it reaches out of the neighbourhood.
        """
        around = self.around(centre, size, ago)
        return around and around.outline(centre, size)

    def around(self, centre: Array, size: Array, ago: int = 0) -> Around | None:
        """Find what moves around a box of this centre and size, px, some frames `ago`.

        None where there is no background, or the box is outside the image.
        """
        if not self.is_known or ago >= len(self._kept.latest):
            return None
        small = self._kept.present
        rows, columns, corner = _neighbourhood(small, centre, size)
        if min(rows.stop - rows.start, columns.stop - columns.start) < 3:
            return None
        piece = self._kept.latest[-1 - ago].grey.piece(rows, columns)
        # The whole background is known for this frame; else that of the neighbourhood is enough.
        if self._lasting is not None:
            background = self._lasting[rows, columns]
        else:
            background = median([each.grey.piece(rows, columns) for each in self._kept.lasting])
        return Around(_moving(piece, background), corner, small.zoom)


def _moving(
    image: npt.NDArray[np.uint8], background: npt.NDArray[np.uint8]
) -> npt.NDArray[np.uint8]:
    """Mask of what differs from the background."""
    change = np.asarray(cv2.absdiff(image, background), np.uint8)
    blurred = cv2.GaussianBlur(change, (3, 3), 0)
    _, moving = cv2.threshold(blurred, _level(change), 1, cv2.THRESH_BINARY)
    # A windscreen of the road's grey would cut a car in two.
    closed = cv2.morphologyEx(moving, cv2.MORPH_CLOSE, _CLOSED)
    return np.asarray(closed, np.uint8)


def _level(change: npt.NDArray[np.uint8]) -> float:
    """Difference above which a pixel is foreground."""
    # The usual case first: the median is so low that it does not count. Whole numbers are compared
    # as such, in a third of the time.
    if np.count_nonzero(change <= int(_LEAST_CONTRAST / _NOISE_FACTOR)) > change.size // 2:
        return _LEAST_CONTRAST
    # The median by a histogram, in a tenth of the time of `np.median`.
    counts = cv2.calcHist([change], [0], None, [256], [0, 256]).cumsum()
    noise = np.searchsorted(counts, [(change.size - 1) // 2, change.size // 2], side="right").mean()
    return max(_LEAST_CONTRAST, _NOISE_FACTOR * float(noise))


def _pieces(moving: npt.NDArray[np.uint8]) -> Array:
    """Left and upper, right and lower side (N, 2, 2) of each connected piece of a mask."""
    _, stats = connected_parts(moving)
    low = stats[1:, :2]
    return np.stack([low, low + stats[1:, 2:4]], axis=1).astype(float)


def _neighbourhood(small: SmallGrey, centre: Array, size: Array) -> tuple[slice, slice, Array]:
    """Rows and columns of the reduced frame around a box, and the first of them as x and y."""
    height, width = small.image.shape
    half = _AROUND * float(size.max()) * small.zoom
    x, y = (centre * small.zoom).tolist()
    columns = _within(math.floor(x - half), math.ceil(x + half), width)
    rows = _within(math.floor(y - half), math.ceil(y + half), height)
    return rows, columns, np.array([columns.start, rows.start], float)


def _within(first: float, last: float, length: int) -> slice:
    """Cut a range to an axis of `length` px; whole px."""
    # In scalars, which are quicker than arrays of two.
    return slice(int(min(max(first, 0), length)), int(min(max(last, 0), length)))


def _bounds(
    moving: npt.NDArray[np.uint8], centre: Array, size: Array
) -> tuple[Array, Array] | None:
    """Bounds of the connected pieces that lie mostly in a box; None where they touch the rim."""
    labels, stats = connected_parts(moving)
    height, width = moving.shape
    half = _GROWN * size / 2
    (left, top), (right, bottom) = (centre - half).tolist(), (centre + half).tolist()
    box = labels[_within(top, bottom, height), _within(left, right, width)]
    inside = np.bincount(box.ravel(), minlength=len(stats))
    areas = stats[:, cv2.CC_STAT_AREA]
    # Mostly inside: the outline of the car behind touches the box, and is another one's.
    own = (areas >= _LEAST_PIECE) & (inside >= 0.5 * areas)
    own[0] = False  # the background
    if not own.any():
        return None
    low = stats[own, :2].min(axis=0)
    high = (stats[own, :2] + stats[own, 2:4]).max(axis=0)
    # What reaches the rim goes on outside, where its size is not known.
    touches = min(low.tolist()) <= 0 or high[0] >= width or high[1] >= height
    return None if touches else (low.astype(float), high.astype(float))

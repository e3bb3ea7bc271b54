# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurement of the camera's motion, by the flow of corners outside the target."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.point_flow import PointFlow
from vehicle_pf_tracker.image.motion.shared_motion import (
    LEAST_CORNERS,
    STILL_SHARE,
    shared_similarity,
)
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

_LEAST_SIDE = 32
"""Side of the reduced frame in px below which its corners are too close to define a motion, a
choice: of 32 the borders leave 20."""
_GRID = (8, 6)
"""Cells along x and y that give one corner each, so that no lorry gives most of them. A choice:
they are square in an image of 4 to 3."""
_ENOUGH = 16
"""Corners followed below which others are found, a third of the grid's: fewer may all be on one
side of the image, and show no zoom."""
_BORDER = 6
"""Margin in px without corners: a flow window, or most of one."""
_LEAST_STRENGTH = 1e-4
"""Smallest eigenvalue of a corner; below it a patch of road matches its whole surroundings."""
_REFRESHED_AFTER = 5
"""Frames that corners are followed before others are found; finding costs more than following. A
choice: what has left the image is replaced within a sixth of a second at 30 Hz."""
_STANDS_AFTER = 30
"""Frames of measured stillness after which the camera is taken to be mounted, a choice: 1 s
at 30 Hz."""
_CHECKED_EVERY = 5
"""Frames between two measurements of a mounted camera, unless its corners change: a choice. In
between only the change around the corners is looked at."""
_UNCHANGED = 4.0
"""Mean change around a corner in grey levels below which it has not moved, a choice: noise, no
edge."""
_NEIGHBOURHOOD = 5
"""Side in px of the window over which changes around a corner are averaged, a choice: noise of
25 px is a fifth of that of one."""
_OFFSETS = (np.arange(_NEIGHBOURHOOD) - _NEIGHBOURHOOD // 2)[:, np.newaxis]
"""Offsets of its pixels from the corner along an axis."""
_CLEARANCE = 0.75
"""Distance of corners from the target's centre, as a share of its size: half of it, and half of
that as a margin, a choice."""
_WEAR_IN_PLACE = 1 / 3
"""Share of a frame that the corners of a mounted camera age by in a frame, a choice: they are
found anew after 15 instead of 5. So it is in a view that has too few, as in fog; of 47 real
sequences none has, by far."""
_FLOW = PointFlow(window=9, levels=3, steps=10, precision=0.03)
"""Windows of 13 px cost twice as much, and are no nearer to what 300 corners give. Ten steps to
.03 px instead of OpenCV's 30 to .01 are a choice: the motion is that of many corners."""


def fit_camera_motion(before: Array, after: Array) -> CameraMotion:
    """Fit a similarity to the motion that most corners share; none for a camera that stands.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Corners in both frames, px.
    """
    similarity = shared_similarity(before, after)
    return CameraMotion(similarity[:, :2], similarity[:, 2])


class CameraFlow:
    """Follows corners of the background from frame to frame."""

    def __init__(self) -> None:
        self._last: npt.NDArray[np.uint8] | None = None
        self._corners = np.empty((0, 2), np.float32)
        self._number_found = _ENOUGH
        self._age = 0.0
        self._still = 0
        self._motion = CameraMotion()

    def measure(self, small: SmallGrey, target: Box) -> CameraMotion:
        """Motion since the last frame shown; none for the first one.

        Parameters
        ----------
        small : SmallGrey
            The reduced frame.
        target : Box
            Target box, px of the whole frame; corners in and close to it take no part.
        """
        reduced = small.image
        zoom = small.zoom
        # 1. Keep this frame, whatever becomes of the measurement: the next is compared with it.
        last = self._last
        self._last = reduced
        # A frame of another size begins anew; in a tiny one corners say nothing.
        if last is None or last.shape != reduced.shape or min(reduced.shape) < _LEAST_SIDE:
            return CameraMotion()
        # 2. Corners of the frame before; too few say nothing, and a mounted camera is looked at
        # only.
        corners = self._background(last, target, zoom)
        if len(corners) < LEAST_CORNERS:
            # Finding none costs as much as finding some, and the next frame has as few.
            if self._number_found < LEAST_CORNERS:
                self._age += _WEAR_IN_PLACE - 1
            return CameraMotion()
        is_mounted = self._still >= _STANDS_AFTER and self._still % _CHECKED_EVERY != 0
        if is_mounted and _stand(last, reduced, corners):
            # Corners of a camera that stands do not drift: finding them anew seldom is enough.
            self._age += _WEAR_IN_PLACE - 1
            self._still += 1
            return CameraMotion()
        # 3. The search starts where the motion of the frame before would take the corners.
        guess = self._motion.apply(corners.astype(np.float64)).astype(np.float32)
        moved, found = _FLOW.follow(last, reduced, corners, guess)
        # Corners are carried on: those of the same points need no search of the grid.
        self._corners = moved.compress(found, axis=0)
        before = corners.compress(found, axis=0)
        motion = fit_camera_motion(before.astype(np.float64), self._corners.astype(np.float64))
        self._motion = motion
        if motion.still:
            self._still += 1
            return motion
        self._still = 0
        # Reduced px become px of the frame; a turn has no unit.
        return CameraMotion(motion.turn, motion.shift / zoom)

    def _background(
        self, grey: npt.NDArray[np.uint8], target: Box, zoom: float
    ) -> npt.NDArray[np.float32]:
        """Corners outside the target, found again now and then, (N, 2)."""
        self._age += 1
        # Where few were found, as on a bare road, the same few would be found in every frame.
        if self._age >= _REFRESHED_AFTER or len(self._corners) < min(_ENOUGH, self._number_found):
            self._corners = _find_corners(grey)
            self._number_found = len(self._corners)
            self._age = 0.0
        if not len(self._corners):
            return self._corners
        off = np.abs(self._corners / zoom - np.array(target.centre))
        # Of the two axes one is enough: a corner above the box is as far off as one beside it.
        outside = off[:, 0] > _CLEARANCE * target.width
        outside |= off[:, 1] > _CLEARANCE * target.height
        return self._corners.compress(outside, axis=0)


def _stand(
    last: npt.NDArray[np.uint8], present: npt.NDArray[np.uint8], corners: npt.NDArray[np.float32]
) -> bool:
    """Test whether so many corners are unchanged that flow need not be measured: the usual case."""
    height, width = present.shape
    pixels = np.rint(corners[:, np.newaxis] + _OFFSETS).astype(np.intp)
    pixels = np.minimum(np.maximum(pixels, 0), (width - 1, height - 1))
    # Numbers of the pixels, (N, 5, 5), which both images are read by at once.
    numbers = (pixels[..., 1] * width)[:, :, np.newaxis] + pixels[:, np.newaxis, :, 0]
    change = cv2.absdiff(
        *(grey.take(numbers.reshape(len(corners), -1)) for grey in (last, present))
    )
    # Sums instead of means, which numpy takes twice as long for.
    unchanged = np.count_nonzero(change.sum(axis=1) < _UNCHANGED * _NEIGHBOURHOOD**2)
    return bool(unchanged >= STILL_SHARE * len(corners))


def _find_corners(grey: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """Find the strongest corner of each cell of a grid, (N, 2)."""
    # The smaller eigenvalue: along an edge, where it is nothing, flow is not defined.
    strength = cv2.cornerMinEigenVal(grey, 3)
    rows, columns = grey.shape
    wide = (columns - 2 * _BORDER) // _GRID[0]
    high = (rows - 2 * _BORDER) // _GRID[1]
    inner = strength[_BORDER : _BORDER + high * _GRID[1], _BORDER : _BORDER + wide * _GRID[0]]
    cells = inner.reshape(_GRID[1], high, _GRID[0], wide).transpose(0, 2, 1, 3)
    flat = cells.reshape(_GRID[0] * _GRID[1], high * wide)
    best = flat.argmax(axis=1)
    cell = np.arange(_GRID[0] * _GRID[1])
    x = _BORDER + (cell % _GRID[0]) * wide + best % wide
    y = _BORDER + (cell // _GRID[0]) * high + best // wide
    # A cell of plain road gives no corner rather than a weak one, which would wander.
    strong = flat[cell, best] > _LEAST_STRENGTH
    return np.asarray(np.column_stack([x, y])[strong], np.float32)

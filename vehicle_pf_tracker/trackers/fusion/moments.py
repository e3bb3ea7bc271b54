# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images of three moments, between which the box moves by a part of its size.

The middle image is compared with both others, aligned once with the box and once with the
background. That separates what moves with the box from what stands (`entering.py`,
`moving_edges.py`).
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import SmallColour

_WAY = 0.12
"""Least displacement of the box from one moment to the next, fraction of its size: what moves and
what stands are then two cells apart. A choice."""

Cells = npt.NDArray[np.uint8]


class Moment(NamedTuple):
    """An image in which the box was followed.

    Attributes
    ----------
    image : (h, w) or (h, w, 3) array of uint8
        Luminance or colours of a resampled piece of the frame.
    zoom, corner : (2,) arrays
        Px of the piece per px of the frame, and its left and upper side in px of the frame.
    position, size : (2,) arrays
        Centre, and width and height of the box there, px.
    camera : CameraMotion
        Motion of the camera since then.
    time : float
        Time of the frame, s.
    """

    image: Cells
    zoom: Array
    corner: Array
    position: Array
    size: Array
    camera: CameraMotion = CameraMotion()
    time: float = 0.0

    @classmethod
    def of_frame(cls, small: SmallColour, position: Array, size: Array) -> Moment:
        """Keep the colours of a whole frame, reduced."""
        return cls(small.image, np.full(2, small.zoom), np.zeros(2), position, size)

    @classmethod
    def of_patch(cls, patch: Patch, position: Array, size: Array, time: float) -> Moment:
        """Keep the luminance of the surroundings of the box."""
        corner = patch.centre - patch.side / 2 / patch.zoom
        return cls(patch.grey, patch.zoom, corner, position, size, time=time)

    def cells(self, first: Array, step: Array, count: tuple[int, int]) -> Cells:
        """Levels at so many cells along x and y: the first one's centre, and steps, px."""
        # In scalars, which are quicker than arrays of two.
        (across, down), (left, top) = (step * self.zoom).tolist(), self._place(first)
        matrix = np.array([[across, 0.0, left], [0.0, down, top]])
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        cells = cv2.warpAffine(
            self.image, matrix, count, flags=flags, borderMode=cv2.BORDER_REPLICATE
        )
        return np.asarray(cells, np.uint8)

    def _place(self, position: Array) -> list[float]:
        """Column and row of a position: the centres of px are whole numbers, as for OpenCV."""
        place: list[float] = ((position - self.corner) * self.zoom - 0.5).tolist()
        return place

    def background_in(self, other: Moment, position: Array) -> Array:
        """Return the place in another image of the background that is at a position here, px."""
        if self.camera.still and other.camera.still:
            return position
        back = np.linalg.inv(other.camera.turn)
        shift = back @ (self.camera.shift - other.camera.shift)
        return CameraMotion(back @ self.camera.turn, shift).apply(position)


Moments = tuple[Moment, ...]
"""The last ones, oldest first."""


def moved(moments: Moments, camera: CameraMotion) -> Moments:
    """Note that the camera has moved."""
    if camera.still:
        return moments
    return tuple(each._replace(camera=camera.after(each.camera)) for each in moments)


def is_due(moments: Moments, position: Array, size: Array) -> bool:
    """Test whether a box of this centre and size, px, has come far from the last moment."""
    if not moments:
        return True
    last = moments[-1]
    way = np.abs(position - last.camera.apply(last.position)) / size
    return bool(way.max() >= _WAY)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes in continuous pixel coordinates.

Pixel `i` covers the interval [i, i + 1), so that the centre of a box is ``x + width / 2`` and the
centre of the first pixel is 0.5. Every position in this package is given in these coordinates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError

Position: TypeAlias = tuple[float, float]
"""Coordinates (x, y) in px."""

LARGEST_SHARE = 4
"""Largest side of a target, in sides of the image. A vehicle close to the camera extends beyond the
image; a box of more than four images is a mistake in its units or its order of numbers."""
LARGEST_COORDINATE_PX = 1e5
"""Bound of coordinates that a user gives, px: three times the largest side of an image (32767)."""


@dataclass(frozen=True, slots=True)
class Box:
    """An upright rectangle: top-left corner, width and height, in px."""

    x: float
    y: float
    width: float
    height: float

    @classmethod
    def around(cls, centre: Position, width: float, height: float) -> Box:
        """Make the box of this size whose centre is `centre` (px)."""
        return cls(centre[0] - width / 2, centre[1] - height / 2, width, height)

    @property
    def centre(self) -> Position:
        """Centre (x, y) in px."""
        return self.x + self.width / 2, self.y + self.height / 2

    @property
    def diagonal(self) -> float:
        """Length of the diagonal in px."""
        return math.hypot(self.width, self.height)

    @property
    def area(self) -> float:
        """Area in px²."""
        return self.width * self.height

    @property
    def corners(self) -> tuple[Position, ...]:
        """The four corners, clockwise in the image from the top left."""
        right = self.x + self.width
        bottom = self.y + self.height
        return (self.x, self.y), (right, self.y), (right, bottom), (self.x, bottom)

    def iou(self, other: Box) -> float:
        """Return the intersection over the union with another box, 0 to 1."""
        width = min(self.x + self.width, other.x + other.width) - max(self.x, other.x)
        height = min(self.y + self.height, other.y + other.height) - max(self.y, other.y)
        shared = max(width, 0.0) * max(height, 0.0)
        union = self.area + other.area - shared
        return shared / union if union > 0 else 0.0

    def __str__(self) -> str:
        return f"{self.x:g},{self.y:g},{self.width:g},{self.height:g}"


def intersections(edges: Array, others: Array) -> Array:
    """Measure the common areas in px² of boxes (..., 4): left, top, right and bottom edges."""
    width = np.minimum(edges[..., 2], others[..., 2]) - np.maximum(edges[..., 0], others[..., 0])
    height = np.minimum(edges[..., 3], others[..., 3]) - np.maximum(edges[..., 1], others[..., 1])
    return np.asarray(np.maximum(width, 0.0) * np.maximum(height, 0.0))


def check_target(box: Box, width: int, height: int) -> Box:
    """Return `box` if a tracker can start on it in an image of `width` x `height` px.

    Raises
    ------
    InputError
        If a number is not finite, the box has no area or is far larger than the image, or its
        centre is outside the image.
    """
    values = (box.x, box.y, box.width, box.height)
    if not all(map(math.isfinite, values)):
        raise InputError(f"the target {box} has a number that is not finite; give x,y,w,h in px")
    if box.width < 1 or box.height < 1:
        raise InputError(f"the target {box} is smaller than one pixel; give x,y,w,h in px")
    if box.width > LARGEST_SHARE * width or box.height > LARGEST_SHARE * height:
        raise InputError(
            f"the target {box} is far larger than the image of {width}x{height} px; "
            "give the top-left corner and the size of the vehicle in this image"
        )
    cx, cy = box.centre
    if not (0 <= cx <= width and 0 <= cy <= height):
        raise InputError(
            f"the target {box} has its centre outside the image of {width}x{height} px; "
            "give the top-left corner and the size of the vehicle in this image"
        )
    return box

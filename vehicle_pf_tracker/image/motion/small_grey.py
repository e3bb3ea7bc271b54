# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Reduced frame, in whose grey levels the motion of a background is measured."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size

_LARGEST_SIDE = 320
"""Side in px that a frame is reduced to: the motion of its background is measured to a fraction of
a pixel, so that a quarter of VGA's pixels suffice."""
_SPARSE_FROM = 3
"""Reduction from which rows are left out; of every two both are averaged."""


@dataclass(frozen=True, slots=True, eq=False)
class SmallGrey:
    """A reduced frame.

    Attributes
    ----------
    image : (h, w) array of uint8
        Luminance.
    zoom : float
        Px of the reduced frame per px of the frame, at most 1.
    """

    image: npt.NDArray[np.uint8]
    zoom: float


@dataclass(frozen=True, slots=True, eq=False)
class SmallColour:
    """A reduced frame in colour.

    Attributes
    ----------
    image : (h, w, 3) array of uint8
        RGB.
    zoom : float
        Px of the reduced frame per px of the frame, at most 1.
    """

    image: npt.NDArray[np.uint8]
    zoom: float


def small_grey(frame: Frame) -> SmallGrey:
    """Reduce a frame (H, W, 3) until its larger side has 320 px at most, to its luminance."""
    small = small_colour(frame)
    grey = cv2.cvtColor(small.image, cv2.COLOR_RGB2GRAY)
    return SmallGrey(np.asarray(grey, np.uint8), small.zoom)


def small_colour(frame: Frame) -> SmallColour:
    """Reduce a frame (H, W, 3) until its larger side has 320 px at most.

    Of a large frame only so many rows are read as the reduced one has: the cost lies in fetching
    them from memory, and would grow with the frame.
    """
    width, height = frame_size(frame)
    # Never enlarged: interpolated pixels add cost and no motion.
    zoom = min(_LARGEST_SIDE / max(width, height), 1.0)
    # Rounded down, so that there are at least as many rows as the result needs.
    step = int(1 / zoom)
    # The middle row of each step, so that the picture does not shift.
    small = np.ascontiguousarray(frame) if step < _SPARSE_FROM else frame[step // 2 :: step]
    if zoom < 1:
        size = max(round(width * zoom), 1), max(round(height * zoom), 1)
        small = np.asarray(cv2.resize(small, size, interpolation=cv2.INTER_LINEAR), np.uint8)
    return SmallColour(small, zoom)

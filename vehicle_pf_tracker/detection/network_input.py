# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images fitted into the input of a network, and boxes mapped back."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size

PADDING_GREY = 114
"""Grey of the borders, which YOLOX and YOLOv8 were trained with."""


@dataclass(frozen=True, slots=True)
class Fit:
    """Place of an image in the input of a network.

    Attributes
    ----------
    scale : (float, float)
        Pixels of the input per pixel of the image, across and down.
    offset : (float, float)
        Upper left corner of the image in the input, px.
    """

    scale: tuple[float, float]
    offset: tuple[float, float]

    def to_image(self, boxes: Array) -> Array:
        """Map boxes (N, 4: left, top, width, height) in px of the input to px of the image."""
        scale = np.array([*self.scale, *self.scale])
        # Offsets move corners, not sizes.
        mapped: Array = (boxes - np.array([*self.offset, 0.0, 0.0])) / scale
        return mapped


def letterboxed(frame: Frame, width: int, height: int, *, centred: bool) -> tuple[Frame, Fit]:
    """Fit an image into `width` x `height` px with its proportions, grey around it.

    Parameters
    ----------
    frame : Frame
        The image.
    width, height : int
        Size of the input in px.
    centred : bool
        Put it in the middle; else in the upper left corner.
    """
    across, down = frame_size(frame)
    # The smaller ratio, so that both sides fit; at least one px of either.
    ratio = min(width / across, height / down)
    small, fit = stretched(frame, max(1, round(across * ratio)), max(1, round(down * ratio)))
    size = frame_size(small)
    left, top = ((width - size[0]) // 2, (height - size[1]) // 2) if centred else (0, 0)
    picture: Frame = np.full((height, width, 3), PADDING_GREY, np.uint8)
    picture[top : top + size[1], left : left + size[0]] = small
    # The scale as it was rounded, not the ratio: boxes map back exactly.
    return picture, Fit(fit.scale, (float(left), float(top)))


def stretched(frame: Frame, width: int, height: int) -> tuple[Frame, Fit]:
    """Resize an image to `width` x `height` px, whatever its proportions."""
    across, down = frame_size(frame)
    resized = cv2.resize(frame, (width, height), interpolation=cv2.INTER_LINEAR)
    return np.asarray(resized, np.uint8), Fit((width / across, height / down), (0.0, 0.0))

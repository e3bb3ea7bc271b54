# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of a mask that hang together."""

from __future__ import annotations

from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Mask: TypeAlias = npt.NDArray[np.uint8]
"""Mask of an image, (H, W): not 0 where a pixel belongs to what is looked for."""
Labels: TypeAlias = npt.NDArray[np.uint16] | npt.NDArray[np.int32]
Stats: TypeAlias = npt.NDArray[np.int32]

_MOST_SMALL = 1 << 16
"""Labels that 16 bits have. Of 2 x 2 px no two are in different parts, so that a mask has at most a
quarter as many parts as px, rounded up along each side."""


def connected_parts(mask: Mask) -> tuple[Labels, Stats]:
    """Find the parts of a mask; px that touch, also by a corner, are of one.

    Returns
    -------
    labels : (H, W) array
        Number of each pixel's part, from 1; 0 outside of all.
    stats : (N + 1, 5) array
        Left, top, width, height and area of each part by its number, px; row 0 is what is outside.
    """
    height, width = mask.shape
    # OpenCV has the same result with labels of 16 bits as with 32, in a third of the time.
    most = ((height + 1) // 2) * ((width + 1) // 2)
    kind = cv2.CV_16U if most < _MOST_SMALL - 1 else cv2.CV_32S
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask, ltype=kind)
    return labels, stats  # type: ignore[return-value]  # of these types by `kind`


def joined_parts(mask: Mask, gap: int, least: float) -> Array:
    """Find boxes (N, 2, 2), low and high corner in px, of parts with less than `gap` px between.

    Those with fewer than `least` px are left out.
    """
    joined = cv2.dilate(mask, np.ones((gap, gap), np.uint8))
    labels, stats = connected_parts(np.asarray(joined, np.uint8))
    own = np.where(mask > 0, labels, 0)
    counts = np.bincount(own.ravel(), minlength=len(stats))
    boxes = []
    for part in np.flatnonzero(counts[1:] >= max(least, 1)) + 1:
        left, top, width, height = stats[part, :4].tolist()
        inside = np.asarray(own[top : top + height, left : left + width] == part, np.uint8)
        x, y, across, down = cv2.boundingRect(inside)
        boxes.append([[left + x, top + y], [left + x + across, top + y + down]])
    return np.array(boxes, float).reshape(-1, 2, 2)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies of vehicles among what has changed: what lies near, or within, edges of its own.

The light of a lamp on the road has no edges, and a place that a vehicle has left shows the road's.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.detection.illumination import Pixels, Values

Mask = npt.NDArray[np.uint8]

_CLOSED = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (5, 5))
"""Holes and gaps up to this size are closed: windscreens show the sky."""
LEAST_EDGE = 10.0
"""Least strength of an edge, levels per px, of what is small: 10 at the outline of a car a fifth
darker than the road. The light of a lamp adds 2 to 4 per px."""
SHARP_SIZE = 30.0
"""Size in px up to which edges are sharp. Larger vehicles are nearer, faster, and blurred: their
edges are as much weaker."""
REACH = 0.08
"""Distance from an edge, of the size, up to which what has changed belongs to it."""
_LEAST_REACH = 2
"""The same in px, for small ones: the blur of a lens."""
_LEAST_AREA = 4
"""Area in px below which what moves is no part of a vehicle."""


def moving_pixels(changed: Pixels) -> Mask:
    """Take specks out of what has changed, and close gaps: 1 where something moves, else 0."""
    return _without_gaps(np.asarray(cv2.medianBlur(changed.astype(np.uint8), 3), np.uint8))


def bodies(moving: Mask, edges: Values) -> Mask:
    """Keep of what moves what is near edges or enclosed: 1 there, else 0.

    Parameters
    ----------
    moving : (H, W) array
        1 where the image differs from the background, else 0.
    edges : (H, W) array
        Strength of the edges that the image has and the background has not, levels per px.
    """
    border = np.ones(moving.shape, np.bool_)
    border[1:-1, 1:-1] = False
    kept = np.zeros_like(moving)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(moving)
    for index in range(1, count):
        x, y, width, height, area = stats[index].tolist()
        if area < _LEAST_AREA:
            continue
        window = slice(y, y + height), slice(x, x + width)
        part = labels[window] == index
        kept[window] |= _near_edges(part, edges[window], border[window]).view(np.uint8)
    kept = _without_gaps(kept)
    # The inside of a roof is far from its edges.
    outlines, _ = cv2.findContours(kept, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(kept, outlines, -1, 1, cv2.FILLED)
    return kept


def _near_edges(part: Pixels, edges: Values, border: Pixels) -> Pixels:
    """Keep the pixels of one blob that are near its edges."""
    size = math.sqrt(part.size)
    sharp = part & (edges > LEAST_EDGE * min(1.0, SHARP_SIZE / size))
    if not sharp.any():
        return sharp
    sharp |= part & border  # which cuts an outline open, and would leave the inside out
    side = 2 * max(_LEAST_REACH, round(size * REACH)) + 1
    near = cv2.dilate(sharp.astype(np.uint8), np.ones((side, side), np.uint8)) > 0
    return np.asarray(part & near)


def _without_gaps(mask: Mask) -> Mask:
    return np.asarray(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, _CLOSED), np.uint8)

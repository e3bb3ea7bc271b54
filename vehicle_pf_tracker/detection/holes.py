# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Holes that vehicles leave in the background when they drive off.

A vehicle that stood in the first images, or for long, is background; what it uncovers differs from
it, and looks like a vehicle that stands. Its outline decides: a vehicle has an edge there in the
image, a hole in the background.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.motion.mask_parts import connected_parts

Levels: TypeAlias = npt.NDArray[np.float32] | npt.NDArray[np.uint8]
Mask: TypeAlias = npt.NDArray[np.uint8]
Section: TypeAlias = tuple[slice, slice]
"""Rows and columns of an image."""

_RIM = np.ones((3, 3), np.uint8)
"""Surroundings of an outline's pixel, px: masks are exact within one or two."""
_BACKGROUNDS = 0.6
"""Share of the edges that are the background's alone above which it is a hole. On CDnet's
*highway*, before a background of one image, of 246 blobs of vehicles 1 % have .39 or more, of 171
holes 1 % have .65 or less."""
_LEAST_AREA = 20
"""Least area of a hole, px: a smaller outline has as many edges by noise."""


def standing_parts(
    changed: Mask, exposure: npt.NDArray[np.float32], least: float
) -> Iterator[tuple[Section, Mask]]:
    """Find parts of a change that have been there for `least` images: sections, and their pixels.

    Those that the border cuts are left out, as half an outline decides nothing.

    Parameters
    ----------
    changed : (H, W) array
        Not 0 where the image has changed.
    exposure : (H, W) array
        Number of images for which each pixel has been changed.
    least : float
        Least mean of these over a part.
    """
    labels, stats = connected_parts(changed)
    height, width = changed.shape
    for index in range(1, len(stats)):
        x, y, across, down, area = stats[index].tolist()
        is_free = x > 0 and y > 0 and x + across < width and y + down < height
        if area < _LEAST_AREA or not is_free:
            continue
        # With its surroundings, in which are edges of the outline.
        rows = slice(max(y - 2, 0), min(y + down + 2, height))
        section = (rows, slice(max(x - 2, 0), min(x + across + 2, width)))
        part = (labels[section] == index).view(np.uint8)
        if cv2.mean(exposure[section], part)[0] >= least:
            yield section, part


def is_hole(image: Levels, background: Levels, part: Mask) -> bool:
    """Test whether a part that has changed is where a vehicle was, and not where one is.

    Parameters
    ----------
    image, background : (H, W) arrays
        Brightness of a section of the image, and of the background there.
    part : (H, W) array
        1 where it has changed.
    """
    outline = cv2.dilate(part, _RIM) != cv2.erode(part, _RIM)
    more = (_slopes(background) - _slopes(image))[outline]
    total = float(np.abs(more).sum())
    return float(np.maximum(more, 0).sum()) > _BACKGROUNDS * total


def _slopes(levels: Levels) -> npt.NDArray[np.float32]:
    across = cv2.Sobel(levels, cv2.CV_32F, 1, 0)
    down = cv2.Sobel(levels, cv2.CV_32F, 0, 1)
    return np.asarray(cv2.magnitude(across, down), np.float32)

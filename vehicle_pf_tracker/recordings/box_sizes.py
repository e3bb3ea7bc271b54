# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes that do not fit their images: shares, another image size, corners for sizes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array

MOST_BEYOND = 0.5
"""Fraction of the boxes that reach beyond the image above which a notice is given: of vehicles that
drive out of it, a few boxes do."""
_REACH_PX = 1.0
"""Reach beyond the image that is none, px: boxes drawn along its edge are rounded outwards."""


@dataclass(frozen=True, slots=True)
class Misfit:
    """Reason why boxes do not fit their images.

    Attributes
    ----------
    sentence : str
        The reason, without a name of the file.
    is_fatal : bool
        True where no box can be used.
    """

    sentence: str
    is_fatal: bool


def misfit(boxes: Array, size: tuple[int, int], most_beyond: float = MOST_BEYOND) -> Misfit | None:
    """Return why boxes do not fit images of a size; None where they do.

    Parameters
    ----------
    boxes : (N, 4) array
        Left, top, width and height, px; at least one.
    size : (int, int)
        Width and height of the images, px.
    most_beyond : float
        Fraction of the boxes that may reach beyond the image.
    """
    count = len(boxes)
    if not count:
        return None
    image = f"the image of {size[0]}x{size[1]} px"
    # Fatal reasons first; px are above 1 somewhere, whatever the vehicle.
    if (np.abs(boxes) <= 1).all():
        return Misfit(
            f"all {count} boxes are below one px; are they shares of the image? they must be in px",
            True,
        )
    # Corners in place of sizes also reach beyond: what is called width is then the right edge.
    ends = boxes[:, :2] + boxes[:, 2:]
    # One box inside is enough to be of this image: vehicles drive out of it, and their boxes too.
    if not ((boxes[:, :2] < size) & (ends > 0)).all(axis=1).any():
        return Misfit(f"no box lies in {image}; are they of another image size?", True)
    beyond = int((ends > np.add(size, _REACH_PX)).any(axis=1).sum())
    if beyond > most_beyond * count:
        return Misfit(
            f"{beyond} of {count} boxes reach beyond {image}; a box is left, top, width, height in "
            "px of this image, not two corners",
            False,
        )
    return None

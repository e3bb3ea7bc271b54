# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubts about a target that its pixels raise before it is followed."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

SMALLEST_SIDE = 6.0
"""Side in px below which a box has too few pixels to be told apart: on truck4_1, of 5 px, no
tracker of docs/sequences.md is on target in more than an eighth of the frames."""
LARGEST_SHARE = 0.4
"""Share of the image above which a box leaves too little around it to be told apart from: a
choice, a little less than half."""
LEAST_CONTRAST = 6.0
"""Contrast, of 255, below which a patch is an empty road. True boxes have at least 9.4 on
truck4_1, of 5 px, and 12.6 on the 18 other sequences; of boxes thrown into the lower part of their
images, which is mostly road, up to 47 % have less (`laboratory/target_contrast.py`)."""
_MARGIN = 0.25
"""Surroundings that belong to the patch, as a share of the box, a choice: a plain vehicle
has its outline."""


def doubts(frame: Frame, box: Box) -> list[str]:
    """Return what speaks against following `box`, a clause each.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB image.
    box : Box
        Target in px, at least partly inside.
    """
    width, height = frame_size(frame)
    # All of them, not the first: the user may choose another box once.
    objections = []
    if min(box.width, box.height) < SMALLEST_SIDE:
        objections.append(f"it is only {box.width:g} x {box.height:g} px large")
    if box.area > LARGEST_SHARE * width * height:
        objections.append(f"it covers {box.area / (width * height):.0%} of the image")
    if contrast(frame, box) < LEAST_CONTRAST:
        objections.append("nothing in it stands out, as on an empty road")
    return objections


def contrast(frame: Frame, box: Box) -> float:
    """Return the largest standard deviation of a colour in the box with a margin.

    Infinite where the box has no pixel in the image.
    """
    across = _MARGIN * box.width
    down = _MARGIN * box.height
    # Cut at the border: what lies outside has no pixels, and no contrast.
    left = max(int(box.x - across), 0)
    top = max(int(box.y - down), 0)
    right, bottom = np.ceil([box.x + box.width + across, box.y + box.height + down]).astype(int)
    patch = np.ascontiguousarray(frame[top : max(bottom, top), left : max(right, left)])
    # Smoothed, since noise is no structure; by 1.5 px, a choice: the smallest box keeps its sides.
    smooth = cv2.GaussianBlur(patch, (0, 0), 1.5) if patch.size else None
    return math.inf if smooth is None else float(smooth.std(axis=(0, 1)).max())

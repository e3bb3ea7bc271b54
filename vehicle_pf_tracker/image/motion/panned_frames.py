# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Moving pixels before a camera that moves: those that no frame of the last second explains.

They are carried along with the background. Where a vehicle has driven off, none of them shows what
the present frame shows, while road is shown by most of them: no background has to be learnt.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.carried_grey import CarriedGrey
from vehicle_pf_tracker.image.motion.foreground import changed_mask
from vehicle_pf_tracker.image.motion.mask_parts import Mask, joined_parts
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

_SPACING = 1 / 6
"""Time between two frames that are kept, s, and least age of one that is compared with: within less
a vehicle hardly leaves its place. A choice."""
_NUMBER = 6
"""Frames compared with, so that they reach back a second: the vehicles of 13 of
15 moving cameras take .3 to 1.4 s to drive out of their own box, a median each."""
_FEWEST_COMPARED = 3
"""Frames below which nothing is told, a choice: of fewer, one that is off explains too little."""
_LARGEST_SHARE = 0.08
"""Share of the image that moves above which the background's motion was not measured well. So are
at most .07 of the frames of nine moving cameras, .1 to .3 of five, and all of one that blurs."""
_NEIGHBOURHOOD = np.ones((3, 3), np.uint8)
"""Px of an earlier frame between whose extremes a pixel is explained: the background's motion is
good to less than one, a choice."""


class _Kept(NamedTuple):
    """An earlier frame, and when it was shown, s."""

    grey: CarriedGrey
    time: float


class PannedFrames:
    """The frames of the last second, carried along with the camera.

    Attributes
    ----------
    camera : CameraMotion
        The camera's last motion, px of the whole frame.
    """

    def __init__(self) -> None:
        self.camera = CameraMotion()
        self._kept: deque[_Kept] = deque(maxlen=_NUMBER + 1)
        self._present: SmallGrey | None = None
        self._time = 0.0

    def keep(self, small: SmallGrey, camera: CameraMotion, seconds: float) -> None:
        """Take the present frame, some `seconds` after the last; `camera` is in px of the frame."""
        if self._present is not None and self._present.image.shape != small.image.shape:
            self._kept.clear()
        self._present = small
        self.camera = camera
        self._time += seconds
        if not camera.still:
            for each in self._kept:
                each.grey.carry(camera)
        # A thousandth: sums of periods are not exact.
        if not self._kept or self._time - self._kept[-1].time > _SPACING - 1e-3:
            self._kept.append(_Kept(CarriedGrey(small), self._time))

    def boxes(self, joined: float, least: float) -> Array:
        """Find what moves now.

        Parameters
        ----------
        joined : float
            Distance up to which parts are of one thing, px of the frame.
        least : float
            Least area of what moves in a box, px squared.

        Returns
        -------
        (N, 2, 2) array
            Low and high corner of each box, px; none where nothing is told.
        """
        mask = self._moving()
        if self._present is None or mask is None or mask.mean() > _LARGEST_SHARE:
            return np.empty((0, 2, 2))
        zoom = self._present.zoom
        return joined_parts(mask, max(round(joined * zoom), 1), least * zoom**2) / zoom

    def _moving(self) -> Mask | None:
        """Mask of what no earlier frame shows; None where there are too few of them."""
        old = [each.grey for each in self._kept if self._time - each.time > _SPACING - 1e-3]
        if self._present is None or len(old) < _FEWEST_COMPARED:
            return None
        image = self._present.image
        least = np.full_like(image, 255)
        known = np.zeros_like(image)
        for grey in old:
            seen = grey.seen
            # What one frame does not show another one may.
            change = np.where(seen, _change(image, grey.image), np.uint8(255))
            least = np.minimum(least, change)
            known |= seen
        return changed_mask(np.asarray(least * known, np.uint8)) & known


def _change(image: npt.NDArray[np.uint8], before: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Distance of each pixel from the range of an earlier frame around it, grey levels."""
    above = cv2.subtract(image, cv2.dilate(before, _NEIGHBOURHOOD))
    below = cv2.subtract(cv2.erode(before, _NEIGHBOURHOOD), image)
    return np.asarray(cv2.max(above, below), np.uint8)

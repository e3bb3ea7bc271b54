# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A reduced frame that is carried along with a camera that sways.

Only how the background has moved since is kept up; pixels are moved where they are asked for, and
once, however often the camera has moved: each time would blur them.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey


class CarriedGrey:
    """A reduced frame of before, seen as the camera looks now.

    Attributes
    ----------
    small : SmallGrey
        The frame as it was.
    """

    __slots__ = ("_factor", "_shift", "small")

    def __init__(self, small: SmallGrey) -> None:
        self.small = small
        # A similarity as complex numbers: kept for dozens of frames, it is followed in scalars.
        self._factor = 1 + 0j
        self._shift = 0j

    def carry(self, camera: CameraMotion) -> None:
        """Let the camera move; its shift is in px of the whole frame."""
        turn = complex(*camera.turn[:, 0].tolist())
        self._factor *= turn
        self._shift = turn * self._shift + self.small.zoom * complex(*camera.shift.tolist())

    @property
    def image(self) -> npt.NDArray[np.uint8]:
        """The frame, (h, w), where the background is now; its rim is repeated."""
        height, width = self.small.image.shape
        return self.piece(slice(0, height), slice(0, width))

    def piece(self, rows: slice, columns: slice) -> npt.NDArray[np.uint8]:
        """Return some rows and columns, which are inside the frame, of `image`."""
        if self._factor == 1 and self._shift == 0:
            return self.small.image[rows, columns]
        along, across = self._factor.real, self._factor.imag
        x, y = self._shift.real - columns.start, self._shift.imag - rows.start
        moved = cv2.warpAffine(
            self.small.image,
            np.array([[along, -across, x], [across, along, y]]),
            (columns.stop - columns.start, rows.stop - rows.start),
            borderMode=cv2.BORDER_REPLICATE,
        )
        return np.asarray(moved, np.uint8)

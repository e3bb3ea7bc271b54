# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Flow of points from image to image: Lucas and Kanade's on a pyramid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.windows.window import Grey

Points: TypeAlias = npt.NDArray[np.float32]
"""x, y in px as OpenCV counts them, the middle of the first pixel being 0, shape (N, 2)."""
PointMask: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class PointFlow:
    """Search for points in another image.

    Attributes
    ----------
    window : int
        Side in px of the square around a point that is compared.
    levels : int
        Levels of the pyramid above the image itself; each doubles the motion that is found.
    steps : int
        Most iterations on a level; the default is OpenCV's.
    precision : float
        Step in px below which the iteration ends; the default is OpenCV's.
    """

    window: int
    levels: int
    steps: int = 30
    precision: float = 0.01

    def follow(
        self, before: Grey, after: Grey, points: Points, guess: Points | None = None
    ) -> tuple[Points, PointMask]:
        """Find the points of `before` in `after`, starting from a guess (N, 2) if there is one.

        Returns
        -------
        moved : (N, 2) array
            Positions in `after`.
        found : (N,) array
            True for the points that were found.
        """
        # The layout that OpenCV wants: (N, 1, 2) of float32.
        start = np.ascontiguousarray(points, np.float32).reshape(-1, 1, 2)
        first = None if guess is None else np.array(guess, np.float32).reshape(-1, 1, 2)
        moved, found, _ = cv2.calcOpticalFlowPyrLK(
            before,
            after,
            start,
            first,  # type: ignore[arg-type]  # None is allowed
            winSize=(self.window, self.window),
            maxLevel=self.levels,
            criteria=(cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, self.steps, self.precision),
            # OpenCV takes the fourth argument as a guess only with this flag.
            flags=0 if guess is None else cv2.OPTFLOW_USE_INITIAL_FLOW,
        )
        return np.asarray(moved, np.float32).reshape(-1, 2), np.asarray(found).ravel() > 0

    def follow_and_return(
        self, before: Grey, after: Grey, points: Points, guess: Points | None = None
    ) -> tuple[Points, PointMask, Points]:
        """Find points as `follow`, then follow them back (Kalal et al. 2010).

        Returns
        -------
        moved, found
            Positions and mask as from `follow`, of points that were found both ways.
        error : (N, 2) array
            Offset of the end of the way back from where it should be.
        """
        # A point that does not come back to its place has been lost on one of the two ways.
        moved, found = self.follow(before, after, points, guess)
        # Back from where they are to where they came from: the way out says where to look.
        back = None if guess is None else points
        again, returned = self.follow(after, before, moved, back)
        return moved, found & returned, again - points

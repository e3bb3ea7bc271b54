"""Where windows lie in a frame, for the numba kernels."""

from __future__ import annotations

from typing import NamedTuple

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.glcm import Cooccurrence
from vehicle_pf_tracker.image.kernels.interface import PixelRange
from vehicle_pf_tracker.image.kernels.numba_cells import Rectangles
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Pixels,
    Reach,
    window_pixels,
    window_rectangles,
)
from vehicle_pf_tracker.image.window import Positions, Window
from vehicle_pf_tracker.image.window_feature import WindowFeature


class Place(NamedTuple):
    """Where windows lie in a frame.

    Attributes
    ----------
    pixels : (N, 2) array
        Centre x, y of each window.
    extent : (int, int, int, int)
        Least x and y, largest x and y of them.
    reach : (int, int, int)
        Pixels of a window left of its centre, right of it counting itself, and above it.
    size : (int, int)
        Width and height of the frame.
    """

    pixels: Pixels
    extent: tuple[int, int, int, int]
    reach: Reach
    size: tuple[int, int]

    @classmethod
    def of(
        cls, feature: WindowFeature, frame: Frame, positions: Positions, window: Window
    ) -> Place:
        """Find the windows around positions."""
        size = frame_size(frame)
        pixels, extent = window_pixels(positions, *size)
        return cls(pixels, extent, reach_of(feature, window), size)

    def covered(self, margin: int = 0) -> PixelRange:
        """Smallest part of the frame that has all windows in it, and a margin as far as it goes."""
        (x0, y0, x1, y1), (left, _, up) = self.extent, self.reach
        width, height = self.size
        return PixelRange(
            max(x0 - left - margin, 0),
            max(y0 - up - margin, 0),
            min(x1 + left + 1 + margin, width),
            min(y1 + up + 1 + margin, height),
        )

    def rectangles(self, origin: tuple[int, int]) -> Rectangles:
        """Left, top, right, bottom of each window as seen from `origin`, shape (N, 4)."""
        return window_rectangles(self.pixels, self.reach, origin, self.size)


def reach_of(feature: WindowFeature, window: Window) -> Reach:
    """Reach of a feature's windows; pairs of pixels end one column earlier."""
    right = window.half_width + (0 if type(feature) is Cooccurrence else 1)
    return window.half_width, right, window.half_height

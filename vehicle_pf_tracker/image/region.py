"""The part of a frame around a target, resampled so that the target has a canonical size.

What is measured there costs the same however large the target is in the frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size

Grey = npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """A resampled piece of a frame.

    Attributes
    ----------
    image : (h, w, 3) array
        RGB, at the canonical size.
    grey : (h, w) array
        Its luminance.
    origin : (float, float)
        Top-left corner in px of the frame.
    zoom : (float, float)
        Canonical px per px of the frame, along x and y.
    """

    image: Frame
    grey: Grey
    origin: tuple[float, float]
    zoom: tuple[float, float]

    def to_canonical(self, positions: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Positions (..., 2) in px of the frame as continuous px of the region."""
        return np.asarray((positions - np.array(self.origin)) * np.array(self.zoom))

    def to_frame(self, positions: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Positions (..., 2) in continuous px of the region as px of the frame."""
        return np.asarray(positions / np.array(self.zoom) + np.array(self.origin))


def cut_region(
    frame: Frame, centre: tuple[float, float], size: tuple[float, float], zoom: float
) -> Region:
    """Resample what lies around `centre`.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    centre : (float, float)
        In px of the frame.
    size : (float, float)
        Width and height of the piece in px of the frame. Beyond the border of the frame its
        outermost pixels are repeated.
    zoom : float
        Canonical px per px of the frame; met to within the rounding of the piece's size.
    """
    left, top = math.floor(centre[0] - size[0] / 2), math.floor(centre[1] - size[1] / 2)
    right, bottom = math.ceil(centre[0] + size[0] / 2), math.ceil(centre[1] + size[1] / 2)
    piece = _padded(frame, left, top, right, bottom)
    width = max(round((right - left) * zoom), 1)
    height = max(round((bottom - top) * zoom), 1)
    kind = cv2.INTER_AREA if zoom < 1 else cv2.INTER_LINEAR
    image = np.asarray(cv2.resize(piece, (width, height), interpolation=kind), np.uint8)
    grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), np.uint8)
    exact = width / (right - left), height / (bottom - top)
    return Region(image, grey, (float(left), float(top)), exact)


def _padded(frame: Frame, left: int, top: int, right: int, bottom: int) -> Frame:
    width, height = frame_size(frame)
    # At least one row and one column of the frame, to have something to repeat.
    x0, y0 = min(max(left, 0), width - 1), min(max(top, 0), height - 1)
    x1, y1 = max(min(right, width), x0 + 1), max(min(bottom, height), y0 + 1)
    piece = np.ascontiguousarray(frame[y0:y1, x0:x1])
    beyond = max(y0 - top, 0), max(bottom - y1, 0), max(x0 - left, 0), max(right - x1, 0)
    if any(beyond):
        piece = np.asarray(cv2.copyMakeBorder(piece, *beyond, cv2.BORDER_REPLICATE), np.uint8)
    return piece[: bottom - top, : right - left]

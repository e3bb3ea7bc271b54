"""How much each pixel's colour speaks for the target and against what is around it.

Histograms of the target and of its surroundings give each colour a share
``target / (target + background)``: colours that the surroundings have too count for little. Grey
video, where colours tell nothing, is told by finer steps of luminance.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.template import Map

Bins = npt.NDArray[np.uint16]
Histogram = npt.NDArray[np.float64]

_COLOUR_SHIFT = 4
_GREY_SHIFT = 2
_COLOURS = (256 >> _COLOUR_SHIFT) ** 3
_GREYS = 256 >> _GREY_SHIFT
_GREY_BELOW = 0.5
"""Mean difference of the channels in grey levels below which a picture counts as grey."""
_UNSEEN = 2.5e-8
"""Keeps the share of colours that were never seen at a half."""


def is_grey(image: Frame) -> bool:
    """Whether the three channels of a picture are the same but for coding noise."""
    channels = image.astype(np.int16)
    differences = np.abs(channels[..., ::2] - channels[..., 1:2])
    return bool(differences.mean() < _GREY_BELOW)


def colour_bins(image: Frame, *, grey: bool) -> Bins:
    """Bin of every pixel: 16 x 16 x 16 of RGB, or 64 of luminance.

    Parameters
    ----------
    image : (H, W, 3) array
        RGB.
    grey : bool
        What `is_grey` said of the video.

    Returns
    -------
    (H, W) array
        Below `bin_count(grey=grey)`.
    """
    if grey:
        return np.asarray(image[..., 0] >> _GREY_SHIFT, np.uint16)
    levels = (image >> _COLOUR_SHIFT).astype(np.uint16)
    return np.asarray((levels[..., 0] << 8) | (levels[..., 1] << 4) | levels[..., 2], np.uint16)


def bin_count(*, grey: bool) -> int:
    """Give the number of bins of `colour_bins`."""
    return _GREYS if grey else _COLOURS


def histogram(bins: Bins, count: int) -> Histogram:
    """Normalised histogram of the bins given, (count,); zero where there are none."""
    counts = np.bincount(bins.ravel(), minlength=count).astype(np.float64)
    return np.asarray(counts / max(counts.sum(), 1.0))


def shares(target: Histogram, background: Histogram) -> npt.NDArray[np.float32]:
    """Share of each bin, 0 to 1; a half where neither has been seen."""
    return ((target + _UNSEEN) / (target + background + 2 * _UNSEEN)).astype(np.float32)


def mean_share_map(share: Map, size: tuple[int, int]) -> Map:
    """Mean share in the window of `size` (w, h), both odd, around every pixel, (H, W)."""
    found = cv2.boxFilter(share, cv2.CV_32F, size, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(found, np.float32)

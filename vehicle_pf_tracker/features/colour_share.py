"""How much each pixel's colour speaks for the target and against its surroundings.

Histograms of the target and of the background around it give each colour a share
``target / (target + background)``: colours that the surroundings have too count for little. Grey
video fills the luminance bins alone, which are fine enough to tell by.
"""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.template import Map

Bins = npt.NDArray[np.intp]
Histogram = npt.NDArray[np.float64]

_LUMINANCE_BITS = 4
_CHROMA_STEP = 10
_CHROMA_BINS = 8
BINS = (1 << _LUMINANCE_BITS) * _CHROMA_BINS**2

_LUMINANCE = (np.arange(256) >> (8 - _LUMINANCE_BITS)) * _CHROMA_BINS**2
_CHROMA = np.clip(
    (np.arange(256) - 128 + _CHROMA_STEP * _CHROMA_BINS // 2) // _CHROMA_STEP, 0, _CHROMA_BINS - 1
)


def colour_bins(image: Frame) -> Bins:
    """Bin of every pixel: 16 of luminance by 8 x 8 of chroma, which is narrow around grey."""
    planes = cv2.cvtColor(image, cv2.COLOR_RGB2YCrCb)
    luminance, red, blue = planes[..., 0], planes[..., 1], planes[..., 2]
    return np.asarray(_LUMINANCE[luminance] + _CHROMA[red] * _CHROMA_BINS + _CHROMA[blue], np.intp)


def histogram(bins: Bins) -> Histogram:
    """Normalised histogram of the bins given; uniform where there are none."""
    counts = np.bincount(bins.ravel(), minlength=BINS).astype(np.float64)
    total = counts.sum()
    return counts / total if total > 0 else np.full(BINS, 1.0 / BINS)


def shares(target: Histogram, background: Histogram) -> npt.NDArray[np.float32]:
    """Share of each bin, 0 to 1; a half where neither has been seen."""
    little = 1e-3
    return ((target + little) / (target + background + 2 * little)).astype(np.float32)


def contrast_map(share: Map, size: tuple[int, int], ring: int) -> Map:
    """Mean share in every window minus that in the ring around it.

    Parameters
    ----------
    share : (H, W) array
        Of each pixel.
    size : (int, int)
        Width and height of the windows.
    ring : int
        Width of the ring in px.

    Returns
    -------
    (H - h + 1, W - w + 1) array
        From -1 to 1, laid out as `template.correlate`.
    """
    width, height = size
    rows, columns = share.shape
    padded = cv2.copyMakeBorder(share, ring, ring, ring, ring, cv2.BORDER_REFLECT)
    sums = cv2.integral(padded, sdepth=cv2.CV_64F)

    def box(left: int, top: int, wide: int, high: int) -> npt.NDArray[np.float64]:
        down, along = rows - height + 1, columns - width + 1
        y0, y1, x0, x1 = top, top + high, left, left + wide
        return np.asarray(
            sums[y1 : y1 + down, x1 : x1 + along]
            - sums[y0 : y0 + down, x1 : x1 + along]
            - sums[y1 : y1 + down, x0 : x0 + along]
            + sums[y0 : y0 + down, x0 : x0 + along]
        )

    inside = box(ring, ring, width, height)
    outside = box(0, 0, width + 2 * ring, height + 2 * ring) - inside
    area = width * height
    around = (width + 2 * ring) * (height + 2 * ring) - area
    return (inside / area - outside / max(around, 1)).astype(np.float32)

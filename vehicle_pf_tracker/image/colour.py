"""Joint RGB histograms (P1, section III-C).

P1 requantises each channel to 3 bits, which gives 512 bins.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Bounds, Window, bounds

Histogram = npt.NDArray[np.float64]
BinIndices = npt.NDArray[np.uint16]


def bin_count(bits: int) -> int:
    """Count the bins of a joint histogram with `bits` bits a channel (1 to 5)."""
    return 1 << (3 * bits)


def bin_indices(pixels: Frame, bits: int) -> BinIndices:
    """Joint bin of every pixel: red in the highest bits, blue in the lowest.

    Parameters
    ----------
    pixels : (H, W, 3) array
        RGB.
    bits : int
        Bits kept of each channel, 1 to 5.

    Returns
    -------
    (H, W) array of uint16
        From 0 to ``bin_count(bits) - 1``.
    """
    levels = (pixels >> np.uint8(8 - bits)).astype(np.uint16)
    return np.asarray(
        (levels[..., 0] << np.uint16(2 * bits))
        | (levels[..., 1] << np.uint16(bits))
        | levels[..., 2]
    )


def joint_histogram(
    frame: Frame, position: tuple[float, float], window: Window, bits: int
) -> Histogram:
    """Normalised joint histogram of one window: P1's ``hist(S)``.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    position : (float, float)
        Centre of the window in px; kept inside the image.
    window : Window
        Size of the window.
    bits : int
        Bits a channel.

    Returns
    -------
    (bin_count(bits),) array
        Sums to one.
    """
    rectangle = bounds(frame, np.asarray(position, dtype=np.float64), window)
    counts = np.bincount(
        bin_indices(crop(frame, rectangle), bits).ravel(), minlength=bin_count(bits)
    )
    return np.asarray(counts / counts.sum())


def crop(frame: Frame, rectangle: Bounds) -> Frame:
    """View of the pixels of `frame` in one rectangle."""
    left, top, right, bottom = (int(side) for side in rectangle)
    return frame[top:bottom, left:right]

"""Mean shift of many windows at once (Comaniciu, Ramesh and Meer 2003).

Histograms are weighted with the Epanechnikov profile, so that pixels near the edge of the ellipse
count little and the similarity changes smoothly with position. The kernel sits on the pixel that a
position lies in; the step from there is real-valued. Equations are numbered as in the paper.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.colour import Histogram, bin_count, bin_indices
from vehicle_pf_tracker.features.colour_kernel import Coefficients
from vehicle_pf_tracker.features.frame import Frame, frame_size
from vehicle_pf_tracker.features.window import Centres, Positions, Window, centres

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Kernel:
    """Pixels of the ellipse in a window: offsets (P, 2) in px, Epanechnikov profile (P,)."""

    offsets: Indices
    profile: Array


@functools.lru_cache(maxsize=8)
def epanechnikov(window: Window) -> Kernel:
    """Make the kernel whose ellipse touches the sides of `window` (eq. 12, without its norm)."""
    y, x = np.mgrid[
        -window.half_height : window.half_height + 1, -window.half_width : window.half_width + 1
    ]
    radius = np.square(x / (window.half_width + 0.5)) + np.square(y / (window.half_height + 0.5))
    inside = radius < 1
    return Kernel(np.column_stack([x[inside], y[inside]]), 1.0 - radius[inside])


def kernel_histogram(
    frame: Frame, position: tuple[float, float], window: Window, bits: int
) -> Histogram:
    """Kernel-weighted joint RGB histogram of one window (eq. 3).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    position : (float, float)
        Centre in px; kept inside the image.
    window : Window
        Box around the kernel's ellipse; over the border the pixels that exist count.
    bits : int
        Bits a channel.

    Returns
    -------
    (bin_count(bits),) array
        Sums to one.
    """
    kernel, bins = epanechnikov(window), bin_count(bits)
    pixel = _pixels(frame, np.asarray([position]))
    columns = _columns(frame, pixel, window, np.arange(bins), bits)
    return np.asarray(_masses(columns, kernel, bins)[0])


def mean_shift(
    frame: Frame, positions: Positions, window: Window, reference: Histogram, bits: int
) -> tuple[Positions, Coefficients]:
    """Move every position one mean-shift step towards the reference's colours (eq. 25 and 26).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    positions : (N, 2) array
        Kernel centres in px; kept inside the image.
    window : Window
        Box around the kernel's ellipse.
    reference : (bin_count(bits),) array
        Kernel-weighted histogram of the target.
    bits : int
        Bits a channel.

    Returns
    -------
    shifted : (N, 2) array
        Mean of the ellipse's pixels, each weighted by ``sqrt(q / p)`` of its colour; the position
        itself where the ellipse has no colour of the reference.
    coefficients : (N,) array
        Bhattacharyya coefficients at `positions`, before the step.
    """
    kernel, active = epanechnikov(window), np.flatnonzero(reference)
    pixel = _pixels(frame, positions)
    columns = _columns(frame, pixel, window, active, bits)
    masses, wanted = _masses(columns, kernel, len(active)), reference[active]
    coefficients = np.minimum(np.sqrt(masses * wanted).sum(axis=1), 1.0)
    weights = _pixel_weights(masses, wanted, columns)
    total = weights.sum(axis=1)
    moved = total > 0
    step = (weights @ kernel.offsets)[moved] / total[moved, np.newaxis]
    shifted = np.array(positions, dtype=np.float64)
    shifted[moved] = pixel[moved] + 0.5 + step
    return shifted, coefficients


def _pixels(frame: Frame, positions: Positions) -> Centres:
    width, height = frame_size(frame)
    return np.asarray(np.clip(centres(positions), 0, [width - 1, height - 1]))


def _columns(frame: Frame, pixel: Centres, window: Window, active: Indices, bits: int) -> Indices:
    """Column of each kernel pixel's bin in the table of masses, shape (N, P).

    Active bins come first, then one column for all other colours, and one for no pixel at all.
    """
    table = np.full(bin_count(bits), len(active))
    table[active] = np.arange(len(active))
    reach = np.array([window.half_width, window.half_height])
    first, end = pixel.min(axis=0) - reach, pixel.max(axis=0) + reach + 1
    low, high = np.maximum(first, 0), np.minimum(end, frame_size(frame))
    region = np.full((end - first)[::-1], len(active) + 1)
    (left, top), (right, bottom) = low - first, high - first
    covered = frame[low[1] : high[1], low[0] : high[0]]
    region[top:bottom, left:right] = table[bin_indices(covered, bits)]
    stride = np.array([1, region.shape[1]])
    starts = (pixel - first) @ stride
    places = starts[:, np.newaxis] + epanechnikov(window).offsets @ stride
    return np.asarray(region.ravel()[places])


def _masses(columns: Indices, kernel: Kernel, bins: int) -> Array:
    """Normalised kernel mass of each active bin, shape (N, bins)."""
    count, width = len(columns), bins + 2
    rows = columns + width * np.arange(count)[:, np.newaxis]
    profile = np.broadcast_to(kernel.profile, columns.shape)
    masses = np.bincount(rows.ravel(), profile.ravel(), minlength=count * width)
    masses = masses.reshape(count, width)
    # The centre pixel always exists, so the sum without the last column is never zero.
    return np.asarray(masses[:, :bins] / masses[:, :-1].sum(axis=1, keepdims=True))


def _pixel_weights(masses: Array, wanted: Histogram, columns: Indices) -> Array:
    """``sqrt(q / p)`` of each kernel pixel's colour (eq. 25), shape (N, P)."""
    table = np.zeros((len(masses), masses.shape[1] + 2))
    np.divide(wanted, masses, out=table[:, :-2], where=masses > 0)
    return np.take_along_axis(np.sqrt(table), columns, axis=1)

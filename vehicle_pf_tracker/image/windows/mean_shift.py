# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mean shift of many windows at once (Comaniciu, Ramesh and Meer 2003).

Histograms are weighted with the Epanechnikov profile, so that pixels near the edge of the ellipse
count little and the similarity changes smoothly with position. The kernel sits on the pixel that a
position lies in; the step from there is real-valued. Equations are numbered as in the paper.
"""

from __future__ import annotations

import functools

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.windows.colour import bin_count, bin_indices
from vehicle_pf_tracker.image.windows.similarity import (
    Histogram,
    Reference,
    bhattacharyya_coefficient,
)
from vehicle_pf_tracker.image.windows.window import (
    Centres,
    Coefficients,
    Positions,
    Window,
    centres,
)

Indices = npt.NDArray[np.intp]


@functools.lru_cache(maxsize=8)
def epanechnikov(window: Window) -> tuple[Array, Array]:
    """Make the kernel whose ellipse touches the sides of `window` (eq. 12, without its norm).

    Returns
    -------
    offsets, profile : (P, 2) array, (P,) array
        Offsets of the ellipse's pixels from the centre, px, and the profile there.
    """
    y, x = np.mgrid[
        -window.half_height : window.half_height + 1, -window.half_width : window.half_width + 1
    ]
    # Half a pixel more than the half sides: the ellipse touches the outer sides of the pixels.
    radius = np.square(x / (window.half_width + 0.5)) + np.square(y / (window.half_height + 0.5))
    inside = radius < 1
    return np.column_stack([x[inside], y[inside]]) * 1.0, 1.0 - radius[inside]


def kernel_histogram(
    frame: Frame, position: tuple[float, float], window: Window, bits: int
) -> Histogram:
    """Kernel-weighted joint RGB histogram of one window (eq. 3).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    position : (float, float)
        Centre of the window in px; kept inside the image.
    window : Window
        Box around the kernel's ellipse.
    bits : int
        Bits a channel.

    Returns
    -------
    (bin_count(bits),) array
        Sums to one.
    """
    bins = bin_count(bits)
    # All bins are active in a reference that is being taken.
    pixel = _pixels(frame, np.asarray([position]))
    cells = _cells(frame, pixel, window, np.arange(bins), bits)
    return np.asarray(_masses(cells, epanechnikov(window)[1], bins)[0])


def kernel_similarity(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> Coefficients:
    """Bhattacharyya coefficient of each kernel-weighted histogram with `reference` (eq. 17).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    positions : (N, 2) array
        Kernel centres in px; kept inside the image.
    window : Window
        Box around the kernel's ellipse.
    reference : Reference
        Kernel-weighted histogram of the target.
    bits : int
        Bits a channel.

    Returns
    -------
    (N,) array
        From 0 to 1.
    """
    cells = _cells(frame, _pixels(frame, positions), window, reference.active, bits)
    masses = _masses(cells, epanechnikov(window)[1], len(reference.active))
    return bhattacharyya_coefficient(masses, reference.values)


def mean_shift(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> Positions:
    """Move every position one mean-shift step towards the reference's colours (eq. 25 and 26).

    Parameters
    ----------
    frame, positions, window, reference, bits
        As for `kernel_similarity`.

    Returns
    -------
    (N, 2) array
        Mean of the ellipse's pixels, each weighted by ``sqrt(q / p)`` of its colour; the position
        itself where the ellipse has no colour of the reference.
    """
    offsets, profile = epanechnikov(window)
    pixel = _pixels(frame, positions)
    cells = _cells(frame, pixel, window, reference.active, bits)
    masses = _masses(cells, profile, len(reference.active))
    # Two more columns for other colours and pixels outside, of weight zero: no test per pixel.
    table = np.zeros((len(masses), masses.shape[1] + 2))
    np.divide(reference.values, masses, out=table[:, :-2], where=masses > 0)
    weights = np.sqrt(table).ravel().take(cells)  # sqrt(q / p) of eq. 25, (N, P)
    total = weights.sum(axis=1)
    moved = total > 0
    step = (weights @ offsets)[moved] / total[moved, np.newaxis]
    # A window without a colour of the target stays: it has no mean to go to.
    shifted = np.array(positions, dtype=np.float64)
    shifted[moved] = pixel[moved] + 0.5 + step
    return shifted


def _pixels(frame: Frame, positions: Positions) -> Centres:
    width, height = frame_size(frame)
    return np.asarray(np.clip(centres(positions), 0, [width - 1, height - 1]))


def _cells(frame: Frame, pixel: Centres, window: Window, active: Indices, bits: int) -> Indices:
    """Cell of each kernel pixel in the flat table of masses, shape (N, P).

    The table has a row for each window. In a row the active bins come first, then one cell for all
    other colours, and one for pixels outside the image.
    """
    # Colours that the reference has not are one cell: they count in the norm only.
    table = np.full(bin_count(bits), len(active))
    table[active] = np.arange(len(active))
    reach = np.array([window.half_width, window.half_height])
    first = pixel.min(axis=0) - reach
    end = pixel.max(axis=0) + reach + 1
    # Kernels may reach out of the frame: there the region has the cell of no pixel.
    low = np.maximum(first, 0)
    high = np.minimum(end, frame_size(frame))
    region = np.full((end - first)[::-1], len(active) + 1)
    left, top = low - first
    right, bottom = high - first
    covered = frame[low[1] : high[1], low[0] : high[0]]
    region[top:bottom, left:right] = table[bin_indices(covered, bits)]
    stride = np.array([1, region.shape[1]])
    # All kernels are read by one `take` of flat indices, as one offset fits every window.
    reads = (epanechnikov(window)[0] @ stride).astype(np.intp)
    columns = region.ravel().take(((pixel - first) @ stride)[:, np.newaxis] + reads)
    return np.asarray(columns + (len(active) + 2) * np.arange(len(pixel))[:, np.newaxis])


def _masses(cells: Indices, profile: Array, bins: int) -> Array:
    """Normalised kernel mass of each active bin, shape (N, bins)."""
    count = len(cells)
    width = bins + 2
    each = np.broadcast_to(profile, cells.shape)
    masses = np.bincount(cells.ravel(), each.ravel(), minlength=count * width)
    masses = masses.reshape(count, width)
    # The centre pixel always exists, so the sum without the last column is never zero.
    return np.asarray(masses[:, :bins] / masses[:, :-1].sum(axis=1, keepdims=True))

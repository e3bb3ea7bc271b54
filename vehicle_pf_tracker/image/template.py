"""Normalised cross-correlation of a grey template, whole and its halves."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

Map = npt.NDArray[np.float32]
Patch = npt.NDArray[np.float32]

LEAST_DEVIATION = 1.5
"""Standard deviation in grey levels below which a window has no structure to correlate."""


def correlate(image: Map, template: Patch, structured: npt.NDArray[np.bool_]) -> Map:
    """Correlate `template` with every window of `image`.

    Parameters
    ----------
    image : (H, W) array of float32
        Grey levels.
    template : (h, w) array of float32
        Not larger than the image.
    structured : (H - h + 1, W - w + 1) array of bool
        What `have_structure` says of these windows.

    Returns
    -------
    (H - h + 1, W - w + 1) array of float32
        Coefficients from -1 to 1, 0 where window or template has no structure. Entry (r, c)
        belongs to the window whose top-left pixel is (r, c).
    """
    if float(cv2.meanStdDev(template)[1][0, 0]) < LEAST_DEVIATION:
        return np.zeros(structured.shape, np.float32)
    found = cv2.matchTemplate(image, template, cv2.TM_CCOEFF_NORMED)
    # Where there is next to no variance OpenCV divides rounding by rounding.
    return np.asarray(np.where(structured, found, np.float32(0)), np.float32)


def have_structure(image: Map, size: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Tell which windows of `size` (w, h) vary by `LEAST_DEVIATION`, laid out as `correlate`."""
    mean = _window_means(image, size)
    variance = _window_means(image * image, size) - mean * mean
    return np.asarray(variance >= LEAST_DEVIATION**2)


def _window_means(image: Map, size: tuple[int, int]) -> Map:
    width, height = size
    means = cv2.boxFilter(image, cv2.CV_32F, size, anchor=(0, 0), borderType=cv2.BORDER_REFLECT)
    rows, columns = image.shape
    return np.asarray(means[: rows - height + 1, : columns - width + 1], np.float32)


def halves(shape: tuple[int, ...]) -> tuple[tuple[slice, slice], ...]:
    """Index the left, right, upper and lower half of an array of `shape` (h, w)."""
    height, width = shape
    wide, high = max(width // 2, 1), max(height // 2, 1)
    every = slice(None)
    return (
        (every, slice(0, wide)),
        (every, slice(width - wide, width)),
        (slice(0, high), every),
        (slice(height - high, height), every),
    )


def best_coefficient(image: npt.NDArray[np.uint8], template: Patch) -> float:
    """Largest coefficient of `template` in `image`, at least 0; 0 where it does not fit in."""
    height, width = template.shape
    if image.shape[0] < height or image.shape[1] < width:
        return 0.0
    grey = image.astype(np.float32)
    found = correlate(grey, template, have_structure(grey, (width, height)))
    return max(float(found.max()), 0.0)

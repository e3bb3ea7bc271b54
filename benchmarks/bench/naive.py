# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarities one particle after the other, as the papers' words are most plainly programmed."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.similarity import Histogram
from vehicle_pf_tracker.image.windows.window import Positions, Window

_EDGE_SHARE = 0.3
"""Least strength of an edge that counts, of the strongest: that of `GradientDirections`."""


class ThreeHistograms(NamedTuple):
    """Colour (63 bins), edge directions (64) and grey pairs (64), each with sum 1."""

    colour: Histogram
    edges: Histogram
    texture: Histogram


def joint_histogram(frame: Frame, x: float, y: float, window: Window) -> Histogram:
    """Normalised 8x8x8 histogram of the window at (x, y): crop, then `cv2.calcHist`."""
    crop = _crop(frame, x, y, window)
    counts = cv2.calcHist([crop], [0, 1, 2], None, [8, 8, 8], [0, 256, 0, 256, 0, 256])
    return np.asarray(counts.ravel() / (crop.shape[0] * crop.shape[1]))


def joint_similarity(
    frame: Frame, positions: Positions, window: Window, reference: Histogram
) -> Array:
    """Bhattacharyya coefficient of each window with `reference`, shape (N,)."""
    return np.array(
        [_coefficient(joint_histogram(frame, x, y, window), reference) for x, y in positions]
    )


def three_histograms(frame: Frame, x: float, y: float, window: Window) -> ThreeHistograms:
    """Measure the three features of P2 in the window at (x, y), each from its own crop."""
    crop = _crop(frame, x, y, window)
    colour = np.concatenate(
        [cv2.calcHist([crop], [channel], None, [21], [0, 256]).ravel() for channel in range(3)]
    )
    # A pixel more on each side, for the gradients at the window's border.
    around = cv2.cvtColor(_crop(frame, x, y, window, margin=1), cv2.COLOR_RGB2GRAY)
    grey = around[1:-1, 1:-1]
    # Eight levels, and pairs of neighbours along the rows: 64 bins.
    levels = grey // 32
    texture = np.bincount((8 * levels[:, :-1] + levels[:, 1:]).ravel(), minlength=64)
    return ThreeHistograms(colour / colour.sum(), _edge_directions(around), texture / texture.sum())


def three_similarities(
    frame: Frame, positions: Positions, window: Window, references: ThreeHistograms
) -> Array:
    """Bhattacharyya coefficient of each window with each reference, shape (3, N)."""
    found = [three_histograms(frame, x, y, window) for x, y in positions]
    return np.array(
        [
            [_coefficient(histograms[kind], reference) for histograms in found]
            for kind, reference in enumerate(references)
        ]
    )


def _edge_directions(around: np.ndarray) -> Histogram:
    gx = cv2.Sobel(around, cv2.CV_32F, 1, 0)[1:-1, 1:-1]
    gy = cv2.Sobel(around, cv2.CV_32F, 0, 1)[1:-1, 1:-1]
    square = gx * gx + gy * gy
    # Squares are compared, without a root of each; flat windows have no edges.
    chosen = (square >= np.float32(_EDGE_SHARE) ** 2 * square.max()) & (square > 0)
    turns = np.arctan2(gy[chosen], gx[chosen]) / (2 * np.pi) + 0.5
    # A direction of just one turn is that of 0.
    counts = np.bincount((turns * 64).astype(np.intp) % 64, minlength=64)
    return np.asarray(counts / max(counts.sum(), 1))


def _crop(frame: Frame, x: float, y: float, window: Window, margin: int = 0) -> Frame:
    # The pixel whose area has the position in it: centres are at halves.
    column = round(x - 0.5)
    row = round(y - 0.5)
    half_width = window.half_width + margin
    half_height = window.half_height + margin
    return frame[
        row - half_height : row + half_height + 1, column - half_width : column + half_width + 1
    ]


def _coefficient(histogram: Histogram, reference: Histogram) -> float:
    return float(np.sqrt(histogram * reference).sum())

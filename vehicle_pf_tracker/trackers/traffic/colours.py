# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of boxes: histograms from an image that is quantised once for all vehicles."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.overlaps import NO_BOXES
from vehicle_pf_tracker.image.kernels.interface import Kernels, load_kernels

BACKGROUND_RIM = 0.1
"""Margin on each side, of the size, that is left out as background: two standard deviations of an
edge at the usual `detections.edge_noise` of .05."""


@functools.cache
def _kernels() -> Kernels:
    # All count the same numbers, so that nobody has to choose.
    return load_kernels("auto")


def load_counting() -> None:
    """Load what counts colours at the start: compiling it takes seconds, once on a machine."""
    ColourBins(np.zeros((1, 1, 3), np.uint8)).histograms(NO_BOXES, [])


class ColourBins:
    """Joint colour bins of a frame, which are counted where they are asked for."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame

    def histograms(self, edges: Array, covers: Sequence[Array]) -> Array:
        """Count the colours of the inner parts of boxes.

        Parameters
        ----------
        edges : (N, 4) array
            Edges of the boxes, px.
        covers : sequence of N (K, 4) arrays
            Edges of boxes whose pixels are left out of each.

        Returns
        -------
        (N, COLOUR_BINS) array
            Shares of the colours; zero where nothing of a box is in sight.
        """
        margins = BACKGROUND_RIM * (edges[:, 2:] - edges[:, :2])
        low = (edges[:, :2] + margins).astype(np.int64)
        high = (edges[:, 2:] - margins).astype(np.int64) + 1
        above = np.concatenate([NO_BOXES, *filter(len, covers)]).astype(np.int64)
        ends = np.cumsum([len(each) for each in covers], dtype=np.int64)
        boxes = np.concatenate([low, high], axis=1)
        counts = _kernels().count_colours(self._frame, boxes, above, ends).astype(np.float32)
        # At least one, so that what is out of sight stays zero, the mark of the unknown.
        totals = np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
        return np.asarray(counts / totals, np.float64)


def similarities(some: Array, others: Array) -> Array:
    """Bhattacharyya coefficients (...) of histograms (..., COLOUR_BINS), 0 to 1."""
    return np.asarray(np.sqrt(some * others).sum(axis=-1))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells of a patch: histograms of gradients, and mean colours."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation.gradient_cells import (
    GRADIENT_CELL_PX,
    GRADIENT_CHANNELS,
    CellFeatures,
    Grey,
)
from vehicle_pf_tracker.image.kernels.interface import Kernels

COLOURS = 3
"""Channels of colour of a cell: its mean L, a and b (Lab)."""
_HUE_GAIN = 4.0
"""Weight of Lab's a and b. Paint spans some 20 of their 100 units: unweighted, a grey car answers
to the filter of a beige one of the same shape (scenes `bus` and `braking`, seeds 100 to 104)."""
_COLOUR_GAINS = np.array([1, _HUE_GAIN, _HUE_GAIN], np.float32) / 100
"""Factors of L, a and b, which span 100 units."""
_MIDDLE_COLOUR = np.array([0.5, 0, 0], np.float32)
"""Subtracted from L, a and b then: middle grey is 0, as what a patch fades to at its rim."""


def cells_of(kernels: Kernels, image: Frame, grey: Grey, images: int = 1) -> Sequence[CellFeatures]:
    """Describe the cells of images of equal height that lie one below the other.

    Parameters
    ----------
    kernels : Kernels
        Implementation that measures gradients.
    image : (h, w, 3) array of uint8
        RGB.
    grey : (h, w) array of uint8
        Its luminance.
    images : int
        Number of the images.

    Returns
    -------
    sequence of (channels, rows, columns) arrays
        Channels of gradients, and then of colour, of each image.
    """
    height, width = grey.shape
    cells = width // GRADIENT_CELL_PX, height // GRADIENT_CELL_PX
    # Means of whole cells, so that colours lie on the same grid as gradients. Only images of floats
    # from 0 to 1 become Lab without rounding.
    small = cv2.resize(image, cells, interpolation=cv2.INTER_AREA)
    lab = cv2.cvtColor(small * np.float32(1 / 255), cv2.COLOR_RGB2Lab)
    # Lightness is 0 to 100, a and b about as much to either side: all within about one. Row by row:
    # by pixels, most of the loops would be of three steps.
    gains, middles = _colour_rows(cells[0])
    colours = lab.reshape(-1, len(gains)) * gains
    colours -= middles
    channels = colours.reshape(images, -1, *lab.shape[1:]).transpose(0, 3, 1, 2)
    described = []
    for part, own in zip(grey.reshape(images, -1, width), channels, strict=True):
        features = kernels.gradient_cells(part, COLOURS)
        features[GRADIENT_CHANNELS:] = own
        described.append(features)
    return described


@functools.cache
def _colour_rows(cells: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Factors of a row of colours, and what is subtracted then, (3 * cells,)."""
    return np.tile(_COLOUR_GAINS, cells), np.tile(_MIDDLE_COLOUR, cells)

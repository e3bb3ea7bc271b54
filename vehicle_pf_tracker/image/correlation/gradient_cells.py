# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Histograms of oriented gradients over cells of 4 px: 31 channels that do not depend on light.

Felzenszwalb et al., "Object detection with discriminatively trained part-based models" (2010):
18 signed and 9 unsigned directions, each normalised by the energy of its four neighbourhoods and
truncated, and four channels of texture energy. Computed on 8-bit luminance, for which direction and
magnitude of a gradient come from tables.
"""

from __future__ import annotations

from functools import cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Grey: TypeAlias = npt.NDArray[np.uint8]
CellFeatures: TypeAlias = npt.NDArray[np.float32]
"""Feature channels of cells, shape (channels, rows, columns)."""

GRADIENT_CELL_PX = 4
"""Side of a cell in px; the smallest of the paper's, since a target has only some 10 cells."""
DIRECTIONS = 18
"""Signed directions; the paper's number."""
GRADIENT_CHANNELS = DIRECTIONS + DIRECTIONS // 2 + 4
"""Channels of a cell: signed directions, unsigned ones, and texture energy by neighbourhood."""

TRUNCATION = 0.2
"""Largest normalised magnitude (the paper's value): one strong edge must not silence the others."""
TEXTURE_GAIN = 0.2357
"""Weight of the texture channels (the paper's value, 1 / sqrt(18))."""
NOISE_ENERGY = 16.0
"""Energy added to each normaliser, grey levels squared: flat cells give zero instead of a ratio of
zeros. It does not silence noise: a block of noise with a deviation of one level has 500."""

_STEPS = np.arange(-255, 256)
"""Differences of two grey levels."""


@cache
def direction_of() -> npt.NDArray[np.uint8]:
    """Return the direction by [dy + 255, dx + 255]; made once, by those who need it."""
    turns = np.arctan2(_STEPS[:, np.newaxis], _STEPS) / (2 * np.pi)
    directions = (np.rint(turns * DIRECTIONS).astype(int) % DIRECTIONS).astype(np.uint8)
    directions.flags.writeable = False
    return directions


@cache
def _magnitude_of() -> npt.NDArray[np.float32]:
    """Return the magnitude in grey levels by [dy + 255, dx + 255]."""
    return np.hypot(_STEPS[:, np.newaxis], _STEPS).astype(np.float32)


def gradient_cells(grey: Grey, spare: int = 0) -> CellFeatures:
    """Compute the 31 channels of every whole cell of an image.

    Parameters
    ----------
    grey : (4 r, 4 c) array of uint8
        Luminance.
    spare : int
        Channels that are added for the caller to fill.

    Returns
    -------
    (31 + spare, r, c) array of float32
        Non-negative, at most about 0.4; the spare ones are not set.
    """
    cells = normalised_cells(_direction_histograms(grey))
    return np.concatenate([cells, np.zeros((spare, *cells.shape[1:]), np.float32)])


def _direction_histograms(grey: Grey) -> npt.NDArray[np.float32]:
    """Sum magnitudes by cell and direction, shared bilinearly between cells, (r, c, 18)."""
    rows = grey.shape[0] // GRADIENT_CELL_PX
    columns = grey.shape[1] // GRADIENT_CELL_PX
    wide = grey.astype(np.intp)
    dx = (wide[1:-1, 2:] - wide[1:-1, :-2] + 255).ravel()
    dy = (wide[2:, 1:-1] - wide[:-2, 1:-1] + 255).ravel()
    # An 8-bit gradient has 511 x 511 values: two look-ups replace a root and an arctangent.
    at = dy * 511 + dx
    # The nearest direction alone; between cells, where positions are finer, shares are bilinear.
    direction = direction_of().ravel()[at]
    magnitude = _magnitude_of().ravel()[at]
    first_y, share_y = _cell_shares(grey.shape[0])
    first_x, share_x = _cell_shares(grey.shape[1])
    # One cell more on each side takes what falls beyond the border.
    length = (rows + 2) * (columns + 2) * DIRECTIONS
    total = np.zeros(length)
    for down in (0, 1):
        for right in (0, 1):
            cell = ((first_y + down) * (columns + 2))[:, np.newaxis] + first_x + right
            share = np.abs(1 - down - share_y)[:, np.newaxis] * np.abs(1 - right - share_x)
            places = cell.ravel() * DIRECTIONS + direction
            total += np.bincount(places, share.ravel() * magnitude, length)
    cells = total.reshape(rows + 2, columns + 2, DIRECTIONS)[1:-1, 1:-1]
    return np.ascontiguousarray(cells, np.float32)


def _cell_shares(length: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.float64]]:
    """First of the two cells that each inner pixel belongs to, and its share of the second."""
    place = (np.arange(1, length - 1) + 0.5) / GRADIENT_CELL_PX + 0.5
    first = np.floor(place).astype(np.intp)
    return first, place - first


def normalised_cells(histograms: npt.NDArray[np.float32]) -> CellFeatures:
    """Normalise direction histograms (r, c, 18) by their four neighbourhoods, (31, r, c)."""
    half = DIRECTIONS // 2
    # A car before a bright and a dark road has the same edges with opposite signs.
    unsigned = histograms[..., :half] + histograms[..., half:]
    # Beyond the border the outermost cell is repeated: zeros would brighten border cells.
    energy = np.pad((unsigned**2).sum(axis=2), 1, mode="edge")
    blocks = energy[:-1, :-1] + energy[:-1, 1:] + energy[1:, :-1] + energy[1:, 1:]
    scale = 1 / np.sqrt(blocks + np.float32(NOISE_ENERGY))
    rows, columns = histograms.shape[:2]
    features = np.zeros((GRADIENT_CHANNELS, rows, columns), np.float32)
    signed = histograms.transpose(2, 0, 1)
    plain = unsigned.transpose(2, 0, 1)
    limit = np.float32(TRUNCATION)
    for corner, (y, x) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
        own = scale[y : y + rows, x : x + columns]
        cut = np.minimum(signed * own, limit)
        features[:DIRECTIONS] += cut
        features[DIRECTIONS : DIRECTIONS + half] += np.minimum(plain * own, limit)
        features[DIRECTIONS + half + corner] = np.float32(TEXTURE_GAIN) * cut.sum(axis=0)
    # Of the sum over four neighbourhoods a half, as in the paper: the channels stay below 0.4.
    features[: DIRECTIONS + half] *= np.float32(0.5)
    return features

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A small network that has learnt where a vehicle ends, whatever it looks like.

From the cells of a box and what is around it, it tells how far each side of the vehicle is beyond
that of the box: two layers, of 14 hidden units. `python -m laboratory.train_sides` has trained it
on boxes that were moved and scaled at random around true ones, and has measured on cameras that
had no part in it how far it errs.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation.canonical_patch import cut_image
from vehicle_pf_tracker.image.correlation.gradient_cells import (
    DIRECTIONS,
    GRADIENT_CELL_PX,
    GRADIENT_CHANNELS,
)
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.patches.cells import COLOURS, cells_of

Cells = npt.NDArray[np.float32]
"""Cells (..., channels, rows, columns) that the network looks at."""

BOX_CELLS = 10
"""Cells along each side of the box, a choice: as many as the filter has along a square one."""
CELLS = 16
"""Cells along each side of what is looked at, a choice: three beside the box at each of its sides,
so that a vehicle is seen to its end that reaches .3 of the box beyond it."""
_RIM = 1
"""Cells around these that are measured with them: their gradients normalise the outermost."""
_UNSIGNED = DIRECTIONS // 2
"""Unsigned directions: what a vehicle stands before may be brighter or darker."""
CHANNELS = _UNSIGNED + 1 + COLOURS
"""Channels of a cell: unsigned directions, texture, and colour."""
FILE = Path(__file__).with_name("side_network.npz")
"""File of the network that is in use."""


class SideNetwork(NamedTuple):
    """Weights of the network, and how far it errs.

    The three outputs are the left side, the top and the bottom. The right side is the left one of
    the mirrored cells.

    Attributes
    ----------
    first : (channels * rows * columns, hidden) array
        Weights of the hidden units.
    hidden : (hidden,) array
        Their offsets.
    second : (hidden, 3) array
        Weights of the outputs.
    last : (3,) array
        Their offsets.
    noise : (3,) array
        Standard deviation of an error around the mean one on the same vehicle, fraction of the
        box's size.
    """

    first: npt.NDArray[np.float32]
    hidden: npt.NDArray[np.float32]
    second: npt.NDArray[np.float32]
    last: npt.NDArray[np.float32]
    noise: npt.NDArray[np.float32]

    @classmethod
    def read(cls, file: Path) -> SideNetwork:
        """Read the arrays of an ``.npz`` file."""
        with np.load(file) as arrays:
            return cls(*(arrays[name].astype(np.float32) for name in cls._fields))

    def write(self, file: Path) -> None:
        """Write them; the first layer, which is nearly all of them, in half precision."""
        arrays = self._replace(first=self.first.astype(np.float16))
        np.savez(file, **arrays._asdict())

    def outputs(self, cells: Cells) -> npt.NDArray[np.float32]:
        """Compute the outputs (..., 3) for cells (..., channels, rows, columns)."""
        flat = cells.reshape(*cells.shape[:-3], -1)
        return np.asarray(np.maximum(flat @ self.first + self.hidden, 0) @ self.second + self.last)

    def beyond(self, cells: Cells) -> Array:
        """Distances of the vehicle's sides beyond those of the box, fractions of its size.

        Returns
        -------
        (2, 2) array
            By [low or high, axis].
        """
        plain, turned = self.outputs(np.stack([cells, mirrored(cells)])).astype(np.float64)
        # Top and bottom are seen in both.
        _, top, bottom = ((plain + turned) / 2).tolist()
        return np.array([[plain[0], top], [turned[0], bottom]])

    @property
    def noise_by_side(self) -> Array:
        """The noise (2, 2) of each side."""
        side, top, bottom = self.noise.tolist()
        return np.array([[side, top], [side, bottom]])


@functools.cache
def side_network() -> SideNetwork:
    """Return the network that is in use; read once, by the first one who needs it."""
    return SideNetwork.read(FILE)


def side_cells(frame: Frame, centre: Array, size: Array, kernels: Kernels) -> Cells:
    """Measure the cells of a box of this centre and size, px, and of what is around it."""
    # Each axis in its own scale, so that sides are where the network expects them.
    zoom = BOX_CELLS * GRADIENT_CELL_PX / size
    side = (CELLS + 2 * _RIM) * GRADIENT_CELL_PX
    image = cut_image(frame, centre, zoom, (side, side))
    grey = np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), np.uint8)
    (cells,) = cells_of(kernels, image, grey)
    inner = cells[:, _RIM:-_RIM, _RIM:-_RIM]
    unsigned = inner[DIRECTIONS : DIRECTIONS + _UNSIGNED]
    texture = inner[DIRECTIONS + _UNSIGNED : GRADIENT_CHANNELS].sum(axis=0, keepdims=True)
    return np.concatenate([unsigned, texture, inner[GRADIENT_CHANNELS:]])


def mirrored(cells: Cells) -> Cells:
    """Cells (..., channels, rows, columns) of the image mirrored left to right."""
    # A direction and its mirror image add up to half a turn.
    directions = -np.arange(_UNSIGNED) % _UNSIGNED
    channels = np.concatenate([directions, np.arange(_UNSIGNED, CHANNELS)])
    return cells[..., channels, :, ::-1]

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Typed compilation with numba, cached on disk where a folder can be written.

Active bin of each pixel, in numba.

Cells are numbers from 0 to K, where K stands for all bins that are not active. They form planes,
shape (P, H, W): a window's counts are those of all planes together.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias, TypeVar

import numba
import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Grey

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

NOT_KEPT = (
    "compiled kernels cannot be kept on disk ({}); each start compiles them again, for some "
    "seconds: set NUMBA_CACHE_DIR to a folder that can be written"
)

_FASTMATH = {"reassoc", "contract"}
_notices: list[str] = []


def compiled(*signatures: Any) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for these signatures at once, or load what was compiled before.

    Numba uses a writable folder beside the module, else the user's cache folder. Sums may
    be reordered (`reassoc`), which is the same in every run of one machine code; nothing else of
    IEEE arithmetic is given up.

    A function that is called by compiled ones (`inlined`) has to stand in the same file: numba
    recompiles a file that changed, and not those that call into it.
    """

    def compile_it(function: FunctionT) -> FunctionT:
        build = functools.partial(numba.njit, list(signatures), fastmath=_FASTMATH)
        try:
            result: FunctionT = build(cache=True)(function)
        except Exception as error:  # no folder, a full disk, or what a torn file makes of pickle
            if not _notices:
                _notices.append(NOT_KEPT.format(str(error).partition("\n")[0]))
            result = build()(function)
        return result

    return compile_it


def inlined(function: FunctionT) -> FunctionT:
    """Make a part of the compiled functions of the same file."""
    inner: FunctionT = numba.njit(fastmath=_FASTMATH)(function)
    return inner


def notices() -> Sequence[str]:
    """Return the problems met while compiling, one sentence each; later ones join them."""
    return _notices


Cells: TypeAlias = npt.NDArray[np.uint16]
Table: TypeAlias = npt.NDArray[np.uint16]
Rectangles: TypeAlias = npt.NDArray[np.int64]

FRAME = types.Array(types.uint8, 3, "A", readonly=True)
GREY = types.Array(types.uint8, 2, "A", readonly=True)
TABLE = types.Array(types.uint16, 1, "C", readonly=True)
CELLS = types.uint16[:, :, ::1]
RECTANGLES = types.int64[:, ::1]


@compiled(CELLS(FRAME, types.int64, TABLE))
def marginal_cells(pixels: Frame, levels: int, table: Table) -> Cells:
    """Cells of each channel's own bins, a plane each; channel `c` has bins from ``c * levels``."""
    height, width, channels = pixels.shape
    if channels != 3 or not 0 <= 3 * levels <= len(table):
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((3, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            for channel in range(3):
                level = (pixels[y, x, channel] * levels) >> 8
                cells[channel, y, x] = table[channel * levels + level]
    return cells


@compiled(CELLS(GREY, TABLE))
def pair_cells(grey: Grey, table: Table) -> Cells:
    """Cells of the 8 x 8 grey levels of each pixel and the next one in its row, one plane."""
    height, width = grey.shape[0], max(grey.shape[1] - 1, 0)
    if len(table) < 64:
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((1, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            cells[0, y, x] = table[((grey[y, x] >> 5) << 3) | (grey[y, x + 1] >> 5)]
    return cells

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Search of a map for the best value close to each of some places.

`image.kernels` has it compiled, too, to the same bits.
"""

from __future__ import annotations

import functools

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Places = npt.NDArray[np.intp]
"""Places (N, 2) on a map, as x and y."""


def climbed(values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
    """Move places to the best value in reach, less what the move costs.

    Parameters
    ----------
    values : (m, m) array
        The map by [y, x]; beyond its border the outermost values are repeated.
    places : (N, 2) array
        On the map.
    costs : (2 r + 1, 2 r + 1) array
        Costs of the moves by up to `r` places, by [y, x].

    Returns
    -------
    moves : (N, 2) array
        The best of the moves; of equal ones the first.
    gains : (N,) array
        Value there, less the cost.
    """
    side = len(costs)
    reach = side // 2
    # Repeated values make places beyond the border no better than those on it.
    padded = cv2.copyMakeBorder(values, reach, reach, reach, reach, cv2.BORDER_REPLICATE)
    # Places are numbered by the first of their neighbours. Many are the same: of 200 hypotheses
    # about a visible vehicle some 30 are not, and each is searched once.
    width = padded.shape[1]
    numbers = places[:, 1] * width + places[:, 0]
    first = np.flatnonzero(np.bincount(numbers))
    which = first.searchsorted(numbers)
    # One `take` reads all neighbourhoods.
    gains = np.asarray(padded.take(first[:, np.newaxis] + _neighbours(side, width)), float)
    gains -= costs.ravel()
    best = gains.argmax(axis=1)
    # Picked, as a second search of all neighbourhoods would cost as much as the first.
    highest = gains[np.arange(len(best)), best]
    return _moves(side).take(best.take(which), axis=0), highest.take(which)


# The maps of a tracker have one size, so that the tables below are made once.
@functools.cache
def _neighbours(side: int, width: int) -> npt.NDArray[np.intp]:
    """Count the values of a map from the first place of a square to each other, (side * side,)."""
    offsets = np.arange(side)
    return (offsets[:, np.newaxis] * width + offsets).ravel()


@functools.cache
def _moves(side: int) -> Places:
    """List the moves from the middle of a square to all of its places, (side * side, 2)."""
    offsets = np.arange(side) - side // 2
    return np.asarray(np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2))

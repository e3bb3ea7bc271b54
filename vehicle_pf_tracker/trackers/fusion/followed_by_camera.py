# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A hidden vehicle that a moving camera follows: it keeps its place in the image.

Who films a vehicle pans along with it, behind occluders too; and the background's motion is seldom
that of the road below the vehicle. So there are two predictions: that it drives on along the road
at its velocity, and that it keeps its position in the image. Each is weighted by how well it would
have predicted the seconds before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array

_LEAST_SQUARE = 1e-9
"""Added to the squares of the errors, px squared: both are zero for a vehicle that stands."""


class Followed(NamedTuple):
    """Weight of the prediction that a moving camera follows the vehicle.

    Attributes
    ----------
    share : float
        Weight of the prediction that it keeps its position in the image, from 0 to 1.
    place : (2,) array
        Its position in the image at the last sighting, px.
    """

    share: float
    place: Array

    @classmethod
    def measured(cls, ages: Array, positions: Array, places: Array, lag: float) -> Followed:
        """Weigh both predictions by the inverse of their mean square errors so far.

        Parameters
        ----------
        ages : (N,) array
            Ages of the sightings in frames, oldest first.
        positions : (N, 2) array
            Where they are now, carried along with the background, px.
        places : (N, 2) array
            Where they were in the image, px.
        lag : float
            Frames ahead that both are tried for.
        """
        # The first lag gives the velocity, the second one the error of predicting by it.
        tried = ages[ages + 2 * lag <= ages[0]]
        if not len(tried):
            return cls(0.0, places[-1])
        now, before, first = (_at(positions, ages, tried + k * lag) for k in range(3))
        road = _mean_square((now - before) - (before - first))
        place = _mean_square(_at(places, ages, tried) - _at(places, ages, tried + lag))
        return cls(road / (road + place + _LEAST_SQUARE), places[-1])


def _at(values: Array, ages: Array, wanted: Array) -> Array:
    """Values (M, 2) at the wanted ages (M,), linear between sightings."""
    columns = [np.interp(wanted, ages[::-1], column[::-1]) for column in values.T]
    return np.stack(columns, axis=1)


def _mean_square(errors: Array) -> float:
    return float((errors**2).sum(axis=1).mean())

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A hidden vehicle that a moving camera follows: it keeps its place in the image.

Who films a vehicle pans along with it, behind occluders too; and the background's motion is seldom
that of the road below the vehicle. So there are two guesses: that it drives on along the road at
its velocity, and that it stays where it was in the image. Each counts by how well it would have
served in the seconds before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array

_LEAST_SQUARE = 1e-9
"""Added to the squares of the errors, px squared: both are zero for a vehicle that stands."""


class Followed(NamedTuple):
    """How far a moving camera follows the vehicle.

    Attributes
    ----------
    share : float
        Weight of the guess that it keeps its place in the image, from 0 to 1.
    place : (2,) array
        Its place in the image at the last sighting, px.
    """

    share: float
    place: Array

    @classmethod
    def measured(cls, ages: Array, positions: Array, places: Array, lag: float) -> Followed:
        """Weigh both guesses by the inverse of their mean square errors so far.

        Parameters
        ----------
        ages : (N,) array
            Ages of the sightings in frames, oldest first.
        positions : (N, 2) array
            Where they are now, carried along with the background, px.
        places : (N, 2) array
            Where they were in the image, px.
        lag : float
            Frames ahead that both guesses are tried for.
        """
        # One lag tells the velocity, and the next one how far off it leads.
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

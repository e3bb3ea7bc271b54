# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Row of the horizon, from how vehicles grow on their way through the image.

On a plane a vehicle's width is proportional to the distance of its lower edge from the horizon, so
that its relative growth per px is the inverse of that distance. Widths of different vehicles are
not compared: where lorries drive in the nearest lane, they would bend the road.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.vehicle_state import FAR

_LEAST_BOXES = 20
"""Boxes below which a vehicle does not tell how it grows. At 30, HOTA of `traffic-overtaking` falls
by 13: the horizon has to be known soon."""
_REMEMBERED = 50
"""Vehicles that are remembered."""
_WIDTH_NOISE = 0.1
"""Standard deviation of a box's relative width. Detectors err by half of it, and in the same way
in successive frames."""
_TURN = 0.25
"""Standard deviation of a vehicle's growth per image height: on its way it shows its side, or no
longer."""
_ASSUMED_SPREAD = 0.8
"""Standard deviation of the assumed growth per image height: from the side there is none, and from
a bridge a vehicle in the middle doubles its size on a third of the height."""
_GROWTHS = np.geomspace(0.3, 30.0, 100)
"""Growths per image height that are tried, of a vehicle in the middle of all: by less perspective
is none, and where it is more the vehicle is a point."""
_HIGHEST = -1 / float(_GROWTHS[0])
"""Highest row of a calibrated horizon, of the image's height; it makes as little difference."""


class Growth:
    """Regression of one vehicle's widths on its lower edges, in px."""

    def __init__(self) -> None:
        self._sums = np.zeros(5)

    def add(self, edges: Array) -> None:
        """Add a detection (4,) that shows the whole vehicle."""
        width, bottom = float(edges[2] - edges[0]), float(edges[3])
        self._sums += (1.0, bottom, bottom**2, width, bottom * width)

    def told(self, height: int) -> tuple[float, float, float] | None:
        """Summarise it in units of the image's height; None of too few boxes.

        Returns
        -------
        middle, growth, scatter : float
            Mean of its lower edges, relative growth per height, sum of the edges' squared
            deviations.
        """
        count, total, squares, widths, products = self._sums.tolist()
        if count < _LEAST_BOXES or widths <= 0:
            return None
        scatter = squares - total * total / count
        if scatter <= 0:
            return None
        slope = (products - total * widths / count) / scatter * count / widths
        return total / count / height, slope * height, scatter / height**2


def calibrated_row(road: RoadPlane, size: tuple[int, int]) -> float:
    """Row of a calibrated road's horizon in the image's middle column, of the image's height.

    Parameters
    ----------
    road : RoadPlane
        Map from the image to the road.
    size : (int, int)
        Width and height of the image.
    """
    width, height = size
    across, down, level = road.homography.matrix[2].tolist()
    if down <= 0:  # it looks straight down, or stands on its head
        return _HIGHEST
    return float(max(-(across * width / 2 + level) / down / height, _HIGHEST))


class Horizon:
    """Row that explains best how vehicles have grown, those that are followed included."""

    def __init__(self) -> None:
        self._ended: deque[tuple[float, float, float]] = deque(maxlen=_REMEMBERED)

    def learn(self, growth: Growth, height: int) -> None:
        """Add a vehicle whose way has ended."""
        told = growth.told(height)
        if told is not None:
            self._ended.append(told)

    def look(
        self,
        assumed: float,
        followed: Iterable[Growth],
        size: tuple[int, int],
        road: RoadPlane | None,
    ) -> float:
        """Row of the horizon in this image, px; that of the road, where it is calibrated.

        Parameters
        ----------
        assumed : float
            Horizon assumed before vehicles show it, fraction of the image's height.
        followed : iterable of Growth
            Growth of each followed vehicle.
        size : (int, int)
            Width and height of the image.
        road : RoadPlane or None
            Calibrated road.
        """
        if road is not None:
            return calibrated_row(road, size) * size[1]
        return self.row(assumed, followed, size[1]) * size[1]

    def row(self, assumed: float, followed: Iterable[Growth], height: int) -> float:
        """Row of the horizon, of the image's height.

        Parameters
        ----------
        assumed : float
            Horizon assumed before vehicles show it.
        followed : iterable of Growth
            Growth of each followed vehicle.
        height : int
            Height of the image, px.
        """
        told = [*self._ended, *(one for each in followed if (one := each.told(height)))]
        if not told:
            return assumed
        middle, growth, scatter = np.array(told).T[..., np.newaxis]
        centre = float(middle.mean())
        usual = 1 / (centre - min(assumed, centre - 1 / _GROWTHS[-1]))
        growths = np.append(_GROWTHS, usual)
        rows = centre - 1 / growths
        expected = np.where(middle > rows, 1 / (middle - rows), np.inf)
        variance = _WIDTH_NOISE**2 / scatter + _TURN**2
        costs = np.minimum((growth - expected) ** 2 / variance, FAR**2).sum(axis=0)
        return float(rows[int(np.argmin(costs + ((growths - usual) / _ASSUMED_SPREAD) ** 2))])

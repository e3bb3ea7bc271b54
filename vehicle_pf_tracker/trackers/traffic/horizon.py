# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Row of the horizon, from how vehicles grow on their way through the image.

On a plane a vehicle's width is proportional to the distance of its lower edge from the horizon, so
that its relative growth per px is the inverse of that distance. Widths of different vehicles are
not compared: where lorries drive in the nearest lane, they would bend the road.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Rows, columns

_LEAST_BOXES = 20
"""Fewest boxes of a vehicle that give its growth: few, as the horizon has to be known
soon."""
_LEAST_SPARSE = 6
"""Fewest boxes of a vehicle that give its growth where images are sparse: a second of them
has fewer boxes, whose errors are independent. The first value tried."""
_REMEMBERED = 50
"""Vehicles that are remembered. A choice: enough to average `_TURN` out, to a seventh, and few
enough for a camera that is turned to forget."""
_WIDTH_NOISE = 0.1
"""Standard deviation of a box's relative width. Detectors err by half of it, and in the same way
in successive frames."""
_TURN = 0.25
"""Standard deviation of a vehicle's growth per image height: on its way it shows its side, or no
longer."""
_ASSUMED_SPREAD = 0.8
"""Standard deviation of the assumed growth per image height: from the side there is none, and from
a bridge a vehicle in the middle doubles its size on a third of the height."""
_OUTLYING = 3.0
"""Standard deviations of a growth beyond which it is another vehicle's, and counts no more: one in
400 is as far."""
_GROWTHS = np.geomspace(0.3, 30.0, 100)
"""Growths per image height that are tried, of a vehicle in the middle of all: by less perspective
is none, and where it is more the vehicle is a point."""
_HIGHEST = -1 / float(_GROWTHS[0])
"""Highest row of a calibrated horizon, of the image's height; it makes as little difference."""


@dataclass(frozen=True, slots=True, eq=False)
class Growths(Rows):
    """Regressions of the widths of N vehicles on their lower edges, in px.

    Attributes
    ----------
    sums : (N, 5) array
        Sums over the boxes: one, lower edge, its square, width, width times lower edge.
    """

    sums: Array

    @classmethod
    def unknown(cls, count: int) -> Growths:
        """Growths before the first box."""
        return cls(np.zeros((count, 5)))

    def added(self, edges: Array, whole: Bools) -> Growths:
        """Add the detections (N, 4), in px, that show the `whole` vehicle (N,)."""
        width = edges[:, 2] - edges[:, 0]
        bottom = edges[:, 3]
        # Sums are all that a regression needs: the boxes themselves are not kept.
        once = np.ones(len(edges))
        terms = columns(once, bottom, bottom * bottom, width, bottom * width)
        return Growths(self.sums + np.where(whole[:, np.newaxis], terms, 0.0))

    def regressions(self, height: int, sparsity: float = 1.0) -> Array:
        """Regress widths on lower edges, in image heights; vehicles of too few boxes are left out.

        Parameters
        ----------
        height : int
            Height of the image, px.
        sparsity : float
            Interval of images over the longest dense one, at least 1.

        Returns
        -------
        (K, 3) array
            Mean of the lower edges, relative growth per height, and sum of the edges' squared
            deviations, of each.
        """
        least = max(_LEAST_BOXES / sparsity, _LEAST_SPARSE)
        sums = self.sums[(self.sums[:, 0] >= least) & (self.sums[:, 3] > 0)]
        count, total, squares, widths, products = sums.T
        scatter = squares - total * total / count
        # A vehicle that drives across stays at one height, and shows no horizon.
        kept = scatter > 0
        # Least squares, over the mean width: relative growth, the same for cars and lorries.
        slope = (products - total * widths / count) / np.where(kept, scatter, 1.0) * count / widths
        regressions = columns(total / count / height, slope * height, scatter / height**2)
        return np.asarray(regressions[kept])


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


@dataclass(frozen=True, slots=True, eq=False)
class Horizon:
    """Row that explains best how vehicles have grown, those that are followed included.

    Attributes
    ----------
    row : float
        The row in px.
    ended : (K, 3) array
        Growth of vehicles whose paths have ended, as `Growths.regressions` has it.
    """

    row: float = 0.0
    ended: Array = field(default_factory=lambda: np.empty((0, 3)))

    def learnt(self, growths: Growths, height: int, sparsity: float = 1.0) -> Horizon:
        """Add vehicles whose paths have ended; see `Growths.regressions`."""
        ended = np.concatenate([self.ended, growths.regressions(height, sparsity)])
        return replace(self, ended=ended[-_REMEMBERED:])

    def updated(
        self,
        assumed: float,
        followed: Growths,
        size: tuple[int, int],
        road: RoadPlane | None,
        sparsity: float = 1.0,
    ) -> Horizon:
        """Find the row in this image; that of the road, where it is calibrated.

        Parameters
        ----------
        assumed : float
            Horizon assumed before vehicles show it, fraction of the image's height.
        followed : Growths
            Growths of the vehicles that are followed.
        size : (int, int)
            Width and height of the image.
        road : RoadPlane or None
            Calibrated road.
        sparsity : float
            Interval of images over the longest dense one, at least 1.
        """
        if road is not None:
            return replace(self, row=calibrated_row(road, size) * size[1])
        # Those that are followed are not stored: they count once, with all that they have grown so
        # far.
        regressions = np.concatenate([self.ended, followed.regressions(size[1], sparsity)])
        return replace(self, row=explaining_row(assumed, regressions) * size[1])


def explaining_row(assumed: float, regressions: Array) -> float:
    """Row of the horizon that explains growths (K, 3) best, of the image's height.

    Parameters
    ----------
    assumed : float
        Horizon assumed before vehicles show it.
    regressions : (K, 3) array
        Mean lower edge, relative growth and scatter of each vehicle, see `Growths.regressions`.
    """
    if not len(regressions):
        return assumed
    middle, growth, scatter = regressions.T[..., np.newaxis]
    centre = float(middle.mean())
    # The assumed horizon as a growth; one below the vehicles would make it negative.
    usual = 1 / (centre - min(assumed, centre - 1 / _GROWTHS[-1]))
    # The assumed one is tried, too, so that without evidence the row is exactly that.
    growths = np.concatenate([_GROWTHS, [usual]])
    rows = centre - 1 / growths
    # A horizon below a vehicle cannot be: infinite growth costs the bound.
    expected = np.where(middle > rows, 1 / (middle - rows), np.inf)
    # Error of a regression's slope, and the vehicle's own turning, which more boxes do not lessen.
    variance = _WIDTH_NOISE**2 / scatter + _TURN**2
    # Bounded, so that one vehicle that turned, or was two, does not move the horizon of the others.
    costs = np.minimum((growth - expected) ** 2 / variance, _OUTLYING**2).sum(axis=0)
    return float(rows[int(np.argmin(costs + ((growths - usual) / _ASSUMED_SPREAD) ** 2))])

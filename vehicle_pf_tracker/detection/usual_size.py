# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Size of vehicles by where they stand, learnt from those that drive apart from others."""

from __future__ import annotations

import math

import numpy as np

from vehicle_pf_tracker.detection.pieces import Piece

SPREAD = 0.2
"""Standard deviation of the logarithm of a car's size. A choice: cars are alike within a fifth."""
SIZES_NEEDED = 50
"""Least boxes that a usual size is taken from by which blobs are divided and specks dropped: of one
vehicle that has driven through."""
MEMORY = 0.998
"""Weight of the boxes before each, or of earlier images: some minutes."""
WIDEST_MASK = 400
"""Largest width of a mask in px: finer says nothing more about vehicles."""
_MOST_SIZE_COST = 4.0
"""Most cost of another size: a lorry is twice as large, and has to stay whole."""
_SINGULAR = 1e-4
"""Least singular value, of the largest one's, that tells: while all vehicles have driven on one
line, the size beside it is taken to be the same."""
_ROUGHLY_NEEDED = 10
"""Least boxes for an estimate of how many vehicles a blob holds, which decides nothing. Of a jam
ten are known in image 60 of 140, and tell the size within a third; fifty are in image 136."""
_PER_AREA = 0.9
"""Vehicles for each usual area in the box of a blob: neighbours overlap, corners are empty. Fitted
to eleven clips of six cameras by `laboratory.traffic.joined`; .8 or .9 without one of them."""
_SEVERAL = 1.5
"""Least number of vehicles by its area of a blob that is taken for several, fitted with it: of 1.5,
2 and 2.5 the first is best without any one of the cameras."""
_EXTRAPOLATED = 1.5
"""Largest ratio of the usual size at a place to the nearest size that was learnt: beyond, trees
at the horizon would be hundreds of vehicles."""


class UsualSize:
    """Size of vehicles by where they stand: on a plane it is an affine function of the image."""

    def __init__(self) -> None:
        self._squares = np.zeros((3, 3))
        self._sums = np.zeros(3)
        self._count = 0
        self._slopes: list[float] = []
        self._is_settled = False
        self._smallest = math.inf
        self._largest = 0.0

    @property
    def is_roughly_known(self) -> bool:
        """Test whether enough is learnt to estimate how many vehicles a blob holds."""
        return bool(self._slopes)

    def learn(self, piece: Piece) -> None:
        """Add the box of one vehicle; all count alike, near and far ones."""
        size = _size(piece)  # one number for width and height
        place = np.array(
            [(piece.left + piece.right) / 2 / WIDEST_MASK, piece.bottom / WIDEST_MASK, 1.0]
        )
        # Least squares of size, each row over its own size: relative errors count.
        self._squares = MEMORY * self._squares + np.outer(place, place) / size**2
        self._sums = MEMORY * self._sums + place / size
        self._count += 1
        self._smallest = min(self._smallest, size)
        self._largest = max(self._largest, size)

    def settle(self) -> None:
        """Fit the usual sizes for the next image."""
        if self._count >= _ROUGHLY_NEEDED:
            solved = np.linalg.lstsq(self._squares, self._sums, rcond=_SINGULAR)
            self._slopes = solved[0].tolist()
        self._is_settled = self._count >= SIZES_NEEDED

    def deviation(self, piece: Piece) -> float:
        """Logarithm of a box's size over the usual one, in its spread; 0 while none is known."""
        if not self._is_settled:
            return 0.0
        return math.log(_size(piece) / max(self._at(piece), 1.0)) / SPREAD

    def cost(self, piece: Piece) -> float:
        """Squared deviation of a box, of a larger one not more than lorries cost."""
        apart = self.deviation(piece)  # a smaller one may be half of a vehicle
        return apart**2 if apart < 0 else min(apart**2, _MOST_SIZE_COST)

    def vehicles_in(self, blob: Piece) -> float:
        """Estimate how many vehicles a blob holds by its area.

        0 of one that may be a single vehicle, and where no size is known, or is far from all that
        were learnt.
        """
        if not self._slopes:
            return 0.0
        usual = self._at(blob)
        # Not below nor above what was seen: the plane is learnt on a part of the image.
        learnt = min(max(usual, self._smallest), self._largest)
        if not learnt / _EXTRAPOLATED < usual < learnt * _EXTRAPOLATED:
            return 0.0
        count = _PER_AREA * math.prod(blob.sides) / learnt**2
        return count if count >= _SEVERAL else 0.0

    def _at(self, piece: Piece) -> float:
        """Usual size where a box stands, px of the mask."""
        across, down, level = self._slopes
        return ((piece.left + piece.right) / 2 * across + piece.bottom * down) / WIDEST_MASK + level


def _size(piece: Piece) -> float:
    return math.sqrt(math.prod(piece.sides))

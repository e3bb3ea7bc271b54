# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Part of a blob, which may be a vehicle."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array


class Piece(NamedTuple):
    """Part of a vehicle: edges in px of the mask, and its area in px."""

    left: float
    top: float
    right: float
    bottom: float
    area: float

    @property
    def sides(self) -> tuple[float, float]:
        """Width and height in px."""
        return self.right - self.left, self.bottom - self.top

    @property
    def log_aspect(self) -> float:
        """Logarithm of height over width."""
        width, height = self.sides
        return math.log(height / width)

    @property
    def log_fullness(self) -> float:
        """Logarithm of the share of the box that moves."""
        width, height = self.sides
        return math.log(self.area / (width * height))

    @property
    def edges(self) -> Array:
        """Left, top, right and bottom, (4,)."""
        return np.array(self[:4])

    def is_free(self, shape: tuple[int, ...]) -> bool:
        """Test whether no border of the image cuts the box."""
        height, width = shape
        inside = self.right < width - 1 and self.bottom < height - 1
        return min(self.left, self.top) > 1 and inside

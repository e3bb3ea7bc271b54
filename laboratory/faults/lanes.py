# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A small grey road whose vehicles come and go in lanes, and are detected with errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame

Corners = dict[int, tuple[float, float]]
"""Left upper corner of each vehicle in an image, px."""


@dataclass(frozen=True)
class Road:
    """Size of the images, the vehicles and their ways, px.

    Attributes
    ----------
    width, height : int
        Size of the images.
    lanes : int
        Number of lanes, each with the same share of the height.
    size : (float, float)
        Width and height of a vehicle.
    speed : float
        Way of a vehicle per image in the first lane; it is a tenth more in each further one.
    every : float
        Images from one vehicle to the next, which takes the next lane.
    missed, false : float
        Shares of boxes that the detector misses, and of images with a false one.
    """

    width: int = 160
    height: int = 120
    lanes: int = 5
    size: tuple[float, float] = (16.0, 12.0)
    speed: float = 4.0
    every: float = 2.0
    missed: float = 0.03
    false: float = 0.02

    def empty(self) -> Frame:
        """Make the image without vehicles."""
        shape = self.height, self.width, 3
        return np.asarray(np.random.default_rng(1).integers(96, 112, shape, np.uint8), np.uint8)

    def with_vehicles(self, empty: Frame, corners: Corners) -> Frame:
        """Paint each vehicle in a colour of its own onto a copy of the empty image."""
        frame: Frame = empty.copy()
        width, height = self.size
        for number, (x, y) in corners.items():
            columns = slice(max(int(x), 0), max(int(x + width), 0))
            # Factors without a common divisor with 200: neighbours in number look different.
            colour = [(37 * number) % 200 + 30, (91 * number) % 200 + 30, (53 * number) % 200 + 30]
            frame[int(y) : int(y + height), columns] = colour
        return frame

    def nearest(self, x: float, y: float, corners: Corners) -> int | None:
        """Return the vehicle whose centre is within half a size of a point."""
        width, height = self.size
        for number, (left, top) in corners.items():
            if abs(left + width / 2 - x) < width / 2 and abs(top + height / 2 - y) < height / 2:
                return number
        return None


class Traffic:
    """Vehicles in lanes, at most `total`.

    Attributes
    ----------
    begun, total : int
        Vehicles that have come, and that will have come.
    """

    def __init__(self, road: Road, total: int, seed: int) -> None:
        self.begun = 0
        self._road = road
        self.total = total
        self._rng = np.random.default_rng(seed)
        self._there: dict[int, tuple[int, float]] = {}

    def step(self, image: int) -> Corners:
        """Drive on by an image; returns the left upper corner of each vehicle in it, px."""
        road = self._road
        for number, (lane, x) in list(self._there.items()):
            # Lanes of different speeds: vehicles overtake, and boxes of neighbours pass each other.
            moved = x + road.speed * (1 + 0.1 * lane)
            if moved < road.width:
                self._there[number] = lane, moved
            else:
                del self._there[number]
        while self.begun < self.total and image >= self.begun * road.every:
            # Not all at whole pixels.
            x = -road.size[0] + float(self._rng.uniform(0, 2))
            self._there[self.begun] = self.begun % road.lanes, x
            self.begun += 1
        return {number: (x, self._top(lane)) for number, (lane, x) in self._there.items()}

    def _top(self, lane: int) -> float:
        share = self._road.height // self._road.lanes
        return (share - self._road.size[1]) / 2 + share * lane

    @property
    def is_over(self) -> bool:
        """True once all have come and gone."""
        return self.begun == self.total and not self._there

    def detect(self, corners: Corners) -> Array:
        """Detect them: noisy, some missed, and now and then what is not there."""
        width, height = self._road.size
        rows = []
        for x, y in corners.values():
            if self._rng.random() >= self._road.missed:
                # Cut at the borders, as a detector sees what is in the image only.
                left = max(x, 0.0)
                right = min(x + width, self._road.width)
                # 0.3 px on each number, a choice: 2 % of the width of a vehicle.
                noise = self._rng.normal(0, 0.3, 4)
                rows.append(np.array([left, y, right - left, height]) + noise)
        if self._rng.random() < self._road.false:
            rows.append(np.array([*self._rng.uniform(0, 100, 2), 0.75 * width, 0.75 * height]))
        return np.array(rows).reshape(-1, 4)

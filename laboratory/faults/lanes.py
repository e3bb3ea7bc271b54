# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A small grey road with vehicles in lanes that come and go, and whose number is on which."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame

FOREIGN = 0.2
"""Share of its images from which on a number that is on another vehicle has been handed on."""

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

    def painted(self, empty: Frame, corners: Corners) -> Frame:
        """Paint each vehicle in a colour of its own."""
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


@dataclass(frozen=True)
class Sighting:
    """One vehicle in the tracker's answer: number, centre in px, and whether it is confirmed."""

    identity: int
    x: float
    y: float
    is_confirmed: bool


class Numbers:
    """Keeps who had which number, in memory that does not grow.

    Attributes
    ----------
    issued : int
        The highest number that was issued.
    reissued : int
        Numbers that came back after they were gone, or came below one that was issued before.
    of : array
        Count of the numbers that each vehicle had, shape (vehicles,).
    handed_on : int
        Numbers that went over to another vehicle.
    """

    def __init__(self, road: Road, total: int) -> None:
        self.issued = self.reissued = self.handed_on = 0
        self.of = np.zeros(total, np.int32)
        self._road = road
        self._votes: dict[int, Counter[int]] = {}

    def judge(self, answer: Iterable[Sighting], corners: Corners) -> None:
        """Take the answer to an image, and where the vehicles are in it."""
        sightings = [one for one in answer if one.identity]  # tentative ones have no number yet
        identities = {sighting.identity for sighting in sightings}
        # Two tracks of one answer must not have one number.
        self.reissued += len(sightings) - len(identities)
        # A number that is gone is closed: memory must not grow with the hours.
        for gone in self._votes.keys() - identities:
            self._close(self._votes.pop(gone))
        # The highest before this answer, as new ones come in any order within it.
        highest = self.issued
        for one in sightings:
            if one.identity not in self._votes:
                self.reissued += one.identity <= highest
                self.issued = max(self.issued, one.identity)
                self._votes[one.identity] = Counter()
            vehicle = self._road.nearest(one.x, one.y, corners)
            if one.is_confirmed and vehicle is not None:
                self._votes[one.identity][vehicle] += 1

    def _close(self, votes: Counter[int]) -> None:
        """Note whose number it was."""
        if votes:
            ((vehicle, own),) = votes.most_common(1)
            self.of[vehicle] += 1
            self.handed_on += votes.total() - own > FOREIGN * votes.total()

    def report(self) -> None:
        """Print what became of the numbers."""
        missing = (self.of == 0).sum()
        split = (self.of > 1).sum()
        print(f"numbers issued: {self.issued}; twice: {self.reissued}")
        print(f"vehicles without a number: {missing}; with more than one: {split}")
        print(f"numbers that went over to another vehicle: {self.handed_on}")

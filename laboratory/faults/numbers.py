# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Numbers that a node gives to vehicles, judged by whose they truly are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from sensor_msgs.msg import PointCloud2

from laboratory.faults.lanes import Corners, Road

CONFIRMED = (1, 2, 3)
"""Modes in ~/tracks of vehicles that have had enough evidence."""
FIELD_TYPES = {2: "u1", 6: "<u4", 7: "<f4"}
"""numpy's words for the datatypes of sensor_msgs/PointField that ~/tracks has."""
FOREIGN = 0.2
"""Share of its images from which on a number that is on another vehicle has been handed on."""


@dataclass(frozen=True)
class Sighting:
    """One vehicle in the tracker's answer: number, centre in px, and whether it is confirmed."""

    identity: int
    x: float
    y: float
    is_confirmed: bool


def sightings(cloud: PointCloud2) -> list[Sighting]:
    """Read ~/tracks by the fields that the message itself names."""
    # By the fields that the message states, as a subscriber that knows nothing else reads it.
    kind = np.dtype(
        {
            "names": [field.name for field in cloud.fields],
            "formats": [FIELD_TYPES[field.datatype] for field in cloud.fields],
            "offsets": [field.offset for field in cloud.fields],
            "itemsize": cloud.point_step,
        }
    )
    points = np.frombuffer(bytes(cloud.data), kind)
    return [
        Sighting(
            int(point["id"]), float(point["x"]), float(point["y"]), int(point["mode"]) in CONFIRMED
        )
        for point in points
    ]


class Numbers:
    """Which vehicle had which numbers, in memory that does not grow.

    Attributes
    ----------
    issued : int
        The highest number that was issued.
    reissued : int
        Numbers that came back after they were gone, or came below one that was issued before.
    by_vehicle : array
        Count of the numbers that each vehicle had, shape (vehicles,).
    handed_on : int
        Numbers that went over to another vehicle.
    """

    def __init__(self, road: Road, total: int) -> None:
        self.issued = self.reissued = self.handed_on = 0
        self.by_vehicle = np.zeros(total, np.int32)
        self._road = road
        self._votes: dict[int, Counter[int]] = {}

    def judge(self, answer: Iterable[Sighting], corners: Corners) -> None:
        """Take the answer to an image, and where the vehicles are in it."""
        # Tentative ones have no number yet.
        numbered = [sighting for sighting in answer if sighting.identity]
        identities = {sighting.identity for sighting in numbered}
        # Two tracks of one answer must not have one number.
        self.reissued += len(numbered) - len(identities)
        # A number that is gone is closed: memory must not grow with the hours.
        for gone in self._votes.keys() - identities:
            self._close(self._votes.pop(gone))
        # The highest before this answer, as new ones come in any order within it.
        highest = self.issued
        for sighting in numbered:
            if sighting.identity not in self._votes:
                self.reissued += sighting.identity <= highest
                self.issued = max(self.issued, sighting.identity)
                self._votes[sighting.identity] = Counter()
            vehicle = self._road.nearest(sighting.x, sighting.y, corners)
            if sighting.is_confirmed and vehicle is not None:
                self._votes[sighting.identity][vehicle] += 1

    def _close(self, votes: Counter[int]) -> None:
        """Note whose number it was."""
        if votes:
            ((vehicle, own),) = votes.most_common(1)
            self.by_vehicle[vehicle] += 1
            self.handed_on += votes.total() - own > FOREIGN * votes.total()

    def report(self) -> None:
        """Print what became of the numbers."""
        missing = (self.by_vehicle == 0).sum()
        split = (self.by_vehicle > 1).sum()
        print(f"numbers issued: {self.issued}; twice: {self.reissued}")
        print(f"vehicles without a number: {missing}; with more than one: {split}")
        print(f"numbers that went over to another vehicle: {self.handed_on}")

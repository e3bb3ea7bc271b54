# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Class of each vehicle, decided once for rows, counts and pictures alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_STEADY = 15
"""Detections in a row, half a second at 30 Hz, after which the class that most say stays: of 36
vehicles by YOLOX-Nano 4 changed class, and 33 keep the one they would have had in the end. After 5
and 30 it is 34."""
_LONGEST = 60
"""Images after which it is decided in any case, two seconds at 30 Hz, a choice: rows are held back
for it, and a user waits."""


@dataclass(slots=True)
class _Vote:
    """Votes for the class of one vehicle."""

    label: str
    steady: int = 0
    images: int = 0
    is_decided: bool = False


class VehicleClasses:
    """Decides the class of each vehicle.

    The tracker says for each image which class most detections so far have. That is the vehicle's
    class once it has stood for half a second; at the latest when the vehicle is counted, or two
    seconds after its first.
    """

    def __init__(self) -> None:
        self._votes: dict[int, _Vote] = {}  # by the vehicles' numbers

    def clear(self) -> None:
        """Discard all vehicles."""
        self._votes.clear()

    def named(self, estimates: Sequence[TrackEstimate]) -> tuple[TrackEstimate, ...]:
        """Return estimates of the next image, numbered vehicles by the class decided for them."""
        named = tuple(self._named(estimate) for estimate in estimates)
        followed = {estimate.identity for estimate in estimates}
        # Of vehicles that are followed only: a node runs for weeks.
        self._votes = {number: vote for number, vote in self._votes.items() if number in followed}
        return named

    def decide(self, identity: int) -> None:
        """Let the class of a vehicle be what it is now, as it is counted."""
        if identity in self._votes:
            self._votes[identity].is_decided = True

    @property
    def undecided(self) -> frozenset[int]:
        """Numbers of the vehicles whose class may still change."""
        return frozenset(number for number, vote in self._votes.items() if not vote.is_decided)

    def _named(self, estimate: TrackEstimate) -> TrackEstimate:
        # A tentative vehicle has no number, and what motion finds has no class.
        if not (estimate.identity and estimate.label):
            return estimate
        vote = self._votes.setdefault(estimate.identity, _Vote(estimate.label))
        if not vote.is_decided:
            if estimate.label != vote.label:
                vote.label = estimate.label
                vote.steady = 0
            # An image without a detection adds no vote, but time that the user waits.
            vote.steady += not math.isnan(estimate.score)
            vote.images += 1
            vote.is_decided = vote.steady >= _STEADY or vote.images >= _LONGEST
        return estimate if vote.label == estimate.label else replace(estimate, label=vote.label)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Backdating: vehicles and classes in frames before those in which they became known."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence, Set
from dataclasses import replace

from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_SEEN = frozenset({TrackMode.TENTATIVE, TrackMode.TRACKING})
"""Modes in which a box was measured, not predicted."""
_HELD_FRAMES = 90
"""Frames that are held back at most until their tentative vehicles are known: 3 s at 30 Hz."""
FrameEstimates = tuple[int, int, Sequence[TrackEstimate]]
"""Number of a frame, its stamp in ns, and the vehicles in it."""
Frames = Iterator[FrameEstimates]
"""Frames in their order, with what is known of them."""


class Backdating:
    """Frames that are held back until the vehicles and classes in them are known.

    Tentative vehicles that are confirmed get their numbers from their first detection on; the
    others are left out. A vehicle has the class that was decided for it in all frames. A hidden one
    that was found again has the boxes of the track that it turned out to be, not its prediction.
    """

    def __init__(self) -> None:
        self._held: deque[FrameEstimates] = deque()
        self._numbers: dict[int, int] = {}
        self._labels: dict[int, str] = {}

    def add(
        self,
        frame: int,
        stamp_ns: int,
        estimates: Sequence[TrackEstimate],
        undecided: Set[int] = frozenset(),
    ) -> Frames:
        """Take the next frame, and return those that are known, in order.

        `undecided` has the numbers of the vehicles whose class may still change.
        """
        self._held.append((frame, stamp_ns, estimates))
        known = [estimate for estimate in estimates if estimate.identity]
        self._numbers.update({estimate.serial: estimate.identity for estimate in known})
        self._numbers.update(
            {estimate.joined: estimate.identity for estimate in known if estimate.joined}
        )
        self._labels.update(
            {estimate.identity: estimate.label for estimate in known if estimate.label}
        )
        unknown = {
            estimate.serial
            for estimate in estimates
            if not estimate.identity or estimate.identity in undecided
        }
        while self._held and (
            len(self._held) > _HELD_FRAMES
            or unknown.isdisjoint(estimate.serial for estimate in self._held[0][2])
        ):
            yield self._known(*self._held.popleft())

    def rest(self) -> Frames:
        """Return the frames that are still held back, as the source has ended."""
        while self._held:
            yield self._known(*self._held.popleft())

    def _known(
        self, frame: int, stamp_ns: int, estimates: Sequence[TrackEstimate]
    ) -> FrameEstimates:
        """Give the vehicles of a frame the numbers and classes that are known by now."""
        by_number: dict[int, TrackEstimate] = {}
        for estimate in estimates:
            number = self._numbers.get(estimate.serial, 0)
            other = by_number.get(number)
            if number and (other is None or other.mode not in _SEEN):
                label = self._labels.get(number, estimate.label)
                is_same = (estimate.identity, estimate.label) == (number, label)
                by_number[number] = (
                    estimate if is_same else replace(estimate, identity=number, label=label)
                )
        return frame, stamp_ns, list(by_number.values())

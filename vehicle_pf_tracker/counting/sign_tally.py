# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signs at all lines so far, by place, direction and class."""

from __future__ import annotations

from collections import Counter as Tally
from collections.abc import Callable, Iterable

from vehicle_pf_tracker.counting.count_signs import Sign

PlacedSign = tuple[str, str, str, Sign]
"""Place, direction, class, and the sign there."""


class SignTally:
    """Signs of crossings, and of vehicles that ended without one.

    Attributes
    ----------
    has_blobs : bool
        True where detections were blobs, which may hold several vehicles.
    """

    def __init__(self) -> None:
        self.has_blobs = False
        self._total: Tally[PlacedSign] = Tally()
        self._ended: dict[int, list[PlacedSign]] = {}  # by tracks that may come back

    def add(self, sign: PlacedSign) -> None:
        """Add the sign of a crossing."""
        self._total[sign] += 1

    def remove(self, sign: PlacedSign) -> None:
        """Take back the sign of a crossing that turned out to be none."""
        self._total[sign] -= 1

    def end(self, serial: int, signs: list[PlacedSign]) -> None:
        """Add the signs of a track that is not followed any more."""
        if signs:
            # Kept by track besides the total, to be subtracted if the track comes back.
            self._ended[serial] = signs
            self._total.update(signs)

    def withdraw(self, serial: int) -> None:
        """Take back the signs of a track that has come back, or turned out to be another one."""
        self._total.subtract(self._ended.pop(serial, ()))

    def keep(self, serial: int) -> None:
        """Let the signs of a track that does not come back be for good."""
        self._ended.pop(serial, None)

    def clear(self) -> None:
        """Discard all signs, and of what detections they were."""
        self.has_blobs = False
        self._total.clear()
        self._ended.clear()

    def at(
        self,
        place: str,
        direction: str,
        is_asked: Callable[[str], bool],
        more: Iterable[PlacedSign],
    ) -> Tally[Sign]:
        """Return the signs at a place in a direction, of some classes, with a few `more`."""
        found: Tally[Sign] = Tally()
        # The sum of two Counters also drops what withdrawals have left at 0.
        for (at, to, label, sign), number in (self._total + Tally(more)).items():
            if (at, to) == (place, direction) and is_asked(label):
                found[sign] += number
        return found

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Life of one vehicle in a run: its class, its occlusions, and where it went."""

from __future__ import annotations

from collections import Counter as Tally
from dataclasses import dataclass, field
from enum import Enum

from vehicle_pf_tracker.trackers.traffic.estimate import BORDER_OCCLUDER, TrackEstimate

_SMALLEST_NEAR = 32.0
"""Longer side in px above which a vehicle is not too far: four of the finest cells of a network,
and twice what motion needs."""
_RECEDED = 0.5
"""Share of its largest size to which a vehicle that vanishes far away has shrunk: one that crosses
the image in front of the camera keeps its size."""


class Whereabouts(str, Enum):
    """Place of a vehicle, as far as it is known."""

    IN_VIEW = "in view"
    BORDER = "left over the border"
    ROI = "left the regions of interest"
    FAR = "too far away"
    HIDDEN = "hidden"


@dataclass(slots=True)
class VehicleLog:
    """Life of one vehicle in a run.

    Attributes
    ----------
    labels : Counter of str
        Frames in which it was visible as each class.
    survived : int
        Occlusions after which it was visible under the same number.
    whereabouts : Whereabouts
        Where it is; one that was hidden stays so until it is visible again.
    is_at_edge : bool
        True where it was about to drive out of the regions of interest when it was last visible.
    first, size, largest : float
        Longer side of its box when it was first and last visible, and the longest of all, px.
    """

    labels: Tally[str] = field(default_factory=Tally)
    survived: int = 0
    whereabouts: Whereabouts = Whereabouts.IN_VIEW
    is_at_edge: bool = False
    first: float = 0.0
    size: float = 0.0
    largest: float = 0.0

    @property
    def label(self) -> str:
        """Class of most frames: a lorry far away looks like a car; "" where it is unknown."""
        return max(self.labels, key=self.labels.__getitem__, default="")

    @property
    def far_sizes(self) -> list[float]:
        """Longer sides, px, at which it came out of the distance, and vanished into it."""
        ends = [self.first] if self._was_far(self.first) else []
        return ends + ([self.size] if self.whereabouts is Whereabouts.FAR else [])

    def see(self, estimate: TrackEstimate, *, is_at_edge: bool) -> None:
        """Take a frame in which it is visible."""
        self.survived += self.whereabouts in (Whereabouts.HIDDEN, Whereabouts.FAR)
        self.labels.update([estimate.label] * bool(estimate.label))
        self.whereabouts = Whereabouts.IN_VIEW
        self.is_at_edge = is_at_edge
        self.size = max(estimate.box.width, estimate.box.height)
        self.first = self.first or self.size
        self.largest = max(self.largest, self.size)

    def miss(self, estimate: TrackEstimate, *, is_outside: bool) -> None:
        """Take a frame in which it is predicted, or lost, in or out of the regions of interest."""
        if self.whereabouts in (Whereabouts.HIDDEN, Whereabouts.FAR):
            return  # where it is predicted to have gone since is not known
        if estimate.hidden_by == BORDER_OCCLUDER:
            self.whereabouts = Whereabouts.BORDER
        elif self.is_at_edge or is_outside:
            self.whereabouts = Whereabouts.ROI
        elif self.whereabouts is Whereabouts.IN_VIEW:
            is_far = self._was_far(self.size) and not isinstance(estimate.hidden_by, int)
            self.whereabouts = Whereabouts.FAR if is_far else Whereabouts.HIDDEN

    def end(self) -> None:
        """Note that it is not followed any more: a tracker ends what it sees at the border only."""
        if self.whereabouts is Whereabouts.IN_VIEW:
            self.whereabouts = Whereabouts.ROI if self.is_at_edge else Whereabouts.BORDER

    def _was_far(self, size: float) -> bool:
        return size < min(_SMALLEST_NEAR, _RECEDED * self.largest)

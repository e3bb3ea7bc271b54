"""What is known about the vehicle in a frame: where it is and how much of it can be seen."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from vehicle_pf_tracker.core.box import Box

TOTAL_BELOW = 0.1
"""A vehicle is totally occluded when less than this fraction of it is visible."""


class Occlusion(IntEnum):
    """How far the vehicle is hidden, numbered as in `groundtruth.csv`."""

    NONE = 0
    PARTIAL = 1
    TOTAL = 2

    @classmethod
    def of(cls, visible_fraction: float) -> Occlusion:
        """Classify by the visible fraction (0 to 1) of the vehicle's pixels."""
        if visible_fraction < TOTAL_BELOW:
            return cls.TOTAL
        return cls.NONE if visible_fraction >= 1.0 else cls.PARTIAL


@dataclass(frozen=True, slots=True)
class Truth:
    """The vehicle's true state in one frame.

    Attributes
    ----------
    stamp_ns : int
        Stamp of the image this belongs to, in ns.
    box : Box
        The whole vehicle, hidden parts included, in px.
    occlusion : Occlusion
        None, partial or total.
    visible_fraction : float or None
        Share (0 to 1) of the vehicle's pixels that can be seen; None where it is not known.
    """

    stamp_ns: int
    box: Box
    occlusion: Occlusion
    visible_fraction: float | None = None

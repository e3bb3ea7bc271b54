# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Ground truth of the vehicle in a frame: its box and its visibility."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from vehicle_pf_tracker.core.box import Box

TOTAL_BELOW = 0.1
"""Visible fraction below which an occlusion is total: what remains is too little to be localised,
and ground truth drawn by hand rarely distinguishes it from nothing."""


class Occlusion(IntEnum):
    """Degree of occlusion, numbered as in `groundtruth.csv`."""

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
    """True state of the vehicle in one frame.

    Attributes
    ----------
    stamp_ns : int
        Stamp of the image that it belongs to, in ns.
    box : Box
        Box of the whole vehicle, occluded parts included, in px.
    occlusion : Occlusion
        Degree of occlusion: none, partial or total.
    visible_fraction : float or None
        Share (0 to 1) of the vehicle's pixels that are visible; None where it is not known.
    """

    stamp_ns: int
    box: Box
    occlusion: Occlusion
    visible_fraction: float | None = None

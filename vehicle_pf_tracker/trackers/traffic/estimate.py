# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimate of one vehicle among many."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from vehicle_pf_tracker.core.box import Box, Position

SCENE_OCCLUDER = "scene"
"""Occluder of a track that nothing followed hides: a sign, a bridge, the unknown."""
BORDER_OCCLUDER = "border"
"""Occluder of a track that is mostly outside the image: it leaves."""


class TrackMode(str, Enum):
    """Claim about a vehicle.

    `TENTATIVE` has too little evidence yet; `TRACKING` is seen; `OCCLUDED` is taken to be hidden
    and is predicted; `LOST` has been hidden for too long to be predicted, has left the
    image, or is rather not there.
    """

    TENTATIVE = "TENTATIVE"
    TRACKING = "TRACKING"
    OCCLUDED = "OCCLUDED"
    LOST = "LOST"


@dataclass(frozen=True, slots=True)
class TrackEstimate:
    """Estimate of one vehicle in one frame.

    Attributes
    ----------
    identity : int
        Number of the vehicle, from 1, in the order in which they are confirmed; never used for
        another one. 0 while it is `TENTATIVE`.
    box : Box
        Box of the vehicle in px, predicted while it is hidden; it may extend beyond the image.
    velocity : (float, float)
        Velocity of the box's centre in px per nominal frame period.
    mode : TrackMode
        Claim about the vehicle.
    confidence : float
        Probability that the vehicle is where the box says, 0 to 1.
    label : str
        Class as the detections say it; "" where they do not.
    score : float
        Score of the detection that it was matched with in this frame; NaN without one.
    age : float
        Time since it was first seen, in nominal frame periods.
    hidden_by : int or "scene" or "border" or None
        Identity of the vehicle that hides it, `SCENE_OCCLUDER`, `BORDER_OCCLUDER`, or None
        where it is in sight.
    serial : int
        Number of its track, the same before and after it is confirmed.
    joined : int
        Serial of the track as which it was found again after it was hidden; 0 if of none.
    foot_covariance : (float, float, float)
        Variance of x, covariance of x and y, and variance of y of the middle of the box's lower
        edge, px²; zeros where they are not known.
    """

    identity: int
    box: Box
    velocity: tuple[float, float]
    mode: TrackMode
    confidence: float
    label: str
    score: float
    age: float
    hidden_by: int | str | None
    serial: int = 0
    joined: int = 0
    foot_covariance: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def id(self) -> int:
        """Number of the vehicle, as other libraries call it."""
        return self.identity

    @property
    def is_visible(self) -> bool:
        """True where it is seen."""
        return self.mode is TrackMode.TRACKING

    @property
    def is_followed(self) -> bool:
        """True where it is seen, or taken to be hidden."""
        return self.mode in (TrackMode.TRACKING, TrackMode.OCCLUDED)

    @property
    def position(self) -> Position:
        """Centre of the box in px."""
        return self.box.centre

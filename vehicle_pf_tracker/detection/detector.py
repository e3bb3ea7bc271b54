# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A detector, and what it learns of the vehicles that are followed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections


class FollowedVehicle(Protocol):
    """Estimate of a vehicle in the image before, of which a detector may make use."""

    @property
    def box(self) -> Box:
        """Box in px."""
        ...

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of the box's centre in px per nominal frame period."""
        ...

    @property
    def is_visible(self) -> bool:
        """True where the vehicle is confirmed and seen."""
        ...

    @property
    def is_followed(self) -> bool:
        """True where the vehicle is confirmed, and seen or taken to be hidden."""
        ...


class Detector(Protocol):
    """Finds vehicles in an image.

    Attributes
    ----------
    disturbed : bool
        True where the latest image differs too much from those before to look for vehicles in it.
    is_blind : bool
        True where it has not looked in the latest image, for this reason or another.
    """

    disturbed: bool
    is_blind: bool

    def detect(
        self,
        frame: Frame,
        tracks: Sequence[FollowedVehicle] = (),
        period: float = DEFAULT_PERIOD,
    ) -> Detections:
        """Find them.

        Parameters
        ----------
        frame : Frame
            RGB image.
        tracks : sequence of FollowedVehicle
            Estimates of the frame before.
        period : float
            Nominal time since the image that it looked at before, s.
        """
        ...

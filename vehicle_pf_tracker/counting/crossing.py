# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Passage of one vehicle over a line, or into or out of a zone."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode


@dataclass(frozen=True, slots=True)
class Crossing:
    """Passage of one vehicle over a line, or into or out of a zone.

    Attributes
    ----------
    stamp_ns : int
        Time at which it crossed, between the images before and after it, ns.
    place : str
        Name of the line or zone.
    direction : str
        Name of the line's direction; ``entry`` or ``exit`` of a zone.
    identity : int
        Number of the vehicle.
    label : str
        Class of the vehicle; "" where it is unknown.
    mode : TrackMode
        Claim about it when it crossed: where that is `OCCLUDED`, its path was predicted; where it
        is `LOST`, it was seen before and after, and its path is taken to be straight.
    speed_px : float or None
        Speed of the lower edge's middle over the last half second, px/s; None where it was not
        followed for long enough.
    speed_kmh : float or None
        Speed on the road, km/h; None without a road, or outside its calibrated area.
    point : (float, float)
        Where it crossed, px.
    doubt : str
        Why it is left out of the totals, of `counting.plausibility`; "" where it counts.
    """

    stamp_ns: int
    place: str
    direction: str
    identity: int
    label: str
    mode: TrackMode
    speed_px: float | None
    speed_kmh: float | None
    point: Position
    doubt: str = ""

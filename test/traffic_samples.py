# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates and tracks of vehicles for tests, without a tracker."""

import math

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.track import Track
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Drive, VehicleState

MODES = {
    "t": TrackMode.TENTATIVE,
    "T": TrackMode.TRACKING,
    "O": TrackMode.OCCLUDED,
    "L": TrackMode.LOST,
}
DRIVE = Drive(0.1, 1.0, 300.0)
"""Motion of these vehicles."""


def vehicle(identity, x, bottom, mode=TrackMode.TRACKING, *, label="car", size=(30.0, 20.0)):
    """Make the estimate of a vehicle whose lower edge has its middle at (x, bottom)."""
    width, height = size
    return TrackEstimate(
        identity=identity,
        box=Box(x - width / 2, bottom - height, width, height),
        velocity=(0.0, 0.0),
        mode=mode,
        confidence=0.9,
        label=label,
        score=math.nan,
        age=1.0,
        hidden_by=None,
        serial=identity,
    )


def track(number, left, top=100.0, *, confirmed=False, **facts):
    """Make the track of a vehicle of 40 x 30 px that stands under a far horizon."""
    edges = np.array([left, top, left + 40.0, top + 30.0])
    state = VehicleState(edges, np.ones(4), -1000.0, DRIVE)
    return Track(number, state, number if confirmed else 0, **facts)

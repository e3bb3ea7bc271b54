# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates and tracks of vehicles for tests, without a tracker."""

import functools
import math

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.candidates import weigh
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.rows import Rows
from vehicle_pf_tracker.trackers.traffic.state import Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Gaussians, Motion

MODES = {
    "t": TrackMode.TENTATIVE,
    "T": TrackMode.TRACKING,
    "O": TrackMode.OCCLUDED,
    "L": TrackMode.LOST,
}
MOTION = Motion(0.1, 1.0, 300.0)
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
    """Make the track of a vehicle of 40 x 30 px that stands under a far horizon, one row."""
    edges = np.array([[left, top, left + 40.0, top + 30.0]])
    gaussians = Gaussians.around(edges, np.ones((1, 4)), np.array([-1000.0]), MOTION)
    return track_of(gaussians, number, confirmed=confirmed, **facts)


def track_of(gaussians, number=1, *, confirmed=False, **facts):
    """Make the track of a vehicle in this state of one row."""
    tracks = Tracks.begun(gaussians, np.array([number]), np.zeros((1, 4)))
    return changed(tracks, identity=number if confirmed else 0, **facts)


def together(*tracks):
    """Put tracks of one row each below each other."""
    return functools.reduce(lambda above, below: above.extended(below), tracks)


def changed(rows, **facts):
    """Set fields of rows, all alike, by their names wherever they are."""
    rows, unknown = _changed(rows, facts)
    assert not unknown, f"no rows have {unknown}"
    return rows


def _changed(rows, facts):
    """Rows with the facts that are fields of theirs, and the names of the other facts."""
    values, unknown = {}, set(facts)
    for name in type(rows).__dataclass_fields__:
        value = getattr(rows, name)
        if isinstance(value, Rows):
            values[name], others = _changed(value, facts)
            unknown &= others
        elif name in facts:
            values[name] = value.copy()
            values[name][:] = facts[name]
            unknown.discard(name)
        else:
            values[name] = value
    return type(rows)(**values), unknown


def step_of(size=(320, 240), *, elapsed=1.0, period=1 / 30, parameters=None):
    """Make a step whose image is black."""
    width, height = size
    return Step(
        size=size,
        grey=np.zeros((height, width), np.uint8),
        colours=ColourBins(np.zeros((height, width, 3), np.uint8)),
        parameters=parameters or TrafficParameters(),
        road=None,
        period=period,
        elapsed=elapsed,
        normals=np.zeros((50, 3)),
    )


def candidates_of(evidence, *boxes, are_shapes=False, size=(320, 240)):
    """Detections of one frame by a detector that claims nothing, weighed by earlier ones."""
    evidence.begin_image(are_shapes=are_shapes)
    return weigh(Detections.make(boxes, np.ones(len(boxes))), evidence, size)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""First states of vehicles: what a border of the image cuts is completed by the usual aspect."""

from __future__ import annotations

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.edge_observation import Edge
from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.vehicle_state import (
    ANY_SPEED,
    USUAL_ASPECT,
    Gaussians,
    Motion,
)

_ASPECT_DEVIATION = 0.25
"""Standard deviation of `USUAL_ASPECT`, of its value, where a border cuts a vehicle when it is
first seen: a car's aspect from the side, some .5, is one and a half of them away."""
_THIN = 0.5
"""Share of the usual side below which most of a vehicle is out of sight, so that neither edge tells
where it is."""


def first_gaussians(
    edges: Array,
    measurement: MeasurementModel,
    horizon: Array,
    motion: Motion,
    speeds: Array = ANY_SPEED,
) -> Gaussians:
    """Make the states of vehicles from their first boxes, which borders of the image may cut.

    Parameters
    ----------
    edges : (K, 4) array
        Edges of the boxes, px.
    measurement : MeasurementModel
        How their edges are measured.
    horizon : (K,) array
        Row of the horizon, px.
    motion : Motion
        Motion model of vehicles.
    speeds : (2, 2) array
        Covariance of their speeds across and along the road, in squares of the motion's top speed.
    """
    # What is cut is completed by the usual aspect and made uncertain: measured as it is, a vehicle
    # that comes in would grow at every frame as if it drove towards the camera.
    cut = measurement.cut_edges(edges)
    spread = measurement.deviations(edges)
    whole = edges.copy()
    width, height = (edges[:, 2:] - edges[:, :2]).T
    _complete(whole, spread, cut, (Edge.TOP, Edge.BOTTOM), height, USUAL_ASPECT * width)
    _complete(whole, spread, cut, (Edge.LEFT, Edge.RIGHT), width, height / USUAL_ASPECT)
    return Gaussians.around(whole, spread, horizon, motion, speeds)


def _complete(
    edges: Array,
    spread: Array,
    cut: Bools,
    ends: tuple[Edge, Edge],
    side: Array,
    usual: Array,
) -> None:
    """Move the one of two edges (K, 4) that a border cuts to where it usually is."""
    low, high = ends
    known = _ASPECT_DEVIATION * usual
    # What is seen of it may be from anywhere in the vehicle.
    thin = side < _THIN * usual
    spread[thin, low] = spread[thin, high] = known[thin]
    # Larger than usual is whole, whatever the border. Of both ends one is moved: the other one
    # anchors it.
    at_low = (side < usual) & cut[:, low]
    at_high = (side < usual) & ~cut[:, low] & cut[:, high]
    edges[at_low, low] = (edges[:, high] - usual)[at_low]
    spread[at_low, low] = known[at_low]
    edges[at_high, high] = (edges[:, low] + usual)[at_high]
    spread[at_high, high] = known[at_high]

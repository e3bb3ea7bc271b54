# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Measurement of a vehicle by a detection, edge by edge.

An edge that the border of the image cuts, or that something covers, does not tell where the vehicle
ends: measured, it would brake the vehicle at an occluder and shrink it.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.trackers.traffic.association import INWARD, cut_edges, deviations
from vehicle_pf_tracker.trackers.traffic.detections import areas
from vehicle_pf_tracker.trackers.traffic.track import Track
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Drive, Edge, VehicleState

_PUSHED = 1.0
"""Standard deviations that the opposite edge may at most be pushed out by, where an edge is drawn
in because it is covered. A vehicle that brakes pushes it out."""
_PATIENCE = 30
"""Detections in a row that an edge may be covered in; then it is the vehicle that was taken too
large: 1 s, in which even a slow vehicle goes behind what hides it."""
_WHOLE = 0.85
"""Share of the width or height, of the predicted and of the latest detections, below which one of
the two edges is covered: at the rim of an occluder the edge does not jump, it creeps, and would
brake the vehicle."""
_LESS = 0.95
"""Share of the latest detections' width or height below which an edge can have jumped inward: a
box of the same size as before is not covered, it was predicted wrong."""
_FADED = 0.985
"""Decay per detection of the largest latest width and height: a vehicle that drives away
becomes smaller by about 1 % per frame."""
_SETTLED = 4
"""Least detections by which a box is known well enough to tell that an edge is covered."""
_ASPECT = 0.8
"""Height of a vehicle over its width where a border cuts it when it is first seen: that of cars
from the front. From the side it is half of it, hence the deviation."""
_ASPECT_DEVIATION = 0.25
_IMPLAUSIBLE = 0.6
"""Side of a first box, of the usual one, below which something hides a part: its edges may grow."""
_INSIDE = 0.7
"""Share of a detection inside the prediction above which it can be one of several in it."""
_BESIDE = 0.1
"""Share of another detection up to which it overlaps with this one and is still beside it."""
_NOTABLE = 0.15
"""Share of the prediction above which another detection in it is no fragment."""
_CROWDED = 3
"""Detections in a row that tell: one may have been torn apart by chance."""
NO_OTHERS = np.empty((0, 4))
"""Edges of other detections where there are none."""
_OPPOSITE = (Edge.RIGHT, Edge.BOTTOM, Edge.LEFT, Edge.TOP)


def first_state(
    edges: Array, noise: float, horizon: float, drive: Drive, size: tuple[int, int]
) -> VehicleState:
    """Make the state of a vehicle from its first detection, which borders of the image may cut.

    Parameters
    ----------
    edges : (4,) array
        Edges of the detection, px.
    noise : float
        Standard deviation of an edge, fraction of the size.
    horizon : float
        Row of the horizon, px.
    drive : Drive
        Motion model of vehicles.
    size : (int, int)
        Width and height of the image.
    """
    edges, spread = edges.copy(), deviations(edges, noise)
    cut = cut_edges(edges, size)
    width, height = (edges[2:] - edges[:2]).tolist()
    for low, high, side, usual in (
        (Edge.TOP, Edge.BOTTOM, height, _ASPECT * width),
        (Edge.LEFT, Edge.RIGHT, width, height / _ASPECT),
    ):
        if side >= usual:
            continue
        if side < _IMPLAUSIBLE * usual:
            spread[low] = spread[high] = _ASPECT_DEVIATION * usual
        if cut[low]:
            edges[low], spread[low] = edges[high] - usual, _ASPECT_DEVIATION * usual
        elif cut[high]:
            edges[high], spread[high] = edges[low] + usual, _ASPECT_DEVIATION * usual
    return VehicleState(edges, spread, horizon, drive)


def measure(
    track: Track,
    edges: Array,
    noise: float,
    covered: float,
    size: tuple[int, int],
    others: Array = NO_OTHERS,
) -> bool:
    """Correct a track's state by a detection; True if the whole of the vehicle was measured.

    Parameters
    ----------
    track : Track
        Track, predicted into this frame.
    edges : (4,) array
        Edges of the detection, px.
    noise : float
        Standard deviation of an edge, fraction of the size.
    covered : float
        Standard deviations inward above which an edge is taken to be covered.
    size : (int, int)
        Width and height of the image.
    others : (N, 4) array
        Edges of the other detections, px.
    """
    state = track.state
    if _is_one_of_several(track, edges, others):
        state.resize(edges)
    predicted = state.edges
    spread = deviations(predicted, noise)
    uncertainty = np.sqrt(np.diag(state.edge_covariance) + spread**2)
    normal = ((edges - predicted) * INWARD / uncertainty).tolist()
    cut, beyond = cut_edges(edges, size), cut_edges(predicted, size)
    sides = edges[2:] - edges[:2]
    track.sides = np.maximum(sides, _FADED * track.sides)
    shrunk = sides < _WHOLE * np.minimum(predicted[2:] - predicted[:2], track.sides)
    less = sides < _LESS * track.sides
    patient = track.matches >= _SETTLED and track.partial < _PATIENCE
    whole = True
    for edge in Edge:
        if cut[edge] and beyond[edge]:
            continue
        own, opposite = normal[edge], normal[_OPPOSITE[edge]]
        jumped = bool(less[edge % 2]) and own > covered and opposite > -_PUSHED
        crept = bool(shrunk[edge % 2]) and own > max(opposite, 0.0)
        if jumped or crept:
            whole = False
            if patient:
                continue
        state.measure(edge, float(edges[edge]), float(spread[edge]))
    track.partial = 0 if whole else track.partial + 1
    return whole


def _is_one_of_several(track: Track, edges: Array, others: Array) -> bool:
    """Test whether what was taken for one vehicle is several, of which this is the nearest.

    Vehicles that enter the image side by side are one blob, and drive apart later. The detection of
    one is then no part of a larger vehicle whose rest is hidden: the rest is there, behind it.

    Parameters
    ----------
    track : Track
        Track, predicted into this frame.
    edges : (4,) array
        Edges of its detection, px.
    others : (N, 4) array
        Edges of the other detections.
    """
    predicted = track.state.edges
    own = areas(others)
    beside = (
        (intersections(predicted, others) > _NOTABLE * areas(predicted))
        & (intersections(edges, others) < _BESIDE * own)
        & (others[:, Edge.BOTTOM] < edges[Edge.BOTTOM])
    )
    known = intersections(predicted, edges[np.newaxis])[0] > _INSIDE * areas(edges)
    track.crowded = track.crowded + 1 if known and beside.any() else 0
    if track.crowded < _CROWDED:
        return False
    track.crowded = 0
    track.sides = edges[2:] - edges[:2]
    return True


def is_cut(edges: Array, size: tuple[int, int]) -> bool:
    """Tell whether a border of the image cuts a box (4,)."""
    return bool(cut_edges(edges, size).any())

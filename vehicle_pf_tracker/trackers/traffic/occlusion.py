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

"""Occlusions among vehicles: the one whose lower edge is nearer on the road hides the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.overlaps import areas, inside_image, intersections
from vehicle_pf_tracker.trackers.traffic.track import Track

_OCCLUDER_SEEN = 3.0
"""Nominal periods since it was seen, up to which a vehicle can hide others."""
_NAMED_SHARE = 0.3
"""Share of a vehicle that another hides from which on it is named as its occluder."""


def nearest_first(tracks: Sequence[Track], road: RoadPlane | None) -> list[Track]:
    """Order vehicles by their distance from the camera.

    Parameters
    ----------
    tracks : sequence of Track
        Vehicles.
    road : RoadPlane or None
        Road that they stand on; None: the lower a vehicle stands in the image, the nearer it is.
    """
    edges = np.array([track.state.edges for track in tracks]).reshape(-1, 4)
    feet = np.column_stack([(edges[:, 0] + edges[:, 2]) / 2, edges[:, 3]])
    nearness = feet[:, 1] if road is None else road.homography.nearness(road.ideal(feet))
    # What a lens cannot show is out of the image, and last.
    distances = np.nan_to_num(-nearness, nan=np.inf).tolist()
    order = sorted(zip(distances, tracks, strict=True), key=_by_distance)
    return [track for _, track in order]


def _by_distance(pair: tuple[float, Track]) -> tuple[float, int]:
    return pair[0], pair[1].identity


def cover(tracks: Sequence[Track], size: tuple[int, int], occlusions: bool) -> None:
    """Note what of each vehicle is in sight.

    Parameters
    ----------
    tracks : sequence of Track
        Nearest first.
    size : (int, int)
        Width and height of the image.
    occlusions : bool
        False: no vehicle hides another.
    """
    nearer: list[Track] = []
    edges = np.empty((0, 4))
    for track in tracks:
        own = track.state.edges
        common = intersections(own, edges) / areas(own)
        track.covers = edges[common > 0]
        track.visible = max(1 - float(common.sum()), 0.0)
        track.inside = inside_image(own, size)
        track.hidden_by = None
        if len(common) and common.max() > _NAMED_SHARE:
            track.hidden_by = nearer[int(common.argmax())].identity
        if occlusions and track.confirmed and track.unseen <= _OCCLUDER_SEEN and not track.lost:
            nearer.append(track)
            edges = np.vstack([edges, own])

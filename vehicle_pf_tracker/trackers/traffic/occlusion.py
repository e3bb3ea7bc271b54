# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Occlusions: what hides vehicles, and where they are seen again.

Of two vehicles, the one whose lower edge is nearer on the road hides the other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import NOTHING, areas, inside_image
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.detection_evidence import GRID, HALF, Place
from vehicle_pf_tracker.trackers.traffic.track import FEW, Track, edges_of
from vehicle_pf_tracker.trackers.traffic.vehicle_state import SETTLED_AFTER

_UNIFORM = 2.0
"""Outcomes that a prior is worth: as many as a uniform one."""


class Returns:
    """How much of what vanished in plain sight was seen again, by place.

    Below a bridge nearly all is, elsewhere hardly anything: what vanished was no vehicle, or no
    part of one, or its detections went to another. The share in one place is a beta-binomial
    estimate, whose prior is the share everywhere; that begins at a half.
    """

    def __init__(self) -> None:
        self._counts = np.zeros((2, GRID, GRID))

    def learn(self, place: Place, *, found: bool) -> None:
        """Add an outcome."""
        row, column = place
        self._counts[int(found), row, column] += 1
        if self._counts[:, row, column].sum() > SETTLED_AFTER:
            self._counts[:, row, column] /= 2  # leaves and road works come and go

    def share(self, place: Place) -> float:
        """Share that is seen again."""
        row, column = place
        everywhere = _estimated(self._counts.sum(axis=(1, 2)), HALF)
        return _estimated(self._counts[:, row, column], everywhere)


def _estimated(outcomes: Array, prior: float) -> float:
    """Posterior mean of a share, of the numbers without and with it."""
    without, found = outcomes.tolist()
    return float((found + _UNIFORM * prior) / (without + found + _UNIFORM))


def nearest_first(tracks: Sequence[Track], road: RoadPlane | None) -> list[Track]:
    """Order vehicles by their distance from the camera.

    Parameters
    ----------
    tracks : sequence of Track
        Vehicles.
    road : RoadPlane or None
        Road that they stand on; None: the lower a vehicle stands in the image, the nearer it is.
    """
    edges = edges_of(tracks)
    feet = np.column_stack([(edges[:, 0] + edges[:, 2]) / 2, edges[:, 3]])
    nearness = feet[:, 1] if road is None else road.homography.nearness(road.ideal(feet))
    # What a lens cannot show is out of the image, and last.
    distances = np.nan_to_num(-nearness, nan=np.inf).tolist()
    order = sorted(range(len(tracks)), key=lambda index: (distances[index], tracks[index].serial))
    return [tracks[index] for index in order]


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
    edges = edges_of(tracks)
    hiding = [
        rank
        for rank, one in enumerate(tracks)
        if occlusions and one.confirmed and one.unseen < FEW and not one.lost
    ]
    common = intersections(edges[:, np.newaxis], edges[hiding]) / areas(edges)[:, np.newaxis]
    common[np.arange(len(tracks))[:, np.newaxis] <= np.array(hiding, dtype=np.intp)] = 0.0
    most = common.max(axis=1, initial=0.0) > HALF
    visible = np.maximum(1 - common.sum(axis=1), 0.0).tolist()
    for track, row, inside, seen, named in zip(
        tracks, common, inside_image(edges, size).tolist(), visible, most.tolist(), strict=True
    ):
        covers = edges[hiding][row > 0] if seen < 1 else NOTHING
        hider = tracks[hiding[int(row.argmax())]].identity if named else None
        track.show(seen, inside, covers, hider)

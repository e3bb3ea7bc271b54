# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tracks that move as one body: a lorry and its cab, which a network boxes both.

A part is in the same place of its vehicle in every image, however far that drives; another vehicle
in front of it or behind moves through its box, unless both have the same speed by chance.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

_INSIDE = 0.7
"""Mean share of the smaller box in the larger one above which it may be part of it, as in `parts`:
a cab at the end of its lorry sticks out by the noise of three edges, a seventh, and a car in the
lane before a lorry by a third."""
_SHARED = 0.5
"""Share of the smaller box in the larger one, in one image, below which all that spoke for one body
is void: most of it is beside."""
MISSED_FOR = 4
"""Images with both boxes by which two may be one, and without that of the elder by which the other
is now all of it: fewer may be wrong."""
_SPREAD = 0.07
"""Standard deviation of the part's place in the whole, as a share of the whole's sides, per size of
the whole that both have driven, up to which they are one body: .06 of a real lorry and its cab.
Another vehicle that drives through the box at constant speed spreads over 1 / sqrt(12) of its
displacement in it, so that this one has the same speed up to a quarter."""
SHORT_DRIVE = 0.4
"""Distance driven, in sizes of the whole, that shows a track without a number to be part of a
vehicle: that of a drive (`birth.displacement`)."""
LONG_DRIVE = 1.0
"""Distance driven, in sizes of the whole, after which two numbers become one: a choice, longer than
the other as it takes a number away."""


class Together(NamedTuple):
    """Images, in a row but for those with only one of both, in which one track was in the other.

    Attributes
    ----------
    images : int
        Number of these images.
    first : (float, float, float)
        Centre of the larger box in the first one, and its size, the root of its area, px.
    driven : float
        Distance driven from there to the latest one, in sizes: that of the centres, and the
        logarithm of the growth.
    sums : (float, float, float, float)
        Sums of the smaller box's place in the larger one, across and down, of its sides, of the
        square of both, and of its share in it.
    """

    images: int
    first: tuple[float, float, float]
    driven: float
    sums: tuple[float, float, float, float]

    def is_one(self, least_drive: float) -> bool:
        """Test whether the smaller box has kept its place in the larger one on such a drive."""
        across, down, squares, inside = (each / self.images for each in self.sums)
        # Of both axes, hence the two.
        spread = math.sqrt(max(squares - across**2 - down**2, 0.0) / 2)
        is_part = inside > _INSIDE and spread <= _SPREAD * self.driven
        return is_part and self.images >= MISSED_FOR and self.driven >= least_drive


Companions: TypeAlias = Mapping[tuple[int, int], Together]
"""Pairs of tracks that may be one body, by their serials, the elder first."""
NO_COMPANIONS: Companions = {}


def updated_companions(
    companions: Companions, tracks: Tracks, measurement: MeasurementModel
) -> Companions:
    """Note which of the tracks that were detected in this image were in each other.

    Parameters
    ----------
    companions : Companions
        Those known so far.
    tracks : Tracks
        Tracks in this image.
    measurement : MeasurementModel
        How a detector measures edges in this image.
    """
    rows = np.flatnonzero(tracks.detected)
    boxes = tracks.latest.detection[rows]
    sizes = areas(boxes)
    shares = intersections(boxes[:, np.newaxis], boxes) / np.minimum(sizes[:, np.newaxis], sizes)
    # 1. Those of tracks that have ended go, and those that this image shows apart.
    left = set(tracks.names.serial.tolist())
    now = {serial: index for index, serial in enumerate(tracks.names.serial[rows].tolist())}
    known = {
        pair: each
        for pair, each in companions.items()
        if left.issuperset(pair)
        and not (now.keys() >= set(pair) and shares[now[pair[0]], now[pair[1]]] < _SHARED)
    }
    # 2. One image more of those that are in each other; serials are those of birth.
    # While the border cuts the whole its part moves in what is seen of it.
    is_whole = np.asarray(~measurement.cut_edges(boxes).any(axis=1))
    inside = np.triu((shares > _SHARED) & is_whole[:, np.newaxis] & is_whole, 1)
    serials = list(now)
    for pair in np.argwhere(inside).tolist():
        small, large = sorted(pair, key=sizes.__getitem__)
        elder, younger = sorted(serials[index] for index in pair)
        before = known.get((elder, younger))
        share = float(shares[small, large])
        known[elder, younger] = _added(before, boxes[small].tolist(), boxes[large].tolist(), share)
    return known


def _added(
    before: Together | None, small: list[float], large: list[float], share: float
) -> Together:
    """Add an image with these edges of both, and this share of the smaller one in the other."""
    width = large[2] - large[0]
    height = large[3] - large[1]
    centre = (large[0] + large[2]) / 2, (large[1] + large[3]) / 2
    across = ((small[0] + small[2]) / 2 - centre[0]) / width
    down = ((small[1] + small[3]) / 2 - centre[1]) / height
    size = math.sqrt(width * height)
    images, first, _, sums = before or Together(0, (*centre, size), 0.0, (0.0, 0.0, 0.0, 0.0))
    # One that comes straight on hardly moves, and grows.
    driven = math.hypot(math.dist(first[:2], centre) / size, math.log(size / first[2]))
    terms = across, down, across**2 + down**2, share
    sums = (sums[0] + terms[0], sums[1] + terms[1], sums[2] + terms[2], sums[3] + terms[3])
    return Together(images + 1, first, driven, sums)

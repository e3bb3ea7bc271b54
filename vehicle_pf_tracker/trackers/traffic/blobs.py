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

"""Boxes of vehicles from a mask of what moves.

What touches in the mask need not be one vehicle, and one vehicle need not be of one piece: the
predictions of the vehicles that are followed tell.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.trackers.traffic.detections import (
    SHIPPED,
    TrafficNumbers,
    areas,
    overlaps,
)

Mask: TypeAlias = npt.NDArray[np.uint8]

_LEAST_AREA = 0.0003
"""Smallest area of a vehicle, of the image: 23 px in 320 x 240."""
_LEAST_PIECE = 4
"""Smallest area in px of a piece of a vehicle."""
_TRIMMED = 0.15
"""Rows and columns at the rim with less of the fullest one are cut off: reflections, shadows."""
_COVERED = 0.5
"""Share of a predicted vehicle in a blob above which it may be a part of the blob."""
_ALONE = 0.65
"""Intersection over union with one prediction above which a blob is that vehicle alone."""
_PIECE = 0.8
"""Share of a blob inside a prediction above which it is a piece of that vehicle."""
_REACH = 1.25
"""Distance from a prediction's centre, of its half size, within which a pixel can be its own."""
_ASPECT, _ASPECT_SPREAD = np.log(0.8), 0.3
"""Usual logarithm of height over width, to start from, and its standard deviation."""
_ASPECT_RATE = 0.02
"""Rate at which the usual aspect follows blobs of one vehicle each."""
_ASPECT_SIDE = 10
"""Least side in px of a blob whose aspect is learnt."""
_SPLIT_MARGIN = 1.0
"""Advantage of taking a blob for the several vehicles that are followed there."""
_NOTABLE = 0.1
"""Share of the largest piece above which another one is part of the vehicle, and no noise."""
_OWN = 0.15
"""Share of a blob above which a part of it can be a vehicle."""
_SHAPED = 100
"""Least area in px of a blob that has a shape."""
_FULLNESS, _FULLNESS_SPREAD = np.log(0.8), 0.2
"""Usual logarithm of a vehicle's share of its box, to start from, and its standard deviation."""
_NECK = 0.6
"""Depth of a blob's parts, of the deepest place, below which they hang together by a neck only: two
vehicles of one size whose corners touch."""
_SECOND = 0.7
"""Least depth of the other parts, of the deepest: mirrors and shadows are shallower."""


@dataclass(frozen=True, slots=True)
class Piece:
    """Part of a vehicle: edges (4,) in px of the mask, and area in px."""

    edges: Array
    area: float


class BlobReader:
    """Makes boxes of masks; learns the usual shape of vehicles.

    Parameters
    ----------
    numbers : TrafficNumbers
        Thresholds.
    """

    def __init__(self, numbers: TrafficNumbers = SHIPPED) -> None:
        self._numbers = numbers
        self._aspect = float(_ASPECT)
        self._fullness = float(_FULLNESS)

    def read(self, mask: Mask, predicted: Array) -> tuple[Array, Array]:
        """Find vehicles.

        Parameters
        ----------
        mask : (H, W) array
            1 where something moves, else 0.
        predicted : (T, 4) array
            Edges of the vehicles that are followed, px of the mask.

        Returns
        -------
        edges : (N, 4) array
            px of the mask.
        fullness : (N,) array
            Share of each box that moves.
        """
        least = max(_LEAST_AREA * mask.size, _LEAST_PIECE)
        found: list[Piece] = []
        pieces: dict[int, list[Piece]] = {}
        for part, box in _components(mask):
            members = np.flatnonzero(intersections(box, predicted) > _COVERED * areas(predicted))
            if self._is_divided(box, predicted, members):
                found += _divided(part, box, predicted[members])
                continue
            for piece in self._apart(part, box):
                self._learn_shape(piece, mask.shape, len(members))
                inside = intersections(piece.edges, predicted)
                if len(inside) and inside.max() > _PIECE * areas(piece.edges):
                    pieces.setdefault(int(inside.argmax()), []).append(piece)
                else:
                    found.append(piece)
        for own in pieces.values():
            found += self._grouped(own)
        found = [piece for piece in found if piece.area >= least]
        edges = np.array([piece.edges for piece in found]).reshape(-1, 4)
        area = np.array([piece.area for piece in found])
        return edges, area / areas(edges)

    def _apart(self, part: npt.NDArray[np.bool_], box: Array) -> list[Piece]:
        """Divide a blob at its necks, if its parts look more like vehicles than the whole."""
        x, y = box[:2].astype(int).tolist()
        whole = _piece(part, x, y)
        cores = _cores(part)
        if len(cores) < 2:
            return [whole]
        rows, columns = np.nonzero(part)
        points = np.column_stack([columns, rows]) + 0.5
        owners = np.argmin(
            [((points - centre) ** 2).sum(axis=1) / area for centre, area in cores], axis=0
        )
        parts = []
        for owner in range(len(cores)):
            own = np.zeros_like(part)
            own[rows[owners == owner], columns[owners == owner]] = True
            if own.any():
                parts.append(_piece(own, x, y))
        return parts if self._are_several(parts, whole) else [whole]

    def _grouped(self, pieces: list[Piece]) -> list[Piece]:
        """Join the pieces in one prediction, unless they look like vehicles of their own."""
        joined = _joined(pieces)
        notable = [one for one in pieces if one.area > _OWN * joined.area]
        if len(notable) > 1 and self._are_several(notable, joined):
            return notable
        return [joined]

    def _are_several(self, parts: list[Piece], whole: Piece) -> bool:
        """Test whether parts of a blob look more like vehicles than the whole does."""
        if min(one.area for one in parts) < _OWN * whole.area or whole.area < _SHAPED:
            return False
        apart = max(self._shape_cost(one) for one in parts)
        return apart + self._numbers.apart < self._shape_cost(whole)

    def _shape_cost(self, piece: Piece) -> float:
        """Squared standard deviations of aspect and fullness from the usual ones."""
        aspect = self._aspect_cost(piece.edges[np.newaxis])[0]
        fullness = np.log(piece.area / areas(piece.edges)) - self._fullness
        return float(aspect + (fullness / _FULLNESS_SPREAD) ** 2)

    def _is_divided(self, box: Array, predicted: Array, members: npt.NDArray[np.intp]) -> bool:
        """Test for several vehicles in a blob: none fits alone, and the aspects suggest it."""
        if len(members) < 2 or overlaps(box, predicted).max() > _ALONE:
            return False
        apart = self._aspect_cost(predicted[members]).mean()
        return bool(apart < self._aspect_cost(box[np.newaxis])[0] + _SPLIT_MARGIN)

    def _aspect_cost(self, edges: Array) -> Array:
        return np.asarray(((_log_aspect(edges) - self._aspect) / _ASPECT_SPREAD) ** 2)

    def _learn_shape(self, piece: Piece, shape: tuple[int, ...], members: int) -> None:
        box = piece.edges
        sides = box[2:] - box[:2]
        free = box[:2].min() > 1 and box[2] < shape[1] - 1 and box[3] < shape[0] - 1
        if members == 1 and free and sides.min() > _ASPECT_SIDE:
            aspect = float(_log_aspect(box[np.newaxis])[0])
            self._aspect += _ASPECT_RATE * (aspect - self._aspect)
            fullness = float(np.log(piece.area / areas(box)))
            self._fullness += _ASPECT_RATE * (fullness - self._fullness)


def _piece(part: npt.NDArray[np.bool_], x: int, y: int) -> Piece:
    """Make a piece of the pixels of a mask whose corner is at (x, y)."""
    return Piece(_trimmed(part, x, y), float(part.sum()))


def _components(mask: Mask) -> Iterator[tuple[npt.NDArray[np.bool_], Array]]:
    """Divide a mask into what hangs together: pixels within a box (4,), and this box."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    for index in range(1, count):
        x, y, width, height, area = stats[index].tolist()
        if area >= _LEAST_PIECE:
            part = labels[y : y + height, x : x + width] == index
            yield part, np.array([x, y, x + width, y + height], dtype=np.float64)


def _cores(part: npt.NDArray[np.bool_]) -> list[tuple[Array, float]]:
    """Find the parts that hang together by necks only: centre in px from the corner, and area."""
    if min(part.shape) < _ASPECT_SIDE:
        return []
    padded = cv2.copyMakeBorder(part.astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    contours, _ = cv2.findContours(padded, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(padded, contours, -1, 1, cv2.FILLED)
    depth = cv2.distanceTransform(padded, cv2.DIST_L2, 3)
    count, labels, stats, centres = cv2.connectedComponentsWithStats(
        (depth > _NECK * depth.max()).astype(np.uint8)
    )
    return [
        (centres[index] - 0.5, float(stats[index, cv2.CC_STAT_AREA]))
        for index in range(1, count)
        if depth[labels == index].max() > _SECOND * depth.max()
    ]


def _log_aspect(edges: Array) -> Array:
    sides = np.maximum(edges[:, 2:] - edges[:, :2], 1.0)
    return np.asarray(np.log(sides[:, 1] / sides[:, 0]))


def _divided(part: npt.NDArray[np.bool_], box: Array, predicted: Array) -> list[Piece]:
    """Give each pixel of a blob to the prediction that it is nearest to, in its half sizes."""
    rows, columns = np.nonzero(part)
    points = np.column_stack([columns, rows]) + box[:2] + 0.5
    middles = (predicted[:, :2] + predicted[:, 2:]) / 2
    halves = (predicted[:, 2:] - predicted[:, :2]) / 2
    distances = (np.abs(points[:, np.newaxis] - middles) / halves).max(axis=2)
    owners = np.where(distances.min(axis=1) < _REACH, distances.argmin(axis=1), -1)
    pieces = []
    for owner in range(len(predicted)):
        own = points[owners == owner]
        if len(own):
            edges = np.concatenate([own.min(axis=0) - 0.5, own.max(axis=0) + 0.5])
            pieces.append(Piece(edges, float(len(own))))
    return pieces


def _trimmed(part: npt.NDArray[np.bool_], x: int, y: int) -> Array:
    """Edges of a blob without its thin rim."""
    by_column, by_row = part.sum(axis=0), part.sum(axis=1)
    columns = np.flatnonzero(by_column >= _TRIMMED * by_column.max())
    rows = np.flatnonzero(by_row >= _TRIMMED * by_row.max())
    return np.array([x + columns[0], y + rows[0], x + columns[-1] + 1, y + rows[-1] + 1], float)


def _joined(pieces: list[Piece]) -> Piece:
    """Join pieces of one vehicle; specks that happen to be in its prediction are none."""
    largest = max(piece.area for piece in pieces)
    pieces = [piece for piece in pieces if piece.area > _NOTABLE * largest]
    edges = np.array([piece.edges for piece in pieces])
    box = np.concatenate([edges[:, :2].min(axis=0), edges[:, 2:].max(axis=0)])
    return Piece(box, sum(piece.area for piece in pieces))

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

from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.overlaps import areas, intersections

Mask: TypeAlias = npt.NDArray[np.uint8]

_LEAST_AREA = 0.0003
"""Smallest area of a vehicle, of the image: 23 px in 320 x 240."""
_LEAST_PIECE = 4
"""Smallest area in px of a piece of a vehicle."""
_TRIMMED = 0.15
"""Rows and columns at the rim with less of the fullest one are cut off: reflections, shadows."""
_COVERED = 0.5
"""Share of a predicted vehicle in a blob from which on it may be a part of the blob."""
_ALONE = 0.65
"""Intersection over union with one prediction from which on a blob is that vehicle alone."""
_PIECE = 0.8
"""Share of a blob inside a prediction from which on it is a piece of that vehicle."""
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


@dataclass(frozen=True, slots=True)
class Piece:
    """Part of a vehicle: edges (4,) in px of the mask, and area in px."""

    edges: Array
    area: float


class BlobReader:
    """Makes boxes of masks; learns the usual aspect of vehicles."""

    def __init__(self) -> None:
        self._aspect = float(_ASPECT)

    def read(self, mask: Mask, predicted: Array) -> tuple[Array, Array]:
        """Find vehicles.

        Parameters
        ----------
        mask : (H, W) array
            Nonzero where something moves.
        predicted : (T, 4) array
            Edges of the vehicles that are followed, px of the mask.

        Returns
        -------
        edges : (N, 4) array
            px of the mask.
        fullness : (N,) array
            Share of each box that moves.
        """
        count, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
        least = max(_LEAST_AREA * mask.size, _LEAST_PIECE)
        found: list[Piece] = []
        pieces: dict[int, list[Piece]] = {}
        for index in range(1, count):
            x, y, width, height, area = stats[index].tolist()
            if area < _LEAST_PIECE:
                continue
            part = labels[y : y + height, x : x + width] == index
            box = np.array([x, y, x + width, y + height], dtype=np.float64)
            common = intersections(box, predicted)
            members = np.flatnonzero(common > _COVERED * areas(predicted))
            if self._is_divided(box, common, predicted, members):
                found += _divided(part, box, predicted[members])
                continue
            self._learn_aspect(box, mask.shape, len(members))
            piece = Piece(_trimmed(part, x, y), float(area))
            if len(common) and common.max() > _PIECE * areas(box):
                pieces.setdefault(int(common.argmax()), []).append(piece)
            else:
                found.append(piece)
        found += [_joined(own) for own in pieces.values()]
        found = [piece for piece in found if piece.area >= least]
        edges = np.array([piece.edges for piece in found]).reshape(-1, 4)
        area = np.array([piece.area for piece in found])
        return edges, area / areas(edges)

    def _is_divided(
        self, box: Array, common: Array, predicted: Array, members: npt.NDArray[np.intp]
    ) -> bool:
        """Test for several vehicles in a blob: none fits alone, and the aspects suggest it."""
        if len(members) < 2:
            return False
        union = areas(box) + areas(predicted) - common
        if (common / union).max() > _ALONE:
            return False
        apart = self._aspect_cost(predicted[members]).mean()
        return bool(apart < self._aspect_cost(box[np.newaxis])[0] + _SPLIT_MARGIN)

    def _aspect_cost(self, edges: Array) -> Array:
        return np.asarray(((_log_aspect(edges) - self._aspect) / _ASPECT_SPREAD) ** 2)

    def _learn_aspect(self, box: Array, shape: tuple[int, ...], members: int) -> None:
        sides = box[2:] - box[:2]
        free = box[:2].min() > 1 and box[2] < shape[1] - 1 and box[3] < shape[0] - 1
        if members == 1 and free and sides.min() > _ASPECT_SIDE:
            aspect = float(_log_aspect(box[np.newaxis])[0])
            self._aspect += _ASPECT_RATE * (aspect - self._aspect)


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
    edges = np.array([piece.edges for piece in pieces])
    box = np.concatenate([edges[:, :2].min(axis=0), edges[:, 2:].max(axis=0)])
    return Piece(box, sum(piece.area for piece in pieces))

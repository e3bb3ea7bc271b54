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
predictions of the vehicles that are followed tell, and the size that vehicles have there.
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
Pixels: TypeAlias = npt.NDArray[np.bool_]

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
_SIZE_SPREAD, _MOST_SIZE_COST = 0.2, 4.0
"""Standard deviation of the logarithm of a car's size, and most cost of another size: a lorry is
twice as large, and has to stay whole."""
_SPECK = np.log(0.4) / _SIZE_SPREAD
"""Deviation from the usual size below which a box is of leaves, captions or noise: a motorcycle has
two thirds of a car's size, and a car beside many lorries half of the usual one."""
_SIZES_NEEDED, _SIZE_MEMORY = 50, 0.998
"""Least boxes that a usual size is taken from: of one vehicle that has driven through; and weight
of those before each: some minutes."""
_SCALE, _SINGULAR = 400.0, 1e-4
"""Largest width of a mask in px; and least singular value, of the largest one's, that tells: while
all vehicles have driven on one line, the size beside it is taken to be the same."""


@dataclass(frozen=True, slots=True)
class Piece:
    """Part of a vehicle: edges (4,) in px of the mask, and area in px."""

    edges: Array
    area: float


class UsualSize:
    """Size of vehicles by where they stand: on a plane it is an affine function of the image."""

    def __init__(self) -> None:
        self._squares, self._sums, self._count = np.zeros((3, 3)), np.zeros(3), 0

    def learn(self, edges: Array) -> None:
        """Add the box (4,) of one vehicle; all count alike, near and far ones."""
        size, place = _size_and_place(edges)
        self._squares = _SIZE_MEMORY * self._squares + np.outer(place, place) / size**2
        self._sums = _SIZE_MEMORY * self._sums + place / size
        self._count += 1

    def deviation(self, edges: Array) -> float:
        """Logarithm of a box's size over the usual one, in its spread; 0 while none is known."""
        if self._count < _SIZES_NEEDED:
            return 0.0
        size, place = _size_and_place(edges)
        usual = float(place @ np.linalg.lstsq(self._squares, self._sums, rcond=_SINGULAR)[0])
        return float(np.log(size / max(usual, 1.0))) / _SIZE_SPREAD

    def cost(self, edges: Array) -> float:
        """Squared deviation of a box (4,), of a larger one not more than lorries cost."""
        apart = self.deviation(edges)
        return apart**2 if apart < 0 else min(apart**2, _MOST_SIZE_COST)


def _size_and_place(edges: Array) -> tuple[float, Array]:
    """Geometric mean of a box's sides, and the middle of its lower edge with a 1 beside it."""
    left, top, right, bottom = edges.tolist()
    place = np.array([(left + right) / 2 / _SCALE, bottom / _SCALE, 1.0])
    return float(np.sqrt((right - left) * (bottom - top))), place


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
        self._sizes = UsualSize()

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
            for piece in self._apart(part, *box[:2].astype(int).tolist()):
                self._learn_shape(piece, mask.shape, len(members))
                inside = intersections(piece.edges, predicted)
                if len(inside) and inside.max() > _PIECE * areas(piece.edges):
                    pieces.setdefault(int(inside.argmax()), []).append(piece)
                else:
                    found.append(piece)
        for own in pieces.values():
            found += self._grouped(own)
        found = [
            piece
            for piece in found
            if piece.area >= least
            and (
                self._sizes.deviation(piece.edges) > _SPECK or not _is_free(piece.edges, mask.shape)
            )
        ]
        edges = np.array([piece.edges for piece in found]).reshape(-1, 4)
        area = np.array([piece.area for piece in found])
        return edges, area / areas(edges)

    def _apart(self, part: Pixels, x: int, y: int) -> list[Piece]:
        """Divide a blob again and again, while its parts look more like vehicles than the whole."""
        whole = _piece(part, x, y)
        if whole.area < _SHAPED:
            return [whole]
        cuts = [_cut(part, axis) for axis in (0, 1)]
        pieces = [[_piece(half, x + u, y + v) for half, u, v in halves] for halves in cuts]
        best = min((0, 1), key=lambda axis: self._worst(pieces[axis]))
        if not self._are_several(pieces[best], whole):
            return [whole]
        return [piece for half, u, v in cuts[best] for piece in self._apart(half, x + u, y + v)]

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
        return self._worst(parts) + self._numbers.apart < self._shape_cost(whole)

    def _worst(self, parts: list[Piece]) -> float:
        return max(self._shape_cost(one) for one in parts)

    def _shape_cost(self, piece: Piece) -> float:
        """Squared standard deviations of aspect, fullness and size from the usual ones."""
        aspect = self._aspect_cost(piece.edges[np.newaxis])[0]
        fullness = np.log(piece.area / areas(piece.edges)) - self._fullness
        return float(aspect + (fullness / _FULLNESS_SPREAD) ** 2 + self._sizes.cost(piece.edges))

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
        if members == 1 and _is_free(box, shape) and sides.min() > _ASPECT_SIDE:
            aspect = float(_log_aspect(box[np.newaxis])[0])
            self._aspect += _ASPECT_RATE * (aspect - self._aspect)
            self._sizes.learn(box)
            fullness = float(np.log(piece.area / areas(box)))
            self._fullness += _ASPECT_RATE * (fullness - self._fullness)


def _piece(part: Pixels, x: int, y: int) -> Piece:
    """Make a piece of the pixels of a mask whose corner is at (x, y)."""
    return Piece(_trimmed(part, x, y), float(part.sum()))


def _components(mask: Mask) -> Iterator[tuple[Pixels, Array]]:
    """Divide a mask into what hangs together: pixels within a box (4,), and this box."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    for index in range(1, count):
        x, y, width, height, area = stats[index].tolist()
        if area >= _LEAST_PIECE:
            part = labels[y : y + height, x : x + width] == index
            yield part, np.array([x, y, x + width, y + height], dtype=np.float64)


def _cut(part: Pixels, axis: int) -> list[tuple[Pixels, int, int]]:
    """Cut a blob between two rows, or columns, where the boxes of its parts have the least area.

    Each part comes with its left and upper end in the blob, whose borders all have pixels.
    """
    lines = part if axis == 0 else part.T
    full, length = lines.any(axis=1), lines.shape[1]
    low = np.where(full, lines.argmax(axis=1), length)
    high = np.where(full, length - lines[:, ::-1].argmax(axis=1), 0)
    before = np.maximum.accumulate(high) - np.minimum.accumulate(low)
    behind = (np.maximum.accumulate(high[::-1]) - np.minimum.accumulate(low[::-1]))[::-1]
    counts = np.arange(1, len(lines))
    sums = before[:-1] * counts + behind[1:] * (len(lines) - counts)
    first = np.indices(part.shape)[axis] <= (sums.argmin() if len(sums) else 0)
    halves = []
    for half in (part & first, part & ~first):
        u, v, width, height = cv2.boundingRect(half.astype(np.uint8))
        halves.append((half[v : v + height, u : u + width], u, v))
    return halves


def _is_free(edges: Array, shape: tuple[int, ...]) -> bool:
    """Tell whether no border of the image cuts a box."""
    height, width = shape
    return bool(edges[:2].min() > 1 and edges[2] < width - 1 and edges[3] < height - 1)


def _log_aspect(edges: Array) -> Array:
    sides = np.maximum(edges[:, 2:] - edges[:, :2], 1.0)
    return np.asarray(np.log(sides[:, 1] / sides[:, 0]))


def _divided(part: Pixels, box: Array, predicted: Array) -> list[Piece]:
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


def _trimmed(part: Pixels, x: int, y: int) -> Array:
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

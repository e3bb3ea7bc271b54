# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes of vehicles from a mask of what moves.

What touches in the mask need not be one vehicle: the size that vehicles have there tells. One
vehicle need not be of one piece: the predictions of the vehicles that are followed tell. These do
not divide blobs: a vehicle that was born as two halves would stay two.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.detection.motion_thresholds import SHIPPED_THRESHOLDS, MotionThresholds
from vehicle_pf_tracker.detection.pieces import Piece
from vehicle_pf_tracker.detection.usual_size import MEMORY, SIZES_NEEDED, SPREAD, UsualSize
from vehicle_pf_tracker.image.motion.mask_parts import connected_parts

Mask: TypeAlias = npt.NDArray[np.uint8]

_LEAST_AREA = 0.0003
"""Smallest area of a vehicle, of the image, a choice: 23 px in 320 x 240, about five by five."""
_LEAST_PIECE = 4
"""Smallest area in px of a piece of a vehicle: two by two, fewer have no shape."""
_USUAL_FULLNESS = 0.8
"""Share of its box that a vehicle usually fills, to start from. A choice: it is learnt soon."""
_ASPECT_SPREAD = 0.3
"""Standard deviation of the logarithm of height over width. A choice: front and side of a car, .8
and .5, are one and a half apart."""
_FROM_AHEAD = 0.8
"""Usual height over width, to start from, of vehicles that drive towards or away from the camera:
that of cars from the front."""
_FROM_THE_SIDE = 0.5
"""Usual height over width, to start from, of vehicles that drive across the image: that of cars
from the side."""
_ACROSS = 6
"""Power of the share of their motion across by which they are seen from the side: of 76 clips only
a steep one fits."""
_FULLNESS_SPREAD = 0.2
"""Standard deviation of the logarithm of the share of its box that a vehicle fills. A choice: cars
are alike within a fifth."""
_MEMBER = 0.5
"""Share of a predicted vehicle inside a blob's box above which the blob is of it: most of it."""
_LEAST_PART = 0.15
"""Smallest share of a blob's area that may be a vehicle of its own, and least pixels, of the
fullest row's, of a row that belongs to a vehicle. Chosen on *highway* and its bridge."""
_LEAST_SHARE = 0.1
"""Area of a piece, of the largest one's, below which it is a speck that happens to be in the same
prediction. A choice below `_LEAST_PART`, from which a piece may be a vehicle."""
_PIECE = 0.8
"""Share of a blob inside a prediction above which it is a piece of that vehicle: nearly all of it.
Chosen with `_LEAST_PART`."""
_ASPECT_SIDE = 10
"""Least side in px of a blob whose aspect is learnt; one of less area has no shape."""
_SPECK = math.log(0.4) / SPREAD
"""Deviation from the usual size below which a box is of leaves, captions or noise: a motorcycle has
two thirds of a car's size, and a car beside many lorries half of the usual one."""
_RATE = 1 / SIZES_NEEDED
"""Rate at which the usual shape follows blobs of one vehicle each: over as many as a size takes."""


class Blobs(NamedTuple):
    """Vehicles in one mask.

    Attributes
    ----------
    edges : (N, 4) array
        Edges of their boxes, px of the mask.
    fullness : (N,) array
        Share of each box that moves.
    ambiguous : int
        Number of blobs that hold several vehicles which are followed, or that their shape alone
        has divided.
    joined : (J, 5) array or None
        Edges, px of the mask, of each blob of several vehicles by its size, and how many of them
        no vehicle that is followed stands for; None while it is not known how large vehicles are.
    """

    edges: Array
    fullness: Array
    ambiguous: int
    joined: Array | None


class BlobReader:
    """Makes boxes of masks; learns the usual shape of vehicles.

    Parameters
    ----------
    thresholds : MotionThresholds
        Thresholds.
    """

    def __init__(self, thresholds: MotionThresholds = SHIPPED_THRESHOLDS) -> None:
        self._thresholds = thresholds
        self._fullness = math.log(_USUAL_FULLNESS)
        self._aspect = self._learnt_aspect = 0.0
        self._unlearnt = 1.0
        self._motion = np.zeros(2)
        self._sizes = UsualSize()

    def read(self, mask: Mask, predicted: Array, velocities: Array) -> Blobs:
        """Find vehicles.

        Parameters
        ----------
        mask : (H, W) array
            1 where something moves, else 0.
        predicted : (T, 4) array
            Edges of the vehicles that are followed, px of the mask.
        velocities : (V, 2) array
            Velocities of all that may be vehicles, px per frame.
        """
        self._sizes.settle()  # 1. expect what was learnt before this image
        self._expect_aspect(velocities)
        least = max(_LEAST_AREA * mask.size, _LEAST_PIECE)
        found: list[Piece] = []
        pieces: dict[int, list[Piece]] = {}
        room = areas(predicted)
        ambiguous = 0
        joined: list[tuple[float, ...]] = []
        # 2. Divide each blob by shape; learn from those that are of one vehicle.
        for part, box in _components(mask):
            members = int(np.count_nonzero(intersections(box, predicted) > _MEMBER * room))
            x, y = box[:2].astype(int).tolist()
            whole = _piece(part, x, y)
            parts = self._apart(part, whole, x, y)
            ambiguous += members > 1 or len(parts) > 1
            if (unresolved := self._sizes.vehicles_in(whole) - members) > 0:
                joined.append((*whole[:4], unresolved))
            for piece in parts:
                self._learn_shape(piece, mask.shape, members)
                inside = intersections(piece.edges, predicted)
                if len(inside) and inside.max() > _PIECE * math.prod(piece.sides):
                    pieces.setdefault(int(inside.argmax()), []).append(piece)
                else:
                    found.append(piece)
        for own in pieces.values():  # 3. join by predictions
            found += self._grouped(own)
        # 4. Drop specks last: pieces may be as small until they are joined.
        boxes = np.array([one for one in found if self._is_vehicle(one, least, mask.shape)])
        boxes = boxes.reshape(-1, len(Piece._fields))
        crowds = np.array(joined).reshape(-1, 5) if self._sizes.is_roughly_known else None
        return Blobs(boxes[:, :4], boxes[:, 4] / areas(boxes[:, :4]), ambiguous, crowds)

    def _expect_aspect(self, velocities: Array) -> None:
        """Find the usual aspect: until it is learnt, the motion decides which side is seen."""
        motion = np.abs(velocities[:, 0]).sum(), np.hypot(*velocities.T).sum()
        self._motion = MEMORY * self._motion + motion
        # After hours without a vehicle nothing is left of either.
        across = float(self._motion[0] / max(self._motion[1], 1e-9)) ** _ACROSS
        first = _FROM_AHEAD + across * (_FROM_THE_SIDE - _FROM_AHEAD)
        self._aspect = self._learnt_aspect + self._unlearnt * math.log(first)

    def _is_vehicle(self, piece: Piece, least: float, shape: tuple[int, ...]) -> bool:
        """Test whether a piece is large enough; one that the border cuts may be smaller."""
        if piece.area < least:
            return False
        return self._sizes.deviation(piece) > _SPECK or not piece.is_free(shape)

    def _apart(self, part: Mask, whole: Piece, x: int, y: int) -> list[Piece]:
        """Divide a blob again and again, while its parts look more like vehicles than the whole."""
        if whole.area < _ASPECT_SIDE**2 or self._shape_cost(whole) <= self._thresholds.apart:
            return [whole]
        cuts = [_cut(part, axis) for axis in (0, 1) if part.shape[axis] > 1]
        pieces = [[_piece(half, x + u, y + v) for half, u, v in halves] for halves in cuts]
        # The cut whose worse half is best: a good car beside a sliver is no cut.
        best = min(range(len(cuts)), key=lambda axis: self._worst(pieces[axis]))
        if not self._are_several(pieces[best], whole):
            return [whole]
        return [
            smaller
            for (half, u, v), piece in zip(cuts[best], pieces[best], strict=True)
            for smaller in self._apart(half, piece, x + u, y + v)
        ]

    def _grouped(self, pieces: list[Piece]) -> list[Piece]:
        """Join the pieces in one prediction, unless they look like vehicles of their own."""
        joined = _joined(pieces)
        notable = [one for one in pieces if one.area > _LEAST_PART * joined.area]
        if len(notable) > 1 and self._are_several(notable, joined):
            return notable
        return [joined]

    def _are_several(self, parts: list[Piece], whole: Piece) -> bool:
        """Test whether parts of a blob look more like vehicles than the whole does."""
        smallest = min(one.area for one in parts)  # a sliver is no vehicle
        if smallest < _LEAST_PART * whole.area or whole.area < _ASPECT_SIDE**2:
            return False
        return self._worst(parts) + self._thresholds.apart < self._shape_cost(whole)

    def _worst(self, parts: list[Piece]) -> float:
        return max(self._shape_cost(one) for one in parts)  # every part has to look like a vehicle

    def _shape_cost(self, piece: Piece) -> float:
        """Squared standard deviations of aspect, fullness and size from the usual ones."""
        aspect = (piece.log_aspect - self._aspect) / _ASPECT_SPREAD
        fullness = (piece.log_fullness - self._fullness) / _FULLNESS_SPREAD
        return aspect**2 + fullness**2 + self._sizes.cost(piece)

    def _learn_shape(self, piece: Piece, shape: tuple[int, ...], members: int) -> None:
        # Of one vehicle by the predictions, not by its shape, which would confirm itself.
        if members == 1 and piece.is_free(shape) and min(piece.sides) > _ASPECT_SIDE:
            self._learnt_aspect += _RATE * (piece.log_aspect - self._learnt_aspect)
            self._unlearnt *= 1 - _RATE  # weight of the first guess
            self._sizes.learn(piece)  # whole ones only
            self._fullness += _RATE * (piece.log_fullness - self._fullness)


def _components(mask: Mask) -> Iterator[tuple[Mask, Array]]:
    """Divide a mask into what hangs together: pixels within a box (4,), and this box."""
    labels, stats = connected_parts(mask)
    for index in range(1, len(stats)):
        x, y, width, height, area = stats[index].tolist()
        if area >= _LEAST_PIECE:
            part = labels[y : y + height, x : x + width] == index
            yield part.view(np.uint8), np.array([x, y, x + width, y + height], dtype=np.float64)


def _piece(part: Mask, x: int, y: int) -> Piece:
    """Make a piece of the pixels of a mask whose corner is at (x, y), without its thin rim.

    Reflections and shadows make rows and columns with few pixels.
    """
    edges = []
    for axis in (0, 1):
        sums = cv2.reduce(part, axis, cv2.REDUCE_SUM, dtype=cv2.CV_32S).ravel()
        kept = sums >= _LEAST_PART * sums.max()
        edges.append((int(kept.argmax()), len(kept) - int(kept[::-1].argmax())))
    (left, right), (top, bottom) = edges
    return Piece(x + left, y + top, x + right, y + bottom, cv2.countNonZero(part))


def _cut(part: Mask, axis: int) -> list[tuple[Mask, int, int]]:
    """Cut a blob between two rows, or columns, where the boxes of its parts have the least area.

    Each part comes with its left and upper end in the blob, whose borders all have pixels.
    """
    lines = np.ascontiguousarray(part if axis == 0 else part.T).view(np.bool_)
    count, length = lines.shape
    low = lines.argmax(axis=1)
    high = length - lines[:, ::-1].argmax(axis=1)
    # A row without pixels extends nothing.
    empty = ~lines[np.arange(count), low]
    low[empty] = length  # neutral in minima, and 0 in maxima
    high[empty] = 0
    before = np.maximum.accumulate(high) - np.minimum.accumulate(low)
    behind = (np.maximum.accumulate(high[::-1]) - np.minimum.accumulate(low[::-1]))[::-1]
    counts = np.arange(1, count)  # with the widths above, areas of the boxes
    first = int((before[:-1] * counts + behind[1:] * (count - counts)).argmin()) + 1
    halves = []
    for start, end in ((0, first), (first, count)):
        half = part[start:end] if axis == 0 else part[:, start:end]
        u, v, width, height = cv2.boundingRect(np.ascontiguousarray(half))
        cropped = half[v : v + height, u : u + width]
        halves.append((cropped, u + start * axis, v + start * (1 - axis)))
    return halves


def _joined(pieces: list[Piece]) -> Piece:
    """Join pieces of one vehicle; specks that happen to be in its prediction are none."""
    largest = max(piece.area for piece in pieces)
    left, top, right, bottom, area = zip(
        *(piece for piece in pieces if piece.area > _LEAST_SHARE * largest), strict=True
    )
    return Piece(min(left), min(top), max(right), max(bottom), sum(area))

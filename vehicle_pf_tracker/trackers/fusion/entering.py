# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A first box that the image's border cuts: how much of the vehicle comes in behind it.

Detectors find a vehicle while it drives into the image, and the first box holds a part of it. The
filter responds to that part for as long as it is in view, so that the box stays on it. The rest of
the vehicle moves with the box, and not with the road. To find it, an image is compared with an
earlier and a later one, aligned once with the box and once with the background. The earlier one
alone would not do: a smooth road matches itself, and road that the vehicle has just left would
count as a part of it. Colours are compared, since a red car may be as bright as the road.

The box is extended, and the filter retrained, each time that half as much again has come in, and
once road is seen behind the vehicle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import small_colour
from vehicle_pf_tracker.trackers.fusion.moments import Moment, Moments, is_due, moved
from vehicle_pf_tracker.trackers.fusion.sides import moved_box

_NEAR_BORDER = 0.1
"""Distance from the image's border, fraction of the box's longer side, up to which it may have cut
a side, a choice: detectors are good to about that."""
_CELLS = 16
"""Cells per side of the box along which it is searched, and across: of a box of 30 px they are two
px of the frame. A choice."""
_INSIDE = _CELLS // 2
"""Cells inside the box, from its middle on, that others are measured by."""
_SEARCHED = 3
"""How far beyond the cut side the vehicle is searched, sides of the box, a choice: the box grows
while more comes in."""
_MIDDLE = 0.7
"""Part of the box across that is compared, fraction of it, a choice: beside corners is road."""
_LARGEST = 30.0
"""Largest evidence of a cell, levels of a colour, a choice: one reflection must not outweigh a
side."""
_CLEAR = 1.0
"""Least evidence above the noise of an image, levels of a colour."""
_LEVEL = 0.5
"""Evidence of the vehicle's last cell, fraction of the mean up to it: half. A shadow has less."""
_SHADOW = 0.15
"""Length beyond the vehicle that moves with it, fraction of the box: shadow, and half a cell.
Chosen on six vehicles of two clips, whose ends were found .1 to .4 too far."""
_ROAD = 0.4
"""Length of road that ends a vehicle, fraction of the box's longer side, a choice: a plain
bonnet is shorter."""
_STANDS = 3.0
"""Evidence against the vehicle, levels of a colour, from which a cell counts twice, and the most
that one comparison gives, a choice: a plain flank gives none, road with a kerb stands."""
_LOOKS = 2
"""Times that a cell has to be compared for the box to move, a choice: once for the reported one."""
_COME_IN = 0.5
"""Part that has come in from which it is followed too, fraction of the box, a choice: the
filter is trained anew each time."""
_LEAST_CUT = 0.1
"""The same once all of it has come in, a choice: less is within the error of a first box."""

_Mask = npt.NDArray[np.bool_]
_Levels = npt.NDArray[np.float32]


class Entry(NamedTuple):
    """Evidence of a vehicle beyond the sides at which the border cuts its first box.

    Attributes
    ----------
    is_cut : (2, 2) array of bool
        Sides that the border may have cut, by [low or high, axis].
    image_size : (2,) array
        Width and height of the images, px.
    moments : tuple of Moment
        Last images that were compared, oldest first.
    evidence, looks : (2, 2, cells) arrays
        By side and cell, from the middle of the box outwards: summed excess of the difference that
        standing leaves over that which moving leaves, levels of a colour; and the number of
        comparisons.
    """

    is_cut: _Mask
    image_size: Array
    moments: Moments = ()
    evidence: Array = np.zeros((2, 2, _INSIDE + _SEARCHED * _CELLS))
    looks: Array = np.zeros((2, 2, _INSIDE + _SEARCHED * _CELLS))

    @classmethod
    def of_box(cls, position: Array, size: Array, image_size: Array) -> Entry | None:
        """Begin with a first box; None where the border cuts none of its sides. All px."""
        low = position - size / 2
        high = position + size / 2
        is_cut = np.array([low, image_size - high]) < _NEAR_BORDER * size.max()
        return cls(is_cut, image_size) if is_cut.any() else None

    def moved(self, camera: CameraMotion) -> Entry:
        """Note that the camera has moved."""
        return self if camera.still else self._replace(moments=moved(self.moments, camera))

    def lost(self) -> Entry:
        """Discard the images: the next one will not follow on them."""
        return self._replace(moments=())

    def looked(self, frame: Frame, position: Array, size: Array) -> Entry:
        """Look at a frame in which the box has this centre and size, px."""
        if not is_due(self.moments, position, size):
            return self
        moments = (*self.moments, Moment.of_frame(small_colour(frame), position, size))[-3:]
        if len(moments) < 3:
            return self._replace(moments=moments)
        evidence = self.evidence.copy()
        looks = self.looks.copy()
        for end, axis in np.argwhere(self.is_cut).tolist():
            found, seen = _compared(moments, end, axis)
            evidence[end, axis] += found
            looks[end, axis] += seen
        return self._replace(moments=moments, evidence=evidence, looks=looks)

    def box(self, position: Array, size: Array) -> tuple[Array, Array]:
        """Centre and size, px, of what is in view of the vehicle whose box has these.

        It reaches to the border until road is seen behind it.
        """
        beyond = np.zeros((2, 2))
        to_border = np.array([position, self.image_size - position]) / size - 0.5
        for end, axis in np.argwhere(self.is_cut).tolist():
            length, road = self._end(end, axis, size, looks=1)
            reaches = length > 0 and road < 0.5
            beyond[end, axis] = max(to_border[end, axis], 0.0) if reaches else length
        return moved_box(position, size, beyond)

    def grown(self, position: Array, size: Array) -> tuple[Array, Array] | None:
        """Centre and size, px, to move the box to; None while too little has come in."""
        beyond, is_whole = self._beyond(size)
        if beyond.max() < (_LEAST_CUT if is_whole else _COME_IN):
            return None
        return moved_box(position, size, beyond)

    def remaining(self, size: Array) -> Entry | None:
        """Go on looking with a new box; None once the end of the vehicle is seen."""
        _, is_whole = self._beyond(size)
        return None if is_whole else Entry(self.is_cut, self.image_size)

    def _beyond(self, size: Array) -> tuple[Array, bool]:
        """How far the vehicle reaches beyond the sides of the box, fractions of its size.

        By [low or high, axis], as far as it has come in; and whether all of it has.
        """
        beyond = np.zeros((2, 2))
        is_whole = True
        for end, axis in np.argwhere(self.is_cut).tolist():
            beyond[end, axis], road = self._end(end, axis, size, looks=_LOOKS)
            is_whole &= road >= 1
        return beyond, is_whole

    def _end(self, end: int, axis: int, size: Array, looks: int) -> tuple[float, float]:
        """Where the vehicle ends beyond a side of a box of this size; see `_end_of`.

        By the cells that were compared so many times.
        """
        counts = self.looks[end, axis]
        known = counts >= looks
        first = len(known) if known.all() else int(known.argmin())
        if first < _INSIDE:
            return 0.0, 0.0
        road = _ROAD * float(size.max() / size[axis]) * _CELLS
        return _end_of((self.evidence[end, axis, :first] / counts[:first]).tolist(), road)


def _compared(moments: Moments, end: int, axis: int) -> tuple[Array, Array]:
    """Evidence for the cells beyond a side, and which of them are in view, by three images."""
    earlier, middle, later = moments
    present, in_view = _cells(middle, middle.position, middle.size, end, axis)
    moved = np.zeros(present.shape[:2], np.float32)
    stood = np.full(present.shape[:2], np.inf, np.float32)
    compared = np.zeros(len(present), bool)
    for other in (earlier, later):
        cells, seen = _cells(other, other.position, other.size, end, axis)
        # What drives in is not yet in view in the earlier image, and what drives out no more in the
        # later one.
        difference = np.where(seen[:, None], _apart(present, cells), 0)
        moved = np.maximum(moved, difference)
        compared |= seen
        # Where the middle's background was, or will be, in the other image.
        centre = middle.background_in(other, middle.position)
        cells, _ = _cells(other, centre, middle.size, end, axis)
        stood = np.minimum(stood, _apart(present, cells))
    seen = in_view & compared
    excess = np.clip(stood - moved, -_LARGEST, _LARGEST).mean(axis=1)
    # What stands in front, as a clock in the image, must not outweigh what is seen once it is past.
    evidence = np.maximum(excess, -_STANDS)
    return np.where(seen, evidence, 0.0), seen.astype(float)


def _apart(some: _Levels, other: _Levels) -> _Levels:
    """Difference of the colours of cells (n, m, 3), mean of the three."""
    return np.asarray(np.abs(some - other).mean(axis=2))


def _cells(
    moment: Moment, position: Array, size: Array, end: int, axis: int
) -> tuple[_Levels, _Mask]:
    """Colours of the cells (n, m, 3) from a box's middle outwards, and which rows are in view."""
    outwards = (2 * end - 1) * size[axis] / _CELLS
    across = _MIDDLE * size[1 - axis] / _CELLS
    count = _INSIDE + _SEARCHED * _CELLS
    along = position[axis] + outwards * (np.arange(count) + 0.5)
    first = np.empty(2)
    first[axis] = along[0]
    first[1 - axis] = position[1 - axis] - across * (_CELLS - 1) / 2
    step = np.empty(2)
    step[axis] = outwards
    step[1 - axis] = across
    if axis == 0:
        cells = np.swapaxes(moment.cells(first, step, (count, _CELLS)), 0, 1)
    else:
        cells = moment.cells(first, step, (_CELLS, count))
    zoom = moment.zoom[axis]
    length = moment.image.shape[1 - axis] / zoom
    margin = 1 / zoom  # the outermost px is often black
    in_view = (along > margin) & (along < length - margin)
    return np.asarray(cells, np.float32), in_view


def _end_of(evidence: list[float], road: float) -> tuple[float, float]:
    """Where the vehicle ends, fractions of the box beyond its side, and the road that is seen.

    That is the share of the length that ends the vehicle: from 1 on its end is seen. Both are 0
    where the mean evidence up to no cell is clear: the box may not be on what moves.

    Parameters
    ----------
    evidence : list of float
        Mean evidence of the cells that are known, from the middle of the box outwards.
    road : float
        Cells of road that end it.
    """
    total = sum(evidence[:_INSIDE])
    moves = total >= _CLEAR * _INSIDE
    last = _INSIDE - 1
    plain = 0
    for cell in range(_INSIDE, len(evidence)):
        each = evidence[cell]
        total += each
        plain = 0 if each >= _CLEAR else plain + (1 if each > -_STANDS else 2)
        if plain >= road:
            break
        if total < _CLEAR * (cell + 1):
            continue
        moves = True
        if each >= _LEVEL * total / (cell + 1):
            last = cell
    if not moves:
        return 0.0, 0.0
    length = max((last + 1 - _INSIDE) / _CELLS - _SHADOW, 0.0)
    return length, plain / road

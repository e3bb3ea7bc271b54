# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The one thing in the vehicle's paint that moves, before a camera that moves.

A vehicle that was lost as it showed another side or came near is in full view, and the filter does
not know it. Once the prediction is worth nothing any more, what drives on by itself in its paint is
the vehicle, if nothing else in that paint did when it was lost. It is followed until the filter,
begun anew on it, agrees with what moves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.outline_boxes import areas
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import KEPT_FRAMES

JOINED = 0.25
"""Largest gap between parts of one thing, fraction of the vehicle's size, a choice: windows of the
road's grey part a car."""
LEAST_MOVING = 0.1
"""Least area that moves of such a thing, fraction of the vehicle's, a choice: less is noise."""
_AREAS = 0.15, 9.0
"""Bounds of the area of its box, fractions of the vehicle's: lost as it comes near, it is up to
three times as long and as high soon (car16_2, on which it was chosen)."""
_OWN = 1.5
"""Distance of a thing's middle from the vehicle's, in sizes along an axis, within which it may be
the vehicle itself, off which the box has slid; the next lane is farther. Chosen on Suv, where a
grey car beside a grey car is taken with no such test."""
_WATCHED = PROOF_FRAMES
"""Frames from the loss on in which others in its paint are looked for: as many as prove one."""
_WAITS = KEPT_FRAMES
"""Periods before it is looked for: until then the vehicle is expected where its sightings tell. At
once, two of three are strangers where lorries hide a vehicle in the traffic of S1301."""
_DRIVEN = 1.0
"""Least way against the background, in its own sizes: parallax moves poles by less. A choice."""
_PAINTED = 3
"""Frames in a row in which its paint has to be the vehicle's: a tenth of a second, a choice."""
_CHANGE = 2.5
"""Largest factor of the area of its box from frame to frame, a choice: more is a merged one."""
_AGREES = 0.6
"""Overlap of the tracked box with what moves, below which the filter is begun anew on that. Between
shadow and gaps outlines of the vehicle overlap its box by .5 to .8."""
_INSIDE = 0.8
"""Share of what moves that is in the tracked box, above which it may be a part of the vehicle: a
plain one that is slow is cut by where it was before. A choice."""

Sides = Array
"""Low and high corner, (2, 2), px."""
PaintDifference = Callable[[Array, Array], float]
"""Function of a box's centre and size (2,), px: difference of its paint from the vehicle's."""


class Mover(NamedTuple):
    """A thing that moves.

    Attributes
    ----------
    sides : (2, 2) array
        Low and high corner of its box, px.
    start : (2,) array
        Where its middle was first, carried along with the background, px.
    frames : int
        Frames in which it was seen.
    is_missed : bool
        True where it was not seen in the last frame.
    enters : bool
        True for one that was first seen at the border.
    paint : tuple of float
        Differences of its paint from the vehicle's in the last frames in which its motion was
        proven.
    """

    sides: Sides
    start: Array
    frames: int = 1
    is_missed: bool = False
    enters: bool = False
    paint: tuple[float, ...] = ()

    def moved(self, camera: CameraMotion) -> Mover:
        """Carry it along with the background."""
        start = camera.apply(self.start)
        return self._replace(sides=camera.apply(self.sides), start=start)

    def next(self, boxes: Array) -> int | None:
        """Find its box (2, 2) among those of the present frame: the one that overlaps it most."""
        if not len(boxes):
            return None
        low = np.maximum(boxes[:, 0], self.sides[0])
        high = np.minimum(boxes[:, 1], self.sides[1])
        shared = np.maximum(high - low, 0.0).prod(axis=1)
        best = int(shared.argmax())
        factor = areas(boxes[best : best + 1])[0] / areas(self.sides[np.newaxis])[0]
        return best if shared[best] and 1 / _CHANGE < factor < _CHANGE else None

    def seen(self, sides: Sides, *, is_missed: bool) -> Mover:
        """See it in the present frame; `is_missed` where only a part of it."""
        return self._replace(sides=sides, frames=self.frames + 1, is_missed=is_missed)

    @property
    def has_driven(self) -> bool:
        """True for one whose motion is proven."""
        way = np.hypot(*(self.sides.mean(axis=0) - self.start))
        extent = np.sqrt((self.sides[1] - self.sides[0]).prod())
        return self.frames >= PROOF_FRAMES and bool(way >= _DRIVEN * extent)

    @property
    def has_paint(self) -> bool:
        """True if its paint is the vehicle's, in the mean and now."""
        # 1 is the limit of `Paint.difference`.
        last = self.paint[-_PAINTED:]
        return len(last) == _PAINTED and last[-1] < 1 and bool(np.mean(last) < 1)


class LoneMover(NamedTuple):
    """Search for a vehicle that was lost before a moving camera.

    Attributes
    ----------
    waited : float
        Periods since it was lost.
    frames : int
        Frames since then.
    was_alone : bool
        True while nothing else in its paint was seen to move as it was lost.
    movers : tuple of Mover
        Things that move.
    followed : Mover or None
        The one that was taken for the vehicle, until the filter agrees.
    agreed : int
        Frames in a row in which it did.
    """

    waited: float = 0.0
    frames: int = 0
    was_alone: bool = True
    movers: tuple[Mover, ...] = ()
    followed: Mover | None = None
    agreed: int = 0

    def moved(self, camera: CameraMotion) -> LoneMover:
        """Carry all along with the background."""
        if camera.still or not (self.movers or self.followed):
            return self
        movers = tuple(each.moved(camera) for each in self.movers)
        return self._replace(movers=movers, followed=self.followed and self.followed.moved(camera))

    def passed(self, elapsed: float) -> LoneMover:
        """Let a frame pass in which the vehicle is lost."""
        return self._replace(waited=self.waited + elapsed, frames=self.frames + 1)

    @property
    def is_due(self) -> bool:
        """True where what moves has to be looked at."""
        return self.was_alone and (self.frames <= _WATCHED or self.waited >= _WAITS)

    def observed(
        self,
        boxes: Array,
        vehicle: tuple[Array, Array],
        image_size: Array,
        difference: PaintDifference,
    ) -> LoneMover:
        """Take what moves now.

        Parameters
        ----------
        boxes : (N, 2, 2) array
            Low and high corner of each thing, px.
        vehicle : pair of (2,) arrays
            Predicted centre and size of the vehicle, px.
        image_size : (2,) array
            Width and height of the frame, px.
        difference : callable
            Difference of the paint in a box from the vehicle's.
        """
        if self.waited < _WAITS:
            others = boxes[_fits(boxes, vehicle[1]) & np.logical_not(_is_near(boxes, vehicle))]
            alone = all(difference(*_box(sides)) >= 1 for sides in others)
            return self._replace(was_alone=alone)
        cut = _is_cut(boxes, image_size)
        movers: list[Mover] = []
        taken = set[int]()
        for before in self.movers:
            place = before.next(boxes)
            if place is not None and place not in taken:
                taken.add(place)
                mover = before.seen(boxes[place], is_missed=bool(cut[place]))
                movers.append(_painted(mover, vehicle[1], difference))
            elif not before.is_missed:  # outlines flicker
                movers.append(before._replace(is_missed=True))
        new = (place for place in range(len(boxes)) if place not in taken)
        movers += (
            Mover(boxes[place], boxes[place].mean(axis=0), enters=bool(cut[place])) for place in new
        )
        return self._replace(movers=tuple(movers))

    def found(self) -> Mover | None:
        """Return the one thing that is proven to be the vehicle."""
        proven = [each for each in self.movers if not each.is_missed and each.has_paint]
        return proven[0] if len(proven) == 1 else None

    def compared(self, boxes: Array, vehicle: tuple[Array, Array] | None) -> LoneMover:
        """Compare the tracked box, centre and size, px, with what moves; None where it is lost.

        Afterwards `agreed` is 0 where the filter has to be begun anew, on `followed`, which is None
        once the filter has agreed for long, or nothing is left to follow.
        """
        mover = self.followed
        best = mover and mover.next(boxes)
        if mover is None or best is None:
            return LoneMover()
        mover = mover._replace(sides=boxes[best])
        if vehicle is None or not _agrees(mover.sides, vehicle):
            return LoneMover(followed=mover)
        agreed = self.agreed + 1
        return LoneMover() if agreed >= PROOF_FRAMES else LoneMover(followed=mover, agreed=agreed)


def _painted(mover: Mover, size: Array, difference: PaintDifference) -> Mover:
    """Compare the paint of one that is proven to drive, and has a size that fits."""
    if mover.is_missed or mover.enters or not mover.has_driven:
        return mover
    if not _fits(mover.sides[np.newaxis], size)[0]:
        return mover
    paint = (*mover.paint, difference(*_box(mover.sides)))
    return mover._replace(paint=paint[-_PAINTED:])


def _box(sides: Sides) -> tuple[Array, Array]:
    """Centre and size, px."""
    return sides.mean(axis=0), sides[1] - sides[0]


def _fits(boxes: Array, size: Array) -> npt.NDArray[np.bool_]:
    """Test which boxes have an area that the vehicle may have."""
    shares = areas(boxes) / size.prod()
    fits: npt.NDArray[np.bool_] = (shares > _AREAS[0]) & (shares < _AREAS[1])
    return fits


def _is_near(boxes: Array, vehicle: tuple[Array, Array]) -> npt.NDArray[np.bool_]:
    """Test which boxes have their middles about the vehicle's."""
    position, size = vehicle
    off = np.abs(boxes.mean(axis=1) - position)
    return np.asarray((off < _OWN * size).all(axis=1), np.bool_)


def _is_cut(boxes: Array, image_size: Array) -> npt.NDArray[np.bool_]:
    """Test which boxes reach the border: neither their sizes nor their paints are known."""
    outside = ((boxes <= 0) | (boxes >= image_size)).reshape(len(boxes), 4)
    return np.asarray(outside.any(axis=1), np.bool_)


def _agrees(sides: Sides, vehicle: tuple[Array, Array]) -> bool:
    """Test whether what moves agrees with a box of this centre and size, px."""
    position, size = vehicle
    low = np.maximum(sides[0], position - size / 2)
    high = np.minimum(sides[1], position + size / 2)
    shared = float(np.maximum(high - low, 0.0).prod())
    moving = float((sides[1] - sides[0]).prod())
    union = moving + float(size.prod()) - shared
    return shared >= min(_AGREES * union, _INSIDE * moving)

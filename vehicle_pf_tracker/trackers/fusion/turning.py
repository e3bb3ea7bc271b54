# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The turning branch: a vehicle in doubt that leaves its path is followed by its outline.

In a fast turn response and points end as they do behind an occluder, and the track is frozen and
predicted straight on. Beside it the outline of what moves is followed. Where an occluder stands the
outline is cut from one side, and where one drives by it becomes larger at once; only a vehicle that
turns moves as a whole to one side of the predicted path.

One that was hidden as a whole is followed the same way where it comes out beside its path
(`emergence.py`). Outlines are found before a standing camera.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.foreground import Foreground, Outline
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.behind import BEHIND
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.hidden_way import HiddenWay
from vehicle_pf_tracker.trackers.fusion.hypotheses import corrected_velocities
from vehicle_pf_tracker.trackers.fusion.outline_boxes import MOST_AREA
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sighting,
)

_ASIDE = 0.15
"""Least distance of both sides from the predicted path in a turn, fraction of the size: an outline
is good to 1 or 2 px, a tenth of a vehicle of 20 px."""
_ACROSS = 0.25
"""Velocity to that side, of the speed: that of a heading changed by 15 degrees. What a wall leaves
of an outline may lie aside, but it does not move there."""
_CONFIRMED = 2
"""Frames in a row that prove it: single outlines jump with the noise at their rim."""
_OTHER_PAINT = 1.0
"""Difference of paint above which it is another vehicle's, the limit of `Paint.difference`."""
_LARGEST_LOG_CHANGE = np.log(1.3)
"""Largest change of a side's logarithm in a frame; a merged outline changes by more. A choice:
twice that of vehicles that pass a camera at 10 images a second (`box_motion.LARGEST_STRETCH`)."""
_LEAST_COVERED = 0.6
"""Least area of the outline in the last clear sighting, of the box, which holds some road: below,
parts of the vehicle are missing. A choice."""
_FURTHEST = 40.0
"""Frames after the last clear sighting within which a turn is proven, and its outline has to keep
its shape: a turn by 90 degrees takes 20 (scene `turn`), and leaves the path in its first half."""
_SETTLED = 0.1
"""Largest change of the logarithm of width over height while a turn counts as over: an outline is
good to a tenth of a vehicle of 20 px, while one that still turns changes by .3 in 8 frames (scene
`turn` at 3 px per frame)."""
_VELOCITY_GAIN = 0.3
"""Share of an outline's displacement that its velocity takes on, as `motion.gain` of the peak's."""


class Branch(NamedTuple):
    """An outline, followed since the doubt began.

    Attributes
    ----------
    motion : PerspectiveMotion
        Predicted path of the vehicle, whose time 0 is the last clear sighting.
    size : (2,) array
        Width and height of the box when it was seen last, px.
    margins : pair of (2,) arrays
        Offsets of the outline's low and high sides from the box's, px: a shadow keeps its extent.
    outline : Outline
        Outline in the present frame.
    velocity : (2,) array
        Velocity of the outline, px per frame.
    age : float
        Frames since the doubt began.
    aside : int
        Frames in a row that it has been beside the path.
    is_proven : bool
        True for a vehicle that turns.
    clear : int
        Frames in a row in which the filter has recognised it since, at a shape that stays.
    shape : float
        Logarithm of the outline's width over its height when these began.
    """

    motion: PerspectiveMotion
    size: Array
    margins: tuple[Array, Array]
    outline: Outline
    velocity: Array
    age: float = 0.0
    aside: int = 0
    is_proven: bool = False
    clear: int = 0
    shape: float = 0.0

    @classmethod
    def begun(
        cls, foreground: Foreground, motion: PerspectiveMotion, last: Sighting
    ) -> Branch | None:
        """Begin `last.age` frames ago, at the last clear sighting, and follow to this frame."""
        # Frames, not periods: some may have been dropped.
        periods = foreground.periods_since(last.age)
        if periods is None:
            return None
        first = foreground.outline(last.position, last.size, len(periods))
        if first is None:
            return None
        # An outline that was not the vehicle's alone would leave the path for another's sake.
        if not _LEAST_COVERED < float(first.size.prod() / last.size.prod()) < MOST_AREA:
            return None
        half = last.size / 2
        margins = first.low - (last.position - half), first.high - (last.position + half)
        # The frames of the doubt are followed, too: a turn began before the response fell.
        branch: Branch | None = cls(motion, last.size, margins, first, motion.velocity)
        for passed, elapsed in enumerate(periods, 1):
            branch = branch and branch.moved(foreground, elapsed, len(periods) - passed)
        return branch

    def moved(self, foreground: Foreground, elapsed: float, ago: int = 0) -> Branch | None:
        """Follow the outline for `elapsed` frames, into the frame some `ago`; None: it is lost.

        Its departure from the path is judged in each frame, also before the doubt.
        """
        before = self.outline
        velocity = self.velocity
        # A lost outline ends the branch for good: what is found later may be another's.
        after = foreground.outline(before.centre + velocity * elapsed, before.size, ago)
        if after is None or np.abs(np.log(after.size / before.size)).max() > _LARGEST_LOG_CHANGE:
            return None
        moved = after.centre - before.centre
        velocity = corrected_velocities(velocity, moved, elapsed, _VELOCITY_GAIN)
        new = self._replace(outline=after, velocity=velocity, age=self.age + elapsed)
        # In a row: one frame on the path begins the proof anew. Once proven, it stays so.
        aside = self.aside + 1 if _leaves(new, *new.box) else 0
        return new._replace(aside=aside, is_proven=self.is_proven or aside >= _CONFIRMED)

    def judged(self, view: View) -> Branch:
        """Judge whether the filter recognises the vehicle again, and the turn is over."""
        # Before the proof the filter knows the vehicle as it was, which proves no turn to be over.
        is_clear = self.is_proven and view.at(self.box[0]) > CLEAR_RESPONSE
        width, height = self.outline.size.tolist()
        shape = math.log(width / height)
        # The filter learns each side as it comes: its box would stay as wide as it is now. But
        # outlines of a few px never settle, and a turn does not last longer.
        if is_clear and (abs(shape - self.shape) < _SETTLED or self.age > _FURTHEST):
            return self._replace(clear=self.clear + 1)
        return self._replace(clear=int(is_clear), shape=shape)

    @property
    def is_over(self) -> bool:
        """True once the filter has recognised the vehicle for long, or nothing was proven."""
        return self.clear >= PROOF_FRAMES or (not self.is_proven and self.age > _FURTHEST)

    @property
    def box(self) -> tuple[Array, Array]:
        """Centre and size, px, of the box that the outline belongs to."""
        # Each side has its own margin: a shadow is on one side of the vehicle.
        low = self.outline.low - self.margins[0]
        high = self.outline.high - self.margins[1]
        # An outline may have become smaller than its margins were.
        return (low + high) / 2, np.maximum(high - low, 1.0)


PaintDifference = Callable[[Array, Array], float]
"""Function of a box's centre and size (2,), px: difference of its paint from the vehicle's."""


class Outlines(NamedTuple):
    """Outlines of a vehicle in doubt; each search is None where there is none, or it has ended.

    Attributes
    ----------
    branch : Branch or None
        The outline that has been followed since the doubt began, or that came out beside the path.
    emergence : Emergence or None
        Search for one that comes out beside the path.
    way : HiddenWay or None
        Where the vehicle is expected; it ends with a proven turn.
    """

    branch: Branch | None = None
    emergence: Emergence | None = None
    way: HiddenWay | None = None

    @classmethod
    def begun(cls, foreground: Foreground, motion: PerspectiveMotion, last: Sighting) -> Outlines:
        """Begin at the last clear sighting, `last.age` frames ago.

        Without a background, which has to be learnt before, there are no outlines.
        """
        if not foreground.is_known:
            return cls()
        way = HiddenWay(last, motion, last.age)
        if last.cut:  # its outline was not the vehicle's
            return cls(way=way)
        emergence = Emergence(last, motion, foreground.extent)
        # In traffic whatever comes out beside the path may be another vehicle.
        was_alone = emergence.was_alone(foreground.history())
        branch = Branch.begun(foreground, motion, last)
        return cls(branch, emergence if was_alone else None, way)

    def followed(
        self,
        foreground: Foreground,
        elapsed: float,
        view: View,
        difference: PaintDifference,
    ) -> Outlines:
        """Follow the outlines into the present frame.

        Parameters
        ----------
        view : View
            Shows whether the filter recognises the vehicle again, which ends the branch.
        difference : callable
            Difference of the paint in a box of this centre and size, px, from the vehicle's.
        """
        # 1. The outline that was followed since the doubt began.
        followed = self.branch and self.branch.moved(foreground, elapsed)
        branch = followed
        emergence = self.emergence
        way = self.way
        # 2. What comes out beside the path: a new branch, if the first one is lost.
        if emergence is not None:
            emergence, emerged = _emerged(emergence, foreground.boxes(), elapsed, difference)
            branch = branch or emerged
        # 3. What moves where it is expected.
        if way is not None:
            way = way.aged(elapsed)
            if way.is_due:
                way = way.looked(foreground.boxes_near(*way.place))
        if branch is None:
            return Outlines(None, emergence, way)
        # 4. In another paint it is another vehicle, which what was left of the outline ran into.
        # The searches go on; while they do, no proof has been believed yet.
        is_new = branch is followed and branch.is_proven and self.way is not None
        if is_new and difference(*branch.box) > _OTHER_PAINT:
            return Outlines(None, emergence, way)
        # 5. A proven turn ends all else, and is over once the filter knows the new side.
        branch = branch.judged(view)
        if branch.is_proven:
            emergence = None
            way = None
        return Outlines(None if branch.is_over else branch, emergence, way)

    @property
    def vehicle(self) -> Branch | None:
        """The vehicle, once it is proven to turn."""
        return self.branch if self.branch is not None and self.branch.is_proven else None


def _emerged(
    emergence: Emergence, boxes: Array, elapsed: float, difference: PaintDifference
) -> tuple[Emergence | None, Branch | None]:
    """Find a vehicle that has come out beside its path."""
    followed = emergence.observed(boxes, elapsed)
    found = followed and followed.proven()
    if followed is None or found is None:
        return followed, None
    emergence = followed
    outline = Outline(*found[0])
    velocity = found[1]
    # Its margins are not known: the outline is the box until the filter takes over.
    margins = (np.zeros(2), np.zeros(2))
    paint = difference(outline.centre, outline.size)
    emergence = emergence._replace(paint=(*emergence.paint, paint))
    if not emergence.has_paint:
        return emergence, None
    branch = Branch(emergence.motion, outline.size, margins, outline, velocity, is_proven=True)
    return emergence, branch


def proven(outlines: Outlines) -> Branch:
    """Return the vehicle of outlines that prove a turn."""
    vehicle = outlines.vehicle
    assert vehicle is not None, "only a proven turn makes a vehicle turn"
    return vehicle


def _leaves(branch: Branch, position: Array, size: Array) -> bool:
    """Test whether a box is, and moves, to one side of the predicted one."""
    velocity = branch.motion.velocity_at(branch.age)
    speed = float(np.hypot(*velocity))
    if not speed:
        return False
    # To one side of the heading; `off` has the sign of that side.
    normal = np.array([-velocity[1], velocity[0]]) / speed
    predicted = branch.size * branch.motion.scale_at(branch.age)
    extent = float(np.sqrt(predicted.prod()))
    away = position - branch.motion.position_at(branch.age)
    # What a wall has left of an outline runs into the vehicle that follows.
    if float(away @ velocity) < -BEHIND * extent * speed:
        return False
    off = float(away @ normal)
    # Both sides of the box have to be off: a cut moves only one of them.
    wider = float(np.abs(normal) @ (size - predicted)) / 2
    aside = (abs(off) - abs(wider)) / extent
    return aside > _ASIDE and float(branch.velocity @ normal) * np.sign(off) > _ACROSS * speed

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle that comes out on its way, before a standing camera, where no hypothesis expects it.

Behind an occluder it may have come nearer, or driven on faster, than its earlier sightings told: it
is in full view then, beside the hypotheses and at another size. The outline that appears on its
heading and drives on along it is the vehicle, if the filter and the paint agree at its own size.
What was in view before, or came from elsewhere, is another vehicle.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.behind import is_behind
from vehicle_pf_tracker.trackers.fusion.outline_boxes import areas, front_move
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sighting,
)

_REACH_ALONG = 1.5
"""Distance of an outline ahead of the prediction or behind it, in predicted diagonals, within which
it is on this heading: hidden vehicles that came near had covered .22 to .8 of their way."""
_REACH_ACROSS = 0.6
"""Distance of an outline to either side of the prediction, in predicted diagonals, within which it
is on this heading: predictions err less there, and the next lane is one diagonal away."""
_SIDES = 0.5, 2.2
"""Bounds of its extent, fractions of the predicted one: behind signs and bridges vehicles that came
near were predicted at .36 to .8 of their size, others at up to 1.4 of it."""
_LEAST_AREA = 0.25
"""Least area of an outline beside the heading that is another vehicle, fraction of the predicted
one: less is a piece, and may be the tip of the vehicle's own shadow. The quarter is a choice."""
_SPEEDS = 0.4, 3.0
"""Bounds of its speed, fractions of the predicted one: twice as near it is four times as fast."""
LEAST_PAINT = 0.1
"""Least share of a box that has the vehicle's paint: windows, lamps and road have another. A tenth
is a choice: 7 of the 64 spots that are compared."""
_LARGEST_JUMP = 0.5
"""Largest move of a side from frame to frame, in predicted diagonals: more is another piece. The
half is a choice; two vehicles in a lane are a whole length apart."""
_EARLY = 1.0
"""Distance in predicted sizes ahead of the prediction beyond which no hypothesis is the vehicle:
there is the one ahead of it in its lane. Only an outline that came out is believed there. Chosen
after seven of 14 wrong returns, and four of 129 right ones, had been seen beyond it; behind the
prediction there is no such bound, as vehicles brake (laboratory/notes/fusion_tried.md)."""
_EVERY = 2
"""Frames from one look at the outlines to the next, until one drives on: half of the cost. What is
proven within `_PROOF` is proven a frame later at most."""
_REMEMBERED = 2
"""Looks in which others are remembered, the least that bridges one in which an outline is lost: it
flickers. Longer ones would claim the road that others have left."""
_PROOF = PROOF_FRAMES - 1.0
"""Periods from the first to the last of the frames that prove a motion."""
_FOLLOWED = 2.0 * PROOF_FRAMES
"""Periods over which the velocity of an outline is measured at most: it may brake or turn."""
_JUDGED = 3
"""Frames in a row in which filter and paint have to know it: single outlines jump. Three is a
choice, a tenth of a second."""


class Candidate(NamedTuple):
    """A box inside an outline.

    Attributes
    ----------
    position, size : (2,) arrays
        Centre, and width and height, px.
    response : float
        Highest response of the filter in the outline, relative to the usual one.
    paint : float
        Share of the box that has the vehicle's paint.
    """

    position: Array
    size: Array
    response: float
    paint: float


Mask = npt.NDArray[np.bool_]

Judge = Callable[[Array, Array], Candidate]
"""Function that finds the best box in an outline (2, 2), with the side ratio of a size (2,)."""


class Reappearance(NamedTuple):
    """The outline on the heading of a hidden vehicle that is next to where it is expected.

    Attributes
    ----------
    last : Sighting
        Last clear sighting of the vehicle.
    motion : PerspectiveMotion
        Motion of the vehicle then, whose time 0 is that sighting.
    age : float
        Periods since that sighting.
    rested : int
        Frames since the last look at the outlines.
    others : tuple of (N, 2, 2) arrays
        Bounding boxes (low, high; px) of other vehicles, in the last looks.
    track : tuple of (float, (2, 2) array)
        Ages and bounding boxes of the outline, in the last looks.
    judged : tuple of Candidate
        The vehicle in it, in the last looks in which it drove on along the heading.
    is_covered : bool
        True where nothing moved in the middle of the predicted box in the last look: what covers
        the vehicle is a part of the background.
    """

    last: Sighting
    motion: PerspectiveMotion
    age: float
    rested: int = _EVERY
    others: tuple[Array, ...] = ()
    track: tuple[tuple[float, Array], ...] = ()
    judged: tuple[Candidate, ...] = ()
    is_covered: bool = False

    @property
    def place(self) -> tuple[Array, Array]:
        """Centre and size, px, of the predicted box."""
        return self.motion.position_at(self.age), self.last.size * self.motion.scale_at(self.age)

    def aged(self, elapsed: float) -> Reappearance:
        """Let a frame pass, `elapsed` periods after the last one."""
        return self._replace(age=self.age + elapsed, rested=self.rested + 1)

    @property
    def is_due(self) -> bool:
        """True in every second frame, and in each while an outline drives on along the heading."""
        return self.rested >= _EVERY or bool(self.judged)

    def observed(self, boxes: Array, judge: Judge) -> Reappearance:
        """Follow the outline; only one that drives on is judged by the filter and the paint."""
        # Others are known by where they were: on the heading an outline is the vehicle's only if
        # none of them was there before.
        position, size = self.place
        is_large = areas(boxes) > _LEAST_AREA * size.prod()
        # The middle half of the predicted box: only the vehicle's own rest may be seen there.
        middle = np.stack([position - size / 4, position + size / 4])
        is_there = _touch(boxes, middle[np.newaxis])
        is_other = ~self._on_heading(boxes) & is_large
        if self.others:
            is_other |= _touch(boxes, np.concatenate(self.others))
        else:  # what is in view elsewhere when the vehicle is hidden is not the vehicle
            is_other |= ~is_there
        others = (*self.others[1 - _REMEMBERED :], boxes[is_other])
        is_covered = not (is_there & is_large).any()
        new = self._replace(others=others, rested=0, is_covered=is_covered)
        return new._followed(boxes[~is_other], judge)

    def excludes(self, positions: Array) -> Mask:
        """Test at which positions (..., 2), px, no hypothesis is the vehicle."""
        return np.asarray((self._ahead(positions) > _EARLY) | self.is_behind(positions))

    def _ahead(self, positions: Array) -> Array:
        """Distances (...) of positions ahead of the prediction, along its heading, in its sizes."""
        position, size = self.place
        velocity = self.motion.velocity_at(self.age)
        # 1e-9: of a vehicle that stood nothing is ahead or behind.
        heading = velocity / max(float(np.hypot(*velocity)), 1e-9)
        return np.asarray((positions - position) @ heading / np.sqrt(size.prod()))

    def _followed(self, boxes: Array, judge: Judge) -> Reappearance:
        """Follow the outline that is next to the predicted position."""
        # A look without any ends the proof, which asks for frames in a row.
        boxes = boxes[self._has_size(boxes)]
        if not len(boxes):
            return self._replace(track=(), judged=())
        position, size = self.place
        # Of several that come out, the one next to the prediction: the order on a lane stays.
        off = np.linalg.norm(boxes.mean(axis=1) - position, axis=1)
        sides = boxes[int(off.argmin())]
        track = tuple(each for each in self.track if each[0] >= self.age - _FOLLOWED)
        if track and np.abs(sides - track[-1][1]).max() > _LARGEST_JUMP * np.hypot(*size):
            track = ()
        new = self._replace(track=(*track, (self.age, sides)), judged=())
        # A view of the filter costs as much as all else here: what stands is not worth one.
        if new._velocity() is None:
            return new
        return new._replace(judged=(*self.judged[1 - _JUDGED :], judge(sides, size)))

    @property
    def vehicle(self) -> tuple[Candidate, Array] | None:
        """Box and velocity (px per frame) of what is proven to be the vehicle; else None."""
        velocity = self._velocity()
        if len(self.judged) < _JUDGED or velocity is None:
            return None
        # Both have to agree: strangers often have one of them, the paint or the shape.
        response = float(np.mean([each.response for each in self.judged]))
        paint = float(np.mean([each.paint for each in self.judged]))
        agrees = response > CLEAR_RESPONSE and paint > LEAST_PAINT
        return (self.judged[-1], velocity) if agrees else None

    def _velocity(self) -> Array | None:
        """Velocity of an outline that drives on along the heading, px per frame; else None."""
        if len(self.track) < PROOF_FRAMES // _EVERY:
            return None
        began, first = self.track[0]
        now, last = self.track[-1]
        if now - began < _PROOF:
            return None
        velocity = np.asarray(front_move(first, last) / (now - began))
        predicted = self.motion.velocity_at(self.age)
        speed = float(np.hypot(*predicted))
        # Along the predicted heading, so that what crosses it is no return. 1e-9 only keeps
        # vehicles that stood from dividing by zero.
        along = float(velocity @ predicted) / max(speed, 1e-9)
        return velocity if _SPEEDS[0] * speed < along < _SPEEDS[1] * speed else None

    def is_behind(self, positions: Array) -> Mask:
        """Test which positions (..., 2) are against the heading from where the vehicle was last."""
        return is_behind(positions, self.motion, self.last, self.age)

    def _on_heading(self, boxes: Array) -> Mask:
        """Test which boxes are within reach of the predicted path."""
        position, size = self.place
        diagonal = float(np.hypot(*size))
        velocity = self.motion.velocity_at(self.age)
        heading = velocity / max(float(np.hypot(*velocity)), 1e-9)
        # To the nearest point of a box: shadows move the centres of outlines.
        off = np.clip(position, boxes[:, 0], boxes[:, 1]) - position
        along = np.abs(off @ heading)
        across = np.abs(off @ np.array([-heading[1], heading[0]]))
        return np.asarray((along < _REACH_ALONG * diagonal) & (across < _REACH_ACROSS * diagonal))

    def _has_size(self, boxes: Array) -> Mask:
        """Test the largest box with the vehicle's ratio of the sides that fits into each."""
        _, size = self.place
        ratios = ((boxes[:, 1] - boxes[:, 0]) / size).min(axis=1)
        return np.asarray((ratios > _SIDES[0]) & (ratios < _SIDES[1]))


def _touch(boxes: Array, others: Array) -> Mask:
    """Test which boxes (N, 2, 2) overlap any of the others (M, 2, 2)."""
    low = np.maximum(boxes[:, np.newaxis, 0], others[:, 0])
    high = np.minimum(boxes[:, np.newaxis, 1], others[:, 1])
    overlaps = np.all(low < high, axis=2)
    return np.asarray(np.any(overlaps, axis=1))

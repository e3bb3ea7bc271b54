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
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sighting,
)

_REACH_ALONG = 1.5
"""Distance of an outline ahead of the prediction or behind it, of the predicted diagonal, within
which it is on this heading: hidden vehicles that came near had covered .22 to .8 of their way."""
_REACH_ACROSS = 0.6
"""Distance of an outline to either side of the prediction, of the predicted diagonal, within which
it is on this heading: predictions err less there, and the next lane is one diagonal away."""
_SIDES = 0.5, 2.2
"""Bounds of its extent, of the predicted one: behind signs and bridges vehicles that came near were
predicted at .36 to .8 of their size, others at up to 1.4 of it."""
_LEAST_AREA = 0.25
"""Area of an outline beside the heading that is another vehicle, of the predicted one: less is a
piece, and may be the tip of the vehicle's own shadow. The quarter is a choice."""
_SPEEDS = 0.4, 3.0
"""Bounds of its speed, of the predicted one: one that is twice as near is four times as fast."""
LEAST_PAINT = 0.1
"""Least share of a box that has the vehicle's paint: windows, lamps and road have another. A tenth
is a choice: 7 of the 64 spots that are compared."""
_LARGEST_JUMP = 0.5
"""Largest move of a side from frame to frame, of the predicted diagonal: more is another piece. The
half is a choice; two vehicles in a lane are a whole length apart."""
_BEHIND = 0.5
"""Distance in sizes against the heading, from the last clear sighting, beyond which nothing is the
vehicle: it does not reverse on a road, and what comes up from behind is another one."""
_REMEMBERED = 2
"""Frames in which others are remembered, the least that bridges one in which an outline is lost: it
flickers. Longer ones would claim the road that others have left."""
_FOLLOWED = 2 * PROOF_FRAMES
"""Frames over which the velocity of an outline is measured at most: it may brake or turn."""
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
"""Best box in an outline (2, 2) of a vehicle of the size (2,), whose ratio of the sides it has."""


class Reappearance(NamedTuple):
    """The outline on the heading of a hidden vehicle that is next to where it is expected.

    Attributes
    ----------
    last : Sighting
        Last clear sighting of the vehicle.
    motion : PerspectiveMotion
        Motion of the vehicle then, whose time 0 is that sighting.
    age : float
        Frames since that sighting.
    others : tuple of (N, 2, 2) arrays
        Bounding boxes (low, high; px) of other vehicles, in the last frames.
    track : tuple of (float, (2, 2) array)
        Ages and bounding boxes of the outline, in the last frames.
    judged : tuple of Candidate
        The vehicle in it, in the last frames in which it drove on along the heading.
    """

    last: Sighting
    motion: PerspectiveMotion
    age: float
    others: tuple[Array, ...] = ()
    track: tuple[tuple[float, Array], ...] = ()
    judged: tuple[Candidate, ...] = ()

    @property
    def place(self) -> tuple[Array, Array]:
        """Centre and size, px, of the predicted box."""
        return self.motion.position_at(self.age), self.last.size * self.motion.scale_at(self.age)

    def aged(self, elapsed: float) -> Reappearance:
        """Let `elapsed` frames pass."""
        return self._replace(age=self.age + elapsed)

    def observed(self, boxes: Array, judge: Judge) -> Reappearance:
        """Follow the outline; only one that drives on is judged by the filter and the paint."""
        # Others are known by where they were: on the heading an outline is the vehicle's only if
        # none of them was there before.
        areas = (boxes[:, 1] - boxes[:, 0]).prod(axis=1)
        is_other = ~self._on_heading(boxes) & (areas > _LEAST_AREA * self.place[1].prod())
        if self.others:
            is_other |= _touch(boxes, np.concatenate(self.others))
        else:  # what is in view elsewhere when the vehicle is hidden is not the vehicle
            position, size = self.place
            # The middle half of the predicted box: only the vehicle's own rest may be seen there.
            own = np.stack([position - size / 4, position + size / 4])
            is_other |= ~_touch(boxes, own[np.newaxis])
        new = self._replace(others=(*self.others[1 - _REMEMBERED :], boxes[is_other]))
        return new._followed(boxes[~is_other], judge)

    def _followed(self, boxes: Array, judge: Judge) -> Reappearance:
        """Follow the outline that is next to the predicted position."""
        # A frame without any ends the proof, which asks for frames in a row.
        boxes = boxes[self._has_size(boxes)]
        if not len(boxes):
            return self._replace(track=(), judged=())
        position, size = self.place
        # Of several that come out, the one next to the prediction: the order on a lane stays.
        off = np.linalg.norm(boxes.mean(axis=1) - position, axis=1)
        sides = boxes[int(off.argmin())]
        track = self.track[-_FOLLOWED:]
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
        if len(self.track) < PROOF_FRAMES:
            return None
        began, first = self.track[0]
        now, last = self.track[-1]
        # The side in front moves all the time, the other one once all has come out.
        moves = last - first
        moved = np.where(np.abs(moves[1]) > np.abs(moves[0]), moves[1], moves[0])
        velocity = np.asarray(moved / max(now - began, 1e-3))
        predicted = self.motion.velocity_at(self.age)
        speed = float(np.hypot(*predicted))
        # Along the predicted heading, so that what crosses it is no return. 1e-3 and 1e-9 only keep
        # repeated stamps and vehicles that stood from dividing by zero.
        along = float(velocity @ predicted) / max(speed, 1e-9)
        return velocity if _SPEEDS[0] * speed < along < _SPEEDS[1] * speed else None

    def is_behind(self, positions: Array) -> Mask:
        """Test which positions (..., 2) are against the heading from where the vehicle was last."""
        # Both sides times the speed, undivided: of a vehicle that stood nothing is behind.
        velocity = self.motion.velocity
        speed = float(np.hypot(*velocity))
        extent = float(np.sqrt(self.last.size.prod()))
        return np.asarray((positions - self.last.position) @ velocity < -_BEHIND * extent * speed)

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

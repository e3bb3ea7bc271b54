# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Points on the vehicle, tracked from frame to frame: its first motion, and its change of size.

Points that stay behind with a standing occluder, or go away with a moving one, leave their place in
the box and end. On a vehicle that is partly hidden others are placed half as often, since a part of
them lies on the occluder.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.kernels.interface import BY_NUMPY, Kernels
from vehicle_pf_tracker.image.motion import box_motion
from vehicle_pf_tracker.image.motion.point_flow import PointFlow, PointMask, Points
from vehicle_pf_tracker.trackers.fusion.surface_flow import BOX_REACH

_GRID = 8
"""Points along each axis: four fifths of 64 may be lost until they tell no more of the size
(`box_motion.FEWEST_POINTS`)."""
_GRID_REACH = 0.4
"""Distance of the outermost points from the centre, fraction of the size. Their windows end at the
box: half of one is a tenth of the canonical size, and the background is beyond."""
_RENEWED_AFTER = 5
"""Age in frames of points that are replaced: they drift off their spots as they age. A choice."""
_OLDEST = 2 * _RENEWED_AFTER
"""The same where a part of the vehicle is hidden, half as often: new ones may lie on the occluder.
"""
_STRAYED = 0.2
"""A point farther than this (fraction of the box size) from its predicted position in the box has
left the vehicle; the prediction turns with the other points. That is 8 canonical px, a choice far
above the error of a round trip."""
_ROUND_TRIP_PX = 1.0
"""Largest error in canonical px of a point tracked forth and back (Kalal et al. 2010): a choice, as
flow is good to about one px."""
_FLOW = PointFlow(window=9, levels=0, steps=8, precision=0.05)
"""No pyramid: the response's peak gives the motion to within a few canonical px, half a window. It
ends at the box (`_GRID_REACH`); steps and precision are choices below the error of a round trip."""
_FIRST_GRID = 10
"""Points along each axis: finer than later, as most of a loose first box may be road."""
_FIRST_FLOW = PointFlow(window=13, levels=3)
"""The first step knows no velocity, hence larger windows and more pyramid levels: three, a choice,
reach eight times as far, more than the size of the target."""
_FIRST_MOVED_PX = 1.5
"""Motion in canonical px, and least in px of the frame, above which a point moves against the
background: less is the error of the camera's motion, or noise that was magnified."""
_FIRST_FEWEST = 8
"""Fewest points that move alike for a first velocity: a twelfth of the box."""
_FIRST_ALIKE_PX = 2 * _ROUND_TRIP_PX
"""Difference in canonical px below which two points move alike: each may be off by the error of a
round trip."""


class _Points(NamedTuple):
    """Points by place in the box (sizes from its centre), position (px), life, and age (frames)."""

    places: Array
    positions: Array
    alive: npt.NDArray[np.bool_]
    age: float = 0.0


class SurfacePoints(NamedTuple):
    """Points on the vehicle.

    Attributes
    ----------
    previous : (Patch, (2,) array) or None
        Patch that the next motion starts from, and the vehicle's position in it, px.
    points : _Points or None
        The points.
    stretch : (2,) array
        Change of the logarithm of width and height in the last frame by the points' spread.
    """

    previous: tuple[Patch, Array] | None = None
    points: _Points | None = None
    stretch: Array = np.zeros(2)

    def restarted(self) -> SurfacePoints:
        """Discard all points."""
        return SurfacePoints(self.previous)

    def kept(self, patch: Patch, position: Array) -> SurfacePoints:
        """Keep the patch that the next motion starts from, and the vehicle's position in it, px."""
        return self._replace(previous=(patch, position))

    def first_motion(self, patch: Patch, size: Array) -> Array | None:
        """Motion in px of what moves against the background inside the first box, if anything does.

        `patch` shows the second frame around the first position, moved with the background.
        """
        assert self.previous is not None, "keep the first patch before"
        previous, _ = self.previous
        places = _grid(_FIRST_GRID, BOX_REACH)
        # The box is in the middle of its patch; OpenCV counts from the middle of the first pixel.
        start = (places * size * previous.zoom + previous.side / 2 - 0.5).astype(np.float32)
        end, found = _flow(previous, patch, start, None, _FIRST_FLOW)
        moves = (end - start)[found].astype(np.float64)
        # Both patches show the same piece of the background: what moves there moves against it.
        least = _FIRST_MOVED_PX * max(float(patch.zoom.max()), 1.0)
        moves = moves[np.hypot(moves[:, 0], moves[:, 1]) > least]
        if len(moves) < _FIRST_FEWEST:
            return None
        # The motion that most points share: a second vehicle may pass in the box.
        alike = np.linalg.norm(moves[:, np.newaxis] - moves, axis=2) < _FIRST_ALIKE_PX
        largest = alike[int(alike.sum(axis=1).argmax())]
        if largest.sum() < _FIRST_FEWEST:
            return None
        return np.asarray(np.median(moves[largest], axis=0) / patch.zoom)

    def tracked(
        self, patch: Patch, position: Array, size: Array, kernels: Kernels = BY_NUMPY
    ) -> SurfacePoints:
        """Track all points into the present patch, measure how they spread, and end strays.

        Parameters
        ----------
        patch : Patch
            Shows the present frame.
        position, size : (2,) arrays
            Estimated centre, and width and height, px; the search starts from the displacement
            since the patch that was kept.
        kernels : Kernels
            Implementation that tells strays.
        """
        if self.previous is None or self.points is None:
            return self
        places, positions, alive, age = self.points
        # They age without any left, so that new ones are placed at their time.
        if not alive.any():
            return SurfacePoints(self.previous, self.points._replace(age=age + 1))
        previous, started = self.previous
        before = positions.compress(alive, axis=0)
        start = np.asarray(previous.to_patch(before) - 0.5, np.float32)
        # The peak has found the motion: without a pyramid only the rest is within a window's reach.
        guess = np.asarray(patch.to_patch(before + position - started) - 0.5, np.float32)
        end, found = _flow(previous, patch, start, guess, _FLOW)
        after = patch.to_frame(end.astype(np.float64) + 0.5)
        # With the strays: they are found by the box, which this has to correct, and few do not move
        # a median.
        stretch = box_motion.shared_stretch(
            before.compress(found, axis=0), after.compress(found, axis=0), size
        )
        # Copied: the state of the frame before shares the arrays.
        positions = positions.copy()
        living = alive.copy()
        positions[alive] = after
        living[alive] = found
        living = kernels.staying(places, (positions - position) / size, living, _STRAYED)
        return SurfacePoints(self.previous, _Points(places, positions, living, age + 1), stretch)

    def renewed(self, position: Array, size: Array, *, whole: bool = True) -> SurfacePoints:
        """Place new points if it is time."""
        # None yet: they are placed at once.
        age = _OLDEST if self.points is None else self.points.age
        if age < (_RENEWED_AFTER if whole else _OLDEST):
            return self
        # All at once: the ages, and so the errors, of all points are alike.
        places = _grid(_GRID, _GRID_REACH)
        points = _Points(places, position + places * size, np.ones(len(places), bool))
        return self._replace(points=points)


@functools.cache
def _grid(count: int, reach: float) -> Array:
    """Square grid of places in the box, `reach` to each side of its centre."""
    ends = np.linspace(-reach, reach, count)
    return np.stack(np.meshgrid(ends, ends), axis=-1).reshape(-1, 2)


def _flow(
    before: Patch, after: Patch, start: Points, guess: Points | None, flow: PointFlow
) -> tuple[Points, PointMask]:
    """Track points (N, 2) forth and back; also tell which came back to where they started."""
    end, found, error = flow.follow_and_return(before.grey, after.grey, start, guess)
    # Added by hand: numpy takes twice as long to sum rows of two.
    x, y = np.square(error).T
    return end, found & (x + y < _ROUND_TRIP_PX**2)

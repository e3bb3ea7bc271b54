# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The sides of the vehicle, relative to the box that the filter follows.

What a filter answers to drifts on the vehicle as that turns in perspective: within seconds one side
of the box is a tenth to a fifth of the size off, over road or inside the vehicle, and a first box
may be as far off. Two witnesses show the sides. A network has learnt where vehicles end
(`image/patches`), and looks at any that is in full view. Before a standing camera there are the
edges of what moves, but for shadows and rounded corners: by three images from the first frames on
(`moving_edges.py`), and by the background once that is known. Of each side a Kalman filter believes
in a distance, which was small at first and wanders, and in a bias of either witness that stays.

Only the box that is reported is corrected. What the filter follows stays as it is: moved, its peak
would draw it back. But where a flank comes into view the drift is faster than that belief, and goes
on: at one of its ends edges are beyond it in look after look, and its shape changes. There the box
that is followed is moved to the edges, and the filter is trained anew on it (`anchoring.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.foreground import Around
from vehicle_pf_tracker.trackers.fusion.moments import Moment, Moments, is_due, moved
from vehicle_pf_tracker.trackers.fusion.moving_edges import moving_edges

_DRIFT = 0.002
"""Variance that a side's distance gains, fraction of the size squared per second: .045 in the first
second. With half and twice as much the mean gain of IoU is .019 and .021, not .023
(laboratory/notes/fusion_tried.md)."""
_BIAS = 0.05
"""Standard deviation of a side's bias, fraction of the size: .04 to .07 by the true boxes of 20
sequences of five standing cameras. And of a side of the box that was given, and of what the network
sees against what whoever gave it calls the vehicle, which count as loose as that. With .035 and .07
the mean gain of IoU by edges of three images was .0079 and .0083, not .0081
(laboratory/notes/fusion_tried.md)."""
_NOISE = 0.14
"""Standard deviation of an edge, fraction of the size. That of one look is .04 to .06, but the
errors of looks in a row are alike. Chosen on 58 vehicles and, against .2 (IoU .797, not .803), on
37 more (laboratory/notes/fusion_tried.md)."""
_DELAY = 0.3
"""Age of a look at which it is believed, s: what an occluder cuts is seen in looks just before the
doubt, and a doubt discards them. With 0 one that is cut loses .02, with 1 all gain .020."""
_EVERY = 0.125
"""Least time between two looks at the background, and between two of the network, s: four frames at
30 Hz, since a mask costs time, and so do cells."""
_OFF = 0.12
"""Least distance of an edge beyond the left or right side of a flank that comes into view, fraction
of the width, a choice: three deviations of one look."""
_LEAST_BEYOND = -0.2
"""Least distance of an edge beyond a side there, fraction of the width, a choice: farther inside it
is an occluder's, or parts of the mask are missing."""
_TURNS = 0.15
"""Least change of the logarithm of width over height of a box whose vehicle shows a flank, per
second. With .1 a car of 27 px on a straight road has one, too (silver_estate, by its size's noise);
with none 133 vehicles gain .003, but looks against a background that has just become known lose
three of 39 recoveries behind walls (laboratory/notes/fusion_tried.md)."""
_SETTLED = 0.5
"""Time over which that change is measured, s, a choice: of turns that take one to three."""

_HALFWAY = 0.5
"""Share of the way from the followed box to the reported one at which the network looks. Around
the followed one it sees too little of sides that are far off; around the reported one, its errors
add up, look after look. With 0 and 1, the mean gain of IoU was .019 and .019, not .022, and with 1
it lost .016 on the 19: chosen on the vehicles that judge it, and before answers counted by their
share, with which 1 differs less (laboratory/notes/fusion_tried.md)."""
_EDGES, _SEEN = 1, 2
"""Places of the two biases among the means."""
_SHIFT = 0.1
"""Shift of the box by which it is measured how far the network's answer follows, fraction of its
size, a choice: about what sides are off by."""
_ASKED = 4
"""Looks at which that is measured, a choice: half a second; of one vehicle it stays about the same,
and each costs two more looks."""

Look: TypeAlias = Callable[[Array, Array], Array]
"""How far the sides of the vehicle are beyond those of a box of a centre and size, px, (2, 2)."""
_Look = tuple[float, Array]
"""Age of a look, s, and the distances that it found."""


class Sides(NamedTuple):
    """Belief about the sides of the vehicle; arrays are by [low or high, axis].

    Attributes
    ----------
    means : (2, 2, 3) array
        Distance of the vehicle's sides beyond those of the followed box, and of the edges of what
        moves and the sides that the network sees beyond the vehicle's, fractions of the box's size.
    covariances : (2, 2, 3, 3) array
        Covariances of these three.
    since : float
        Time that `beyond` has wandered since the last look that is believed, s.
    looks : tuple of (float, (2, 2) array)
        Looks that are not believed yet, oldest first.
    shape : float or None
        Logarithm of the width over the height of the followed box, an exponential mean; None where
        none is known.
    rested : float
        Time since the last look at the background, s.
    unseen : float
        Time since the network's last look, s.
    asked : int
        Looks at which it was measured how far the network's answer follows the box.
    share : (2,) array
        Part of a shift of the box by which the answer changed in these, by axis, their mean.
    time : float
        Time since the first frame, s.
    moments : tuple of Moment
        Last frames in which the box was followed without a doubt, of which three are compared.
    """

    means: Array = np.zeros((2, 2, 3))
    covariances: Array = np.broadcast_to(_BIAS**2 * np.eye(3), (2, 2, 3, 3))
    since: float = 0.0
    looks: tuple[_Look, ...] = ()
    shape: float | None = None
    rested: float = 0.0
    unseen: float = 0.0
    asked: int = 0
    share: Array = np.zeros(2)
    time: float = 0.0
    moments: Moments = ()

    def moved(self, camera: CameraMotion) -> Sides:
        """Note that the camera has moved."""
        return self if camera.still else self._replace(moments=moved(self.moments, camera))

    def passed(self, seconds: float, size: Array) -> Sides:
        """Let time pass in which the followed box has a size, px; believe looks old enough then."""
        looks = tuple((age + seconds, found) for age, found in self.looks)
        shape = _shape(size)
        if self.shape is not None:
            shape = self.shape + (shape - self.shape) * min(seconds / _SETTLED, 1.0)
        sides = self._replace(
            since=self.since + seconds,
            looks=looks,
            shape=shape,
            rested=self.rested + seconds,
            unseen=self.unseen + seconds,
            time=self.time + seconds,
        )
        while sides.looks and sides.looks[0][0] >= _DELAY:
            (_, found), *later = sides.looks
            sides = sides._believed(found, _EDGES, _NOISE)._replace(looks=tuple(later))
        return sides

    @property
    def beyond(self) -> Array:
        """Distances (2, 2) of the vehicle's sides beyond those of the followed box."""
        return np.asarray(self.means[..., 0])

    @property
    def is_unseen(self) -> bool:
        """True where the network's last look is long enough ago for another one."""
        return self.unseen >= _EVERY

    @property
    def is_rested(self) -> bool:
        """True where the last look at the background is long enough ago for another one."""
        return self.rested >= _EVERY

    def looked(self, around: Around | None, position: Array, size: Array) -> Sides:
        """Look at what moves around the followed box of this centre and size, px."""
        found = around and around.beyond(position, size)
        looks = self.looks if found is None else (*self.looks, (0.0, found))
        return self._replace(looks=looks, rested=0.0)

    def compared(
        self, patch: Patch, position: Array, size: Array, extent: tuple[int, int]
    ) -> Sides:
        """Look at what moves with the followed box in a frame of this width and height, px."""
        if not is_due(self.moments, position, size):
            return self
        moments = (*self.moments, Moment.of_patch(patch, position, size, self.time))
        if len(moments) < 3:
            return self._replace(moments=moments)
        # Of the middle one, so that it is older than the latest looks.
        look = self.time - moments[1].time, moving_edges(moments, extent)
        looks = tuple(sorted((look, *self.looks), key=_age, reverse=True))
        # Each frame is compared once: the errors of two comparisons that share one are alike.
        return self._replace(looks=looks, moments=())

    def parted(self) -> Sides:
        """Discard the frames: the next one will not follow on them."""
        return self._replace(moments=()) if self.moments else self

    def doubted(self) -> Sides:
        """Discard the looks of just before a doubt: an occluder may have cut the vehicle."""
        return self._replace(looks=(), shape=None, rested=0.0, moments=())

    def unfolded(self, size: Array) -> Sides | None:
        """Sides as the last look found them left and right, if a flank comes into view.

        `size` (2,) is that of the followed box, px; None where none does.
        """
        # The mean lags behind a steady change by what changes in its time.
        if self.shape is None or abs(_shape(size) - self.shape) < _TURNS * _SETTLED:
            return None
        across = np.array([found[:, 0] for _, found in self.looks]).reshape(-1, 2)
        # All that are not believed yet: a single one may be of something else.
        are_many = np.isfinite(across).sum(axis=0) > 1
        # At the other end the box is on the vehicle, or beyond it: a mask that is too large is so
        # at both ends. Far inside of it an occluder covers that end. A side that was not seen
        # compares as false.
        is_off = ~(across <= _OFF).any(axis=0) & are_many
        is_flank = is_off & ~(across[:, ::-1] > 0).any(axis=0)
        if not is_flank.any() or (across < _LEAST_BEYOND).any():
            return None
        means = self.means.copy()
        for found in across:
            means[:, 0, 0] = np.where(np.isfinite(found), found, means[:, 0, 0])
        return self._replace(means=means)

    def seen(self, look: Look, noise: Array, position: Array, size: Array) -> Sides:
        """Let the network look at the vehicle whose followed box has this centre and size, px.

        `noise` (2, 2) is the standard deviation of what it sees.
        """
        near = _HALFWAY * self.beyond
        centre, whole = moved_box(position, size, near)
        sides = self._asked(look, centre, whole)
        found = near + look(centre, whole) * (whole / size)
        # What it does not know it answers to the same wherever it looks: that tells nothing.
        share = np.minimum(np.maximum(sides.share, 0.0), 1.0)
        return sides._believed(found, _SEEN, noise, share)._replace(unseen=0.0)

    def _asked(self, look: Look, centre: Array, size: Array) -> Sides:
        """Measure how far the network's answer follows the box, in the first looks."""
        if self.asked == _ASKED:
            return self
        ahead, back = (look(centre + shift * size, size) for shift in (_SHIFT, -_SHIFT))
        # What the box leaves behind it lies beyond its low side, and no more beyond its high one.
        low, high = (ahead - back) / (2 * _SHIFT)
        share = self.share + ((low - high) / 2 - self.share) / (self.asked + 1)
        return self._replace(asked=self.asked + 1, share=share)

    def box(self, position: Array, size: Array) -> tuple[Array, Array]:
        """Centre and size, px, of the vehicle whose followed box has these."""
        return moved_box(position, size, self.beyond)

    def _believed(
        self, found: Array, kind: int, noise: Array | float, share: Array | float = 1.0
    ) -> Sides:
        """Take in the distances that edges or the network gave; NaN where a side was not seen.

        Of what follows the sides by a `share` only, the noise is that of the whole over the share.
        """
        # A Kalman filter with three states, of which the first one and one bias are seen as a sum.
        covariances = self.covariances.copy()
        covariances[..., 0, 0] += _DRIFT * self.since
        with_sum = covariances[..., 0] + covariances[..., kind]
        weight = np.where(np.isfinite(found), share, 0.0) ** 2
        total = weight * (with_sum[..., 0] + with_sum[..., kind]) + noise**2
        expected = self.means[..., 0] + self.means[..., kind]
        error = np.where(np.isfinite(found), found - expected, 0.0)
        gains = weight[..., np.newaxis] * with_sum / total[..., np.newaxis]
        covariances -= gains[..., np.newaxis] * with_sum[..., np.newaxis, :]
        means = self.means + gains * error[..., np.newaxis]
        return self._replace(means=means, covariances=covariances, since=0.0)


def moved_box(position: Array, size: Array, beyond: Array) -> tuple[Array, Array]:
    """Centre and size, px, of a box whose sides are moved outwards by fractions of its size."""
    low, high = beyond * size
    return position + (high - low) / 2, size + low + high


def _age(look: _Look) -> float:
    return look[0]


def _shape(size: Array) -> float:
    """Logarithm of the width over the height."""
    width, height = size.tolist()
    return math.log(width / height)

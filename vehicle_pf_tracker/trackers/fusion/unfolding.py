# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A side that unfolds: a vehicle in full view whose outline grows beyond one end of the box.

One end of a vehicle that turns slowly looks the same throughout. The filter goes on answering to
it, and the box stays on it, while the side comes into view. Before a standing camera the outline
shows that side. But it also has shadows, ghosts of what stood in the background, and neighbours: a
shadow does not grow, a ghost does not change from frame to frame, and a neighbour joins at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.foreground import Foreground, Outline
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion
from vehicle_pf_tracker.trackers.fusion.turning import MOST_COVERED, Branch

_EVERY = 0.125
"""Least time between two looks, s: four frames at 30 Hz, since outlines cost time."""
_LASTS = 0.66
"""Least time over which an outline has to grow, s, the 20 frames at 30 Hz of a turn by 90 degrees
(scene `turn`). With .4, and a growth of .25, a drawn truck has an IoU of .72 instead of .80."""
_KEPT = 2.6
"""Age of the oldest look that is compared with, s, a choice: a slower turn is not waited for."""
_GROWN = 0.3
"""Growth at one end that proves it, in extents of the box (the geometric mean of its sides): an
outline is good to a tenth at each end. In fractions of the box's own side the shadow below a long
lorry grows by as much."""
_LARGEST_PART = 0.5
"""Largest part of that growth from one look to the next, since what joins an outline does so at
once; and at the other end, since a box that is too small at both ends is followed by the response.
A choice."""
_DRIVEN = 0.1
"""Least way of the box meanwhile, fraction of its size: what stands does not turn, but what stops
beside it joins its outline little by little. The box of a taxi that waited at a line crept by .03
to .05 as motorcycles came up beside it, and turning_car drives .3 to .4."""
_LARGEST_JUMP = 0.4
"""Change of a side, in extents, from which a look is left out, as something else has joined the
outline: a car that turns within a second unfolds by .27 in `_EVERY`."""
_LEAST_BEYOND = -0.5
"""Least distance of an outline's sides beyond the box's, in extents: further inside parts of the
outline are missing. A box that stays on one end has up to .4 of road beyond that end."""
_SINCE = 0.27
"""Time, s, for which a ghost has to stand to be no part of the outline: eight frames at 30 Hz. A
vehicle that moves by its length in 5 s moves by a twentieth of it meanwhile, some px."""


class Look(NamedTuple):
    """A look at the outline.

    Attributes
    ----------
    age : float
        Time from it to the last look, s.
    beyond : (2, 2) array
        How far the outline reached beyond the low and high sides of the box, in its extents.
    position : (2,) array
        Centre of the box, px.
    """

    age: float
    beyond: Array
    position: Array


class Unfolding(NamedTuple):
    """The last looks at the outline of a vehicle in full view.

    Attributes
    ----------
    looks : tuple of Look
        These looks, oldest first.
    since : float
        Time since the last of them, s.
    outline : Outline or None
        The outline, if it proves that a side unfolds.
    ghosts : int
        Frames for which ghosts have stood that were left out of it.
    """

    looks: tuple[Look, ...] = ()
    since: float = 0.0
    outline: Outline | None = None
    ghosts: int = 0

    def looked(
        self, foreground: Foreground, position: Array, size: Array, times: tuple[float, float]
    ) -> Unfolding:
        """Look at the present frame, in which the box has this centre and size, px.

        Parameters
        ----------
        times : pair of float
            Frame periods since the frame before, and the period, s.
        """
        elapsed, period = times
        # Outlines cost time: they are not asked for in each frame.
        since = self.since + elapsed * period
        if since < _EVERY:
            return self._replace(since=since)
        ghosts = max(round(_SINCE / period), 1)
        # In a row: a look that tells nothing begins anew.
        found = self._found(foreground, position, size, ghosts)
        if found is None:
            return Unfolding()
        outline, beyond = found
        aged = (look._replace(age=look.age + since) for look in self.looks)
        looks = tuple(look for look in aged if look.age < _KEPT)
        if not looks:
            # With the vehicle alone: as one that has joined its outline parts again, it grows, too.
            is_alone = outline.size.prod() <= MOST_COVERED * size.prod()
            return Unfolding((Look(0.0, beyond, position),)) if is_alone else Unfolding()
        # Left out, since the outline is the vehicle's again once the other one has parted.
        if np.abs(beyond - looks[-1].beyond).max() > _LARGEST_JUMP:
            return Unfolding(looks)
        looks = (*looks, Look(0.0, beyond, position))
        end, axis = divmod(int(beyond.argmax()), 2)
        return Unfolding(looks, 0.0, outline if _grows(looks, size, end, axis) else None, ghosts)

    def _found(
        self, foreground: Foreground, position: Array, size: Array, ghosts: int
    ) -> tuple[Outline, Array] | None:
        """Find the outline of what moves in the box, and how far it reaches beyond; see `Look`."""
        extent = float(np.sqrt(size.prod()))
        low = position - size / 2
        high = position + size / 2
        places = [(low, high)]
        # Twice as long as the box, the outline lies mostly outside: it is carried along with it.
        if self.looks:
            first, last = np.maximum(self.looks[-1].beyond, 0) * extent
            places.append((low - first, high + last))
        for left, right in places:
            outline = foreground.moving_outline((left + right) / 2, right - left, ghosts)
            if outline is not None:
                beyond = np.array([low - outline.low, outline.high - high]) / extent
                if beyond.min() >= _LEAST_BEYOND:
                    return outline, beyond
        return None

    def branch(self, motion: PerspectiveMotion, size: Array) -> Branch | None:
        """Follow the outline of a vehicle of this size, px, as in a turn; None: it proves none."""
        if self.outline is None:
            return None
        # What was beyond the box is vehicle and shadow: the outline is the box until the filter
        # takes over.
        margins = (np.zeros(2), np.zeros(2))
        velocity = motion.velocity
        branch = Branch(motion, size, margins, self.outline, velocity, is_proven=True)
        return branch._replace(since=self.ghosts)


def _grows(looks: tuple[Look, ...], size: Array, end: int, axis: int) -> bool:
    """Test whether an outline has grown beyond one end of a box that drives, little by little."""
    beyond = np.array([look.beyond for look in looks])
    # What comes back inside the box was missing before.
    ahead = np.maximum(beyond[:, end, axis], 0)
    # The usual case first: nothing has grown.
    before = np.flatnonzero(ahead[-1] - ahead >= _GROWN)
    if not len(before):
        return False
    # Since that growth has begun to show: it may have driven up to where it stands.
    driven = looks[-1].position - looks[before[-1] + 1].position
    if np.hypot(*(driven / size)) < _DRIVEN:
        return False
    behind = beyond[:, 1 - end, axis]
    # Since any of the earlier looks: how long a turn takes is not known.
    for first, look in enumerate(looks):
        if look.age < _LASTS:
            break
        grown = ahead[-1] - ahead[first]
        largest = _LARGEST_PART * grown
        steps = np.abs(np.diff(ahead[first:])).max()
        other = abs(behind[-1] - behind[first])
        if grown >= _GROWN and steps <= largest and other <= largest:
            return True
    return False

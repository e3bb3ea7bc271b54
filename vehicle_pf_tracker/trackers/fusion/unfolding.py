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
from vehicle_pf_tracker.image.motion.foreground import Around, Foreground, Outline
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion
from vehicle_pf_tracker.trackers.fusion.turning import Branch

_EVERY = 0.125
"""Least time between two looks, s: four frames at 30 Hz, since outlines cost time."""
_LASTS = 0.66
"""Least time over which an outline has to grow, s, the 20 frames at 30 Hz of a turn by 90 degrees
(scene `turn`). With .4 the ghost of where a drawn lorry started counts as a side of it."""
_KEPT = 2.6
"""Age of the oldest look that is compared with, s, a choice: a slower turn is not waited for."""
_GROWN = 0.3
"""Growth at one end that proves it, fraction of the box: an outline is good to a tenth at each end.
From .2 to .3 the same of 45 sequences have it."""
_LARGEST_PART = 0.5
"""Largest part of that growth from one look to the next, since what joins an outline does so at
once; and at the other end, since a box that is too small at both ends is followed by the response.
A choice."""
LEAST_BEYOND = -0.2
"""Least distance of an outline's sides beyond the box's, fraction of it, a choice: further inside
parts of the outline are missing."""
_DRIVEN = 0.1
"""Least way of the box meanwhile, fraction of its size: what stands does not turn, but what stops
beside it joins its outline little by little. The box of a taxi that waited at a line crept by .03
to .05 as motorcycles came up beside it, and turning_car drives .3 to .4."""
_AGO = 0.27
"""Time before, s, with which the part beyond the box is compared: eight frames at 30 Hz."""
_LEAST_CHANGED = 0.3
"""Least share of the far half of that part that has changed since, relative to that of the box. The
vehicle left a ghost's far half long ago: a drawn lorry's (scene `turn` at 2 px per frame) changes
by .28 and less after 28 frames. Chosen on it and on turning_car (.39 to .46)."""


class Look(NamedTuple):
    """A look at the outline.

    Attributes
    ----------
    age : float
        Time from it to the last look, s.
    beyond : (2, 2) array
        How far the outline reached beyond the low and high sides of the box, fractions of it.
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
    around : Around or None
        What moves around the box in the present frame, where that was looked at.
    """

    looks: tuple[Look, ...] = ()
    since: float = 0.0
    outline: Outline | None = None
    around: Around | None = None

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
            return self._replace(since=since, around=None)
        around = foreground.around(position, size)
        outline = around and around.outline(position, size)
        # In a row: a look that tells nothing begins anew.
        if outline is None:
            return Unfolding(around=around)
        low = position - size / 2
        high = position + size / 2
        beyond = np.array([low - outline.low, outline.high - high]) / size
        end, axis = divmod(int(beyond.argmax()), 2)
        ago = max(round(_AGO / period), 1)
        if beyond.min() < LEAST_BEYOND or not _moves(
            foreground, outline, (low, high), (end, axis), ago
        ):
            return Unfolding(around=around)
        aged = (look._replace(age=look.age + since) for look in self.looks)
        looks = (*(look for look in aged if look.age < _KEPT), Look(0.0, beyond, position))
        has_grown = _grows(looks, size, end, axis)
        return Unfolding(looks, 0.0, outline if has_grown else None, around)

    def branch(self, motion: PerspectiveMotion, size: Array) -> Branch | None:
        """Follow the outline of a vehicle of this size, px, as in a turn; None: it proves none."""
        if self.outline is None:
            return None
        # What was beyond the box is vehicle and shadow: the outline is the box until the filter
        # takes over.
        margins = (np.zeros(2), np.zeros(2))
        return Branch(motion, size, margins, self.outline, motion.velocity, is_proven=True)


def _moves(
    foreground: Foreground,
    outline: Outline,
    box: tuple[Array, Array],
    place: tuple[int, int],
    ago: int,
) -> bool:
    """Test whether the far half of what is beyond one end of the box changes like the box.

    Since some frames `ago`; `place` is the end, 0 or 1, and the axis.
    """
    low, high = box
    end, axis = place
    far = np.array([outline.low, outline.high])
    far[1 - end, axis] = (far[end, axis] + box[end][axis]) / 2
    inside = foreground.changed(low, high, ago)
    # Both are 0 where not enough frames are kept.
    return 0 < _LEAST_CHANGED * inside <= foreground.changed(far[0], far[1], ago)


def _grows(looks: tuple[Look, ...], size: Array, end: int, axis: int) -> bool:
    """Test whether an outline has grown beyond one end of a box that drives, little by little."""
    beyond = np.array([look.beyond for look in looks])
    ahead = beyond[:, end, axis]
    behind = beyond[:, 1 - end, axis]
    # Since any of the earlier looks: how long a turn takes is not known.
    for first, look in enumerate(looks):
        if look.age < _LASTS:
            break
        grown = ahead[-1] - ahead[first]
        largest = _LARGEST_PART * grown
        steps = np.abs(np.diff(ahead[first:])).max()
        other = abs(behind[-1] - behind[first])
        driven = np.hypot(*((looks[-1].position - look.position) / size))
        if grown >= _GROWN and steps <= largest and other <= largest and driven >= _DRIVEN:
            return True
    return False

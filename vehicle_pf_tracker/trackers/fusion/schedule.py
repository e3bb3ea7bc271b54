# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The schedule of a step's costly tasks: all of them, but in undisturbed frames in turns."""

from __future__ import annotations

from typing import NamedTuple

UNDISTURBED = 0.9
"""Response, and share of the surface, above which a frame is undisturbed: the size is followed in
one, flow judged and appearance learnt in the next. That saves a quarter of the time and costs
nothing over 633 runs; from .8 up it costs .01 on target. Only then is a size believed, too, as an
occluder shrinks the box first: .85 to .95 predict sizes as well (laboratory/notes/fusion_tried.md).
"""
_SETTLED = 10
"""Frames before which none is undisturbed: the usual response follows the first ones as their mean,
and is not known yet. Ten is a choice: by then a frame weighs a tenth in that mean."""


class Tasks(NamedTuple):
    """Costly tasks of a frame.

    Attributes
    ----------
    follows_size : bool
        True in a frame that tracks points and follows the size.
    trains_filter : bool
        True in a frame that judges the surface's flow and trains the filter.
    """

    follows_size: bool = True
    trains_filter: bool = True

    def next(self, frames: int, level: float, *, was_visible: bool) -> Tasks:
        """Choose the tasks of the frame after these.

        Parameters
        ----------
        frames : int
            Frames since the first one.
        level : float
            The lower of response and share of the surface; 0 where either is not reliable.
        was_visible : bool
            True if all of the vehicle was visible in the frame before.
        """
        # The frame after a disturbance has both tasks: an occlusion or a turn must not find the
        # filter, or the size, a frame older than need be.
        alternates = was_visible and frames > _SETTLED and level > UNDISTURBED
        # The other one of the last: after a frame with both, the size is followed first.
        trains = not alternates or not self.trains_filter
        return Tasks(follows_size=not alternates or not trains, trains_filter=trains)

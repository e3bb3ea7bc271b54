# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The schedule of a step's costly tasks: all of them, but in undisturbed frames in turns."""

from __future__ import annotations

from typing import NamedTuple

_UNDISTURBED = 0.9
"""Response, and share of the surface, above which a frame is undisturbed: the size is followed in
one, flow judged and appearance learnt in the next. That saves a quarter of the time and costs
nothing over 633 runs; from .8 up it costs .01 on target (laboratory/notes/fusion_tried.md)."""
_SETTLED = 10
"""Frames before which none is undisturbed: the usual response follows the first ones as their mean,
and is not known yet."""


class Tasks(NamedTuple):
    """Costly tasks of a frame.

    Attributes
    ----------
    follows_size : bool
        To track points and follow the size.
    trains_filter : bool
        To judge the surface's flow and train the filter.
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
        alternates = was_visible and frames > _SETTLED and level > _UNDISTURBED
        trains = not alternates or not self.trains_filter
        return Tasks(follows_size=not alternates or not trains, trains_filter=trains)

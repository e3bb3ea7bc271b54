# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The verdict of a step on the vehicle's visibility: one of five, each with what it needs.

Hidden is what docs/fusion.md calls occluded.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from vehicle_pf_tracker.trackers.fusion.departure import Departure
from vehicle_pf_tracker.trackers.fusion.followed_by_camera import Followed
from vehicle_pf_tracker.trackers.fusion.turning import Outlines

WHOLE_AT_FIRST = 0.99
"""Probability of `Wholeness` in the first frame, whose box is given: 2 frames of no share at all,
at a log ratio of -3 each, make it partly hidden, and not a single one."""


class Visible(NamedTuple):
    """All of the vehicle is visible: climb to the peak, follow the size, learn.

    Attributes
    ----------
    whole : float
        Probability that all of it is visible, given that a part of it is.
    """

    whole: float = WHOLE_AT_FIRST


class PartlyHidden(NamedTuple):
    """A part of the vehicle is visible: climb to the peak, predict the size, seldom learn.

    It is learnt from only where flow shows a turn (`follow._learn_appearance`).

    Attributes
    ----------
    whole : float
        Probability that all of it is visible nevertheless.
    """

    whole: float


class Turning(NamedTuple):
    """The vehicle turns, as its outline proves: follow the outline, learn fast.

    Attributes
    ----------
    outlines : Outlines
        Outlines of what moves; one is proven to be the vehicle's.
    """

    outlines: Outlines


class Hidden(NamedTuple):
    """Nothing of the vehicle is visible: predict along the road, and wait for evidence.

    Attributes
    ----------
    outlines : Outlines
        Outlines that may turn out to be those of the vehicle.
    followed : Followed or None
        How far a camera that moved as the vehicle was hidden follows it; None where it stood.
    """

    outlines: Outlines = Outlines()
    followed: Followed | None = None


class Gone(NamedTuple):
    """The vehicle has left: wait until something comes back from there.

    Attributes
    ----------
    departure : Departure
        Place and reason of the departure, and the search for a return.
    """

    departure: Departure


# One type a verdict instead of flags: what only a hidden vehicle has (outlines) or only one that
# left (its departure) cannot be left over from an earlier frame.
Verdict: TypeAlias = Visible | PartlyHidden | Turning | Hidden | Gone
"""Judgement on the vehicle in a frame, which decides what the rest of the step does."""


def without_outlines(verdict: Verdict, whole: float) -> Verdict:
    """Return the verdict where outlines have ended with the background.

    `whole` is the probability that all of a visible vehicle is visible.
    """
    match verdict:
        case Turning():  # what it was followed by is lost, and the vehicle still in sight
            return PartlyHidden(whole)
        case Hidden(followed=followed):
            return Hidden(followed=followed)
    return verdict

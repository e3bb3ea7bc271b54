# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drives that prove a vehicle: far enough, and straight at constant speed."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.state import Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

_PART_OF_DRIVE = 0.5
"""Displacement of two edges, in shares of `birth.displacement`, above which a shape may be a
vehicle, by its scores or by its centre's displacement: without this a clock's digits and holes have
numbers, and with all of it vehicles behind a bridge are followed worse."""
_SURELY_DRIVES = 50.0
"""Evidence for a drive above which scores may be ignored: false alarms side by side reach 35."""
_OWN_WIDTH = 1.0
"""Displacement on such a drive, in widths, from which they are: what creeps by less is a light, or
the box of what is far behind. Not chosen between values."""
_STRAIGHT_ENOUGH = 7.0
"""Evidence for a drive, one in a thousand, above which it is one."""
_STRAIGHT_SHAPE = 18.0
"""The same for shapes in dense images, which come by the dozen where leaves move: of 7 clips by
motion, 50 vehicles and 4 others are as straight."""
_FURTHER_PER_LOG_ODD = 0.5
"""Further displacement, in shares of `birth.displacement`, per log odd of scores against it. A
choice."""
_MOVES = 3.0
"""Standard deviations of speed above which a vehicle drives: in 2-D 1 in 90 that stand is there."""


def are_moving(tracks: Tracks) -> Bools:
    """Find tracks (N,) that drive now, by their corrected speeds."""
    return np.asarray(tracks.drives.gaussians.speed_ratio > _MOVES)


def moved_as_a_whole(tracks: Tracks, step: Step) -> Bools:
    """Find tracks (N,) of which two edges or more have moved by part of a drive."""
    shared = tracks.beliefs.paths.shared_lengths(tracks.edges, step.measurement)
    return np.asarray(shared > _PART_OF_DRIVE * step.parameters.birth.displacement)


def have_driven(tracks: Tracks, step: Step, *, are_shapes: bool = False) -> Bools:
    """Find tracks (N,) whose paths show that they are no part of the scene.

    Parameters
    ----------
    tracks : Tracks
        Tracks.
    step : Step
        The frame, and inputs that all parts of a step share.
    are_shapes : bool
        Their detections are shapes, whose scores tell nothing of their drive.
    """
    paths = tracks.beliefs.paths
    lengths = paths.lengths(tracks.edges)
    evidence = paths.evidence()
    displacement = step.parameters.birth.displacement
    if are_shapes:
        # A swing of leaves is straight in as many images as see it: of fewer less is asked.
        straight = max(_STRAIGHT_SHAPE / step.sparsity, _STRAIGHT_ENOUGH)
        # The centre of what stands moves, too, as one edge of it does.
        moves = moved_as_a_whole(tracks, step)
        return np.asarray(moves & (lengths > displacement) & (evidence > straight))
    # A stand whose boxes shook by too much to be told lies on no line with the drive; shapes, which
    # are of what has changed, do not stand.
    evidence = np.maximum(evidence, paths.latest_evidence())
    # False alarms side by side look like a short drive.
    is_sure = (evidence >= _SURELY_DRIVES) & (lengths >= _OWN_WIDTH)
    doubt = np.where(is_sure, 0.0, tracks.beliefs.doubt)
    needed = displacement * (1 + _FURTHER_PER_LOG_ODD * doubt)
    return np.asarray((lengths > needed) & (evidence > _STRAIGHT_ENOUGH))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""End of tracks that are no vehicles, or have left, and loss of those that nothing predicts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import inside_image
from vehicle_pf_tracker.trackers.traffic.driving import have_driven
from vehicle_pf_tracker.trackers.traffic.existence import CERTAIN_LOG_ODDS
from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.state import Experience, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

_REFUTED = -3.0
"""Log odds, one in twenty, below which a vehicle ends: as much against it as the surest detection
tells for it."""
_LEAVES = 0.5
"""Share in the image below which an unseen vehicle has left it: most of it is outside."""
_LEFT = 0.1
"""Share in the image below which a vehicle is forgotten: none of it will be seen."""
_DRIVE_MATCHES = 4
"""Detections of a track below which its path shows no drive: fewer lie on a line by chance."""
_PATIENCE = 4
"""Detections that a tentative track may expect to have missed in a row before it is given up. By
looks: a detector may look at every third image only."""


def end_tracks(state: State, step: Step) -> State:
    """End tracks that are no vehicles, or have left; the horizon is learnt from the others."""
    tracks = state.tracks
    experience = state.experience
    # 1. Shares in the image are taken anew: corrections and holds have moved the boxes.
    inside = inside_image(tracks.edges, step.size)
    goes_on = _goes_on(tracks, inside, experience, step)
    tracks = _with_lost(tracks, step)
    if goes_on.all():
        return state._replace(tracks=tracks)
    # 2. Tentative tracks that end were false alarms, and teach how such look. What drove may have
    # been a vehicle, and tells nothing about its detections: by the same bounds as for a number,
    # as of shapes that are less straight seven in eight are leaves or light.
    are_shapes = experience.detections.are_shapes
    never_drove = tracks.beliefs.paths.matches < _DRIVE_MATCHES
    never_drove |= ~have_driven(tracks, step, are_shapes=are_shapes)
    for row in np.flatnonzero(~goes_on & ~tracks.confirmed & never_drove).tolist():
        experience.detections.learn(tracks.beliefs.samples[row], False)
    # 3. Vehicles teach the horizon once each, when all of their growth is known, and how fast new
    # ones may be.
    ends = tracks.confirmed & ~goes_on
    grown = tracks.drives.growths.take(ends)
    horizon = state.horizon.learnt(grown, step.size[1], step.sparsity)
    drove = tracks.drives.gaussians.take(ends & tracks.beliefs.has_driven)
    # Per second: the interval of images may change.
    experience.speeds.learn(drove.speeds(step.motion.focal) / step.period)
    return state._replace(tracks=tracks.take(goes_on), horizon=horizon)


def _goes_on(tracks: Tracks, inside: Array, experience: Experience, step: Step) -> Bools:
    """Find tracks that go on, by the shares (N,) of their boxes in the image."""
    absences = tracks.absences
    log_odds = tracks.beliefs.log_odds
    parameters = step.parameters
    waits = absences.searched <= _PATIENCE / experience.rate.share
    tentative = waits & (log_odds >= -CERTAIN_LOG_ODDS) & (inside > 0)  # no memory of one that left
    # Misses refute no vehicle that has driven and is seen by nothing: what hides it may be unknown,
    # as a bridge is. Shapes are refuted even so, as many were pieces.
    hidden = tracks.beliefs.has_driven & ~absences.seen
    hidden &= not experience.detections.are_shapes
    # What is detected in this image has not left it: the box of a vehicle that passes close by is
    # larger than what is seen of it, and a new one would get a number of its own.
    in_image = (inside >= _LEFT) | (tracks.detected & (inside > 0))
    known = in_image & (hidden | (log_odds >= _REFUTED))
    longest = parameters.lost_after + parameters.forgotten_after  # predicted, then kept in mind
    remembered = absences.unseen * step.period <= longest
    return remembered & np.where(tracks.confirmed, known, tentative)


def _with_lost(tracks: Tracks, step: Step) -> Tracks:
    """Say of which vehicles nothing is predicted any more."""
    absences = tracks.absences
    is_old = absences.unseen * step.period > step.parameters.lost_after
    has_left = (tracks.visibility.inside < _LEAVES) & ~absences.seen
    lost = is_old | has_left | (tracks.beliefs.log_odds < 0)
    return replace(tracks, absences=replace(absences, lost=lost))

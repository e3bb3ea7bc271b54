# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates of a frame: what is said of each vehicle."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.traffic.estimate import (
    BORDER_OCCLUDER,
    SCENE_OCCLUDER,
    TrackEstimate,
    TrackMode,
)
from vehicle_pf_tracker.trackers.traffic.tracks import Drives, Tracks

_MOSTLY_INSIDE = 0.5
"""Share in the image above which no border hides a vehicle: most of it is inside."""
_PLACED = {
    TrackMode.TENTATIVE: 1.0,
    TrackMode.TRACKING: 1.0,
    TrackMode.OCCLUDED: 0.5,
    TrackMode.LOST: 0.5,
}
"""Factor on the confidence, by mode: a vehicle that nobody sees is there, but where is a guess. At
a half, a threshold of .5 leaves predicted boxes out."""


def estimates_of(tracks: Tracks) -> tuple[TrackEstimate, ...]:
    """Estimates of all tracks, by identity, tentative ones last."""
    # Lists, not arrays: estimates are of plain numbers.
    names = tracks.names
    gaussians = tracks.drives.gaussians
    modes = _modes(tracks)
    identities = names.identity.tolist()
    serials = names.serial.tolist()
    joined = names.joined.tolist()
    boxes = _boxes(tracks.drives).tolist()
    velocities = gaussians.velocity.tolist()
    feet = gaussians.foot_covariance.tolist()
    log_odds = tracks.beliefs.log_odds.tolist()
    ages = tracks.beliefs.paths.age.tolist()
    scores = tracks.latest.score.tolist()
    hiders = _hiders(tracks, modes)
    # Rows are sorted by distance; readers get them by number.
    order = np.lexsort((names.serial, names.identity, ~tracks.confirmed))
    return tuple(
        TrackEstimate(
            identity=identities[row],
            box=Box(*boxes[row]),
            velocity=tuple(velocities[row]),
            mode=modes[row],
            confidence=_PLACED[modes[row]] / (1 + math.exp(-log_odds[row])),
            label=_label(names.votes[row]),
            # One object for all: estimates of two runs are equal only if their NaN is the same.
            score=math.nan if math.isnan(scores[row]) else scores[row],
            age=ages[row],
            hidden_by=hiders[row],
            serial=serials[row],
            joined=joined[row],
            foot_covariance=tuple(feet[row]),
        )
        for row in order.tolist()
    )


def _label(votes: Mapping[str, int]) -> str:
    """Class with the most votes, of equally many the first seen; "" without votes."""
    return max(votes, key=votes.__getitem__) if votes else ""


def _boxes(drives: Drives) -> Array:
    """Boxes (N, 4): left, top, width and height, px."""
    # With the lag the box is where detections are; the state stays smooth for the prediction.
    boxes = drives.gaussians.edges + drives.lag
    # A box has a size even where an unsure prediction has none.
    boxes[:, 2:] = np.maximum(boxes[:, 2:] - boxes[:, :2], 1.0)
    return boxes


def _modes(tracks: Tracks) -> list[TrackMode]:
    """Claims about the vehicles."""
    absences = tracks.absences
    facts = zip(
        tracks.confirmed.tolist(),
        absences.lost.tolist(),
        absences.seen.tolist(),
        strict=True,
    )
    return [_mode(*each) for each in facts]


def _mode(is_confirmed: bool, is_lost: bool, is_seen: bool) -> TrackMode:
    if not is_confirmed:
        return TrackMode.TENTATIVE
    # First: pixels may still hold one that is rather not there.
    if is_lost:
        return TrackMode.LOST
    return TrackMode.TRACKING if is_seen else TrackMode.OCCLUDED


def _hiders(tracks: Tracks, modes: list[TrackMode]) -> list[int | str | None]:
    """Say what hides each hidden vehicle: another one, or else the scene or the border."""
    visibility = tracks.visibility
    rows = zip(modes, visibility.hidden_by.tolist(), visibility.inside.tolist(), strict=True)
    return [_hider(*each) for each in rows]


def _hider(mode: TrackMode, identity: int, inside: float) -> int | str | None:
    if mode not in (TrackMode.OCCLUDED, TrackMode.LOST):
        return None
    # Zero is no identity: nothing that is followed hides it.
    return identity or (SCENE_OCCLUDER if inside >= _MOSTLY_INSIDE else BORDER_OCCLUDER)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence against vehicles: detections that are missed in plain sight."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.state import DENSE, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import IN_SIGHT, Absences

_MISSED = 0.3
"""Log odds that a detection missed in plain sight takes off a vehicle: something unknown may hide
it, so that only 25 take off all that it can have."""
_BLIND_FROM = 2
"""Vehicles in sight, all missed in one image, by which the detector failed: all do not vanish."""
_BLIND_FOR = 150.0
"""Nominal periods after which an undetected vehicle is doubted even so: 5 s at 30 Hz. A choice."""


def count_misses(state: State, step: Step) -> State:
    """Take off evidence from tracks that a detector has missed in plain sight."""
    tracks = state.tracks
    elapsed = step.elapsed
    confirmed = tracks.confirmed
    detected = tracks.detected
    # The image counts for all that the detector has not found in it.
    searched = np.where(detected, 0, tracks.absences.searched + 1)
    absences = replace(tracks.absences, searched=searched)
    tracks = replace(tracks, absences=absences)
    # 1. A detector that misses all it could see has failed, and says nothing.
    in_sight = tracks.in_sight
    is_seen = absences.seen
    watched = confirmed & is_seen & (absences.undetected <= _BLIND_FOR) & in_sight
    # All at once: of two that were missed one after the other it saw the second one meanwhile, and
    # boxes that pixels hold on an empty road would excuse each other.
    watched &= absences.undetected == absences.undetected[watched].min(initial=np.inf)
    if not (confirmed & detected).any() and watched.sum() >= _BLIND_FROM:
        return state._replace(tracks=tracks)
    # 2. Confirmed: a fixed price, the unknown may hide it. Tentative: a sequential test.
    asked = tracks.beliefs.has_driven & in_sight & is_seen
    rates = state.experience.rate.learn(asked, detected)
    missed = ~detected & in_sight & ~(tracks.names.by_hand & is_seen)
    loss = np.zeros(len(tracks))
    # Also of what pixels alone hold at the border, where most of it is outside: too little to ask
    # the detector for it, but road that stands would hold the box of one that has left for ever.
    is_uncovered = tracks.visibility.uncovered > IN_SIGHT
    at_border = ~detected & is_seen & is_uncovered & ~tracks.names.by_hand
    priced = (missed | at_border) & confirmed
    if priced.any():
        loss[priced] = np.maximum(elapsed * _MISSED, _sparse_price(absences, rates, step))[priced]
    for row in (missed & ~confirmed).nonzero()[0].tolist():
        loss[row] = elapsed * -math.log(1 - rates[row])
    beliefs = replace(tracks.beliefs, log_odds=tracks.beliefs.log_odds - loss)
    return state._replace(tracks=replace(tracks, beliefs=beliefs))


def _sparse_price(absences: Absences, rates: Array, step: Step) -> Array:
    """Log odds (N,) that a miss takes off where the detector rarely looks.

    Misses in dense images have one cause, and tell the less the more there are in a second; rare
    ones are independent, and each tells what a detection would have; `rates` (N,) are the shares
    of vehicles that the detector finds.
    """
    images = np.maximum(absences.searched, 1)
    seconds = absences.undetected * step.period / images
    return np.asarray(np.minimum(_MISSED * seconds / DENSE, -np.log(1 - rates)))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Prediction of all vehicles along the road, from one frame to the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.trackers.traffic.state import State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks


def find_horizon(state: State, step: Step) -> State:
    """Find the row of the horizon by the vehicles that have grown so far."""
    # Tentative tracks may be leaves, whose boxes grow by chance.
    followed = state.tracks.drives.growths.take(state.tracks.confirmed)
    assumed = step.parameters.motion.horizon
    horizon = state.horizon.updated(assumed, followed, step.size, step.road, step.sparsity)
    return state._replace(horizon=horizon)


def predict(state: State, step: Step) -> State:
    """Let all vehicles drive on along the road, below the horizon as it is known now."""
    # The horizon first: a state is relative to its row.
    state = find_horizon(state, step)
    tracks = driven(state.tracks, state.horizon.row, step)
    sound = tracks.drives.gaussians.is_sound
    if sound.all():
        return state._replace(tracks=tracks)
    # One NaN among the costs would fail the assignment of all vehicles.
    lost = int(np.count_nonzero(~sound))
    return state._replace(tracks=tracks.take(sound), bad_states=state.bad_states + lost)


def driven(tracks: Tracks, horizon: float, step: Step) -> Tracks:
    """Predict tracks below a horizon (row in px), and let time pass for them."""
    elapsed = step.elapsed
    drives = tracks.drives
    drives = replace(
        drives,
        gaussians=drives.gaussians.under(horizon).driven(elapsed, step.motion),
        # The edges before this prediction: points of pixels start there.
        before=drives.gaussians.edges,
        # Lag and score are of one frame's detection, and void until the next.
        lag=np.zeros_like(drives.lag),
    )
    # Both count from zero, which only a detection, or pixels (`unseen`), set again.
    absences = replace(
        tracks.absences,
        unseen=tracks.absences.unseen + elapsed,
        undetected=tracks.absences.undetected + elapsed,
    )
    latest = replace(tracks.latest, score=np.full(len(tracks), np.nan))
    beliefs = replace(tracks.beliefs, paths=tracks.beliefs.paths.older(elapsed))
    return replace(tracks, drives=drives, beliefs=beliefs, absences=absences, latest=latest)

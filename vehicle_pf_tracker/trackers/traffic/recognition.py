# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of vehicles, learnt while they are in plain sight, by which they are known again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.colours import similarities
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.state import State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Appearance

_RATE = 0.25
"""Rate per detection at which colours and their usual similarity are learnt: the latest four count
for two thirds."""


def coloured(appearance: Appearance, colours: Array, rows: Integers | Bools) -> Appearance:
    """Let the colours of those at `rows` follow those (K, BINS) of boxes in plain sight."""
    before = appearance.colours[rows]
    # The first colours count in full: zero is the mark of the unknown, not a colour.
    rate = np.where(before.any(axis=1, keepdims=True), _RATE, 1.0)
    learnt = appearance.colours.copy()
    learnt[rows] = before + rate * (colours - before)
    return replace(appearance, colours=learnt)


def learn_colours(
    state: State, rows: Integers, labels: Sequence[str], score: float, step: Step
) -> State:
    """Learn what vehicles at `rows` look like where they are, and take their classes."""
    tracks = state.tracks.take(rows)
    # What nearer vehicles cover would teach their colours.
    colours = step.colours.histograms(tracks.edges, list(tracks.visibility.covers))
    tracks = replace(
        tracks,
        names=tracks.names.voted(labels),
        appearance=coloured(tracks.appearance, colours, np.arange(len(rows))),
        latest=replace(tracks.latest, score=np.full(len(rows), score)),
    )
    return state._replace(tracks=state.tracks.put(rows, tracks))


def learn_similarity(state: State, step: Step) -> State:
    """Learn the usual similarity of each detected vehicle's colours to those learnt."""
    tracks = state.tracks
    appearance = tracks.appearance
    # Only detected ones: a box that drifts off would teach that low similarities are usual.
    rows = np.flatnonzero(tracks.confirmed & tracks.detected)
    now = step.colours.histograms(tracks.edges[rows], tracks.visibility.covers[rows].tolist())
    usual = appearance.usual_similarity.copy()
    # Vehicles differ in how alike they stay (shade, windows), so that falls are measured from each
    # one's own level.
    usual[rows] += _RATE * (similarities(appearance.colours[rows], now) - usual[rows])
    appearance = replace(appearance, usual_similarity=usual)
    return state._replace(tracks=replace(tracks, appearance=appearance))

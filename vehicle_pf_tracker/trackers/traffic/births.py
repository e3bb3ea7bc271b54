# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""New tracks, each of a box that is no known vehicle's."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NO_BOXES, overlaps
from vehicle_pf_tracker.trackers.traffic.association import GATE, assigned
from vehicle_pf_tracker.trackers.traffic.candidates import Candidates
from vehicle_pf_tracker.trackers.traffic.edge_observation import Edge
from vehicle_pf_tracker.trackers.traffic.existence import add_evidence
from vehicle_pf_tracker.trackers.traffic.first_state import first_gaussians
from vehicle_pf_tracker.trackers.traffic.parts import have_rest
from vehicle_pf_tracker.trackers.traffic.rows import Integers
from vehicle_pf_tracker.trackers.traffic.state import State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

_NEW_VEHICLES = 0.1
"""Vehicles that come into view per image, as false alarms are: one in a third of a second at 30 Hz.
A choice, the prior of the test against clutter."""
_SIDES = [Edge.LEFT, Edge.RIGHT]
"""Borders at which vehicles come in that drive across. Chosen on one clip, *highway* behind a
bridge."""
_GOES_ON = 0.5
"""Overlap with the prediction of a track that is not yet confirmed from which a shape may be the
same vehicle: no other is as near. A choice, as in `association`."""


def begin_tracks(state: State, candidates: Candidates, columns: Integers, step: Step) -> State:
    """Take detections at `columns` for new vehicles, as yet with the evidence of one detection.

    A vehicle that a side of the image cuts goes on from its former track.
    """
    if not len(columns):
        return state
    # 1. Begin, all as if they were new.
    count = len(state.tracks)
    former, new = _continued_at_border(state.tracks, candidates, columns, step)
    state = begin_in_boxes(state, candidates.edges[columns], step)
    rows = np.arange(count, len(state.tracks))
    tracks = state.tracks.take(rows)
    labels = [candidates.labels[column] for column in columns.tolist()]
    # A first box is taken as it is: who hides it is known from the next frame on.
    colours = step.colours.histograms(candidates.edges[columns], [NO_BOXES] * len(columns))
    tracks = replace(
        tracks,
        names=tracks.names.voted(labels),
        appearance=replace(tracks.appearance, colours=colours),
        latest=replace(tracks.latest, score=candidates.scores[columns]),
    )
    # No prediction to fit yet: births against clutter, both per image, are its prior odds.
    fits = math.log(_NEW_VEHICLES) - candidates.clutter[columns]
    # 2. Those that go on have the name, the path and the evidence of before, and no prediction.
    if len(former):
        old = state.tracks.take(former)
        names = tracks.names.put(new, old.names)
        tracks = replace(tracks, names=names, beliefs=tracks.beliefs.put(new, old.beliefs))
        fits[new] = 0.0
    # 3. Believe: what is proven by this is named with its next detection.
    tracks, _ = add_evidence(tracks, candidates, columns, fits, state.experience, step)
    tracks = state.tracks.put(rows, tracks)
    if len(former):
        kept = np.ones(len(tracks), np.bool_)
        kept[former] = False
        tracks = tracks.take(kept)
    return state._replace(tracks=tracks)


def _continued_at_border(
    tracks: Tracks, candidates: Candidates, columns: Integers, step: Step
) -> tuple[Integers, Integers]:
    """Find tracks that go on in new shapes: rows (K,), and indices (K,) into `columns` (N,).

    How large a vehicle is that a side of the image cuts is a guess, and so is its speed: the
    prediction is wrong where it comes in fast, but near. Only for what is not yet confirmed, has no
    detection, and has nothing beside it that could be the rest of it.
    """
    none = np.zeros(0, np.intp)
    waits = ~tracks.confirmed & ~tracks.detected
    if not (candidates.are_shapes and waits.any()):
        return none, none
    was_cut = step.measurement.cut_edges(tracks.latest.detection)[:, _SIDES]
    rows = np.flatnonzero(waits & was_cut.any(axis=1))
    edges = candidates.edges[columns]
    is_cut = step.measurement.cut_edges(edges)[:, _SIDES]
    free = np.flatnonzero(is_cut.any(axis=1) & ~have_rest(edges, candidates.edges))
    if not (len(rows) and len(free)):
        return none, none
    shared = overlaps(tracks.edges[rows][:, np.newaxis], edges[free])
    # By the same border: a vehicle does not go from one to the other.
    both = (was_cut[rows][:, np.newaxis] & is_cut[free]).any(axis=2)
    costs = np.where(both & (shared > _GOES_ON), GATE * (1 - shared), GATE)
    pairs = assigned(rows, free, costs, shared)
    return pairs.rows, pairs.columns


def begin_in_boxes(state: State, edges: Array, step: Step) -> State:
    """Begin tracks in boxes (K, 4) in px."""
    # A horizon below the box would have it drive on the sky.
    horizon = np.minimum(state.horizon.row, edges[:, Edge.BOTTOM] - 1)
    speeds = _possible_speeds(state, step)
    gaussians = first_gaussians(edges, step.measurement, horizon, step.motion, speeds)
    # Tracks are numbered from birth, vehicles from confirmation: a serial orders ties.
    serials = state.last_serial + 1 + np.arange(len(edges))
    tracks = state.tracks.extended(Tracks.begun(gaussians, serials, np.zeros_like(edges)))
    return state._replace(tracks=tracks, last_serial=state.last_serial + len(edges))


def _possible_speeds(state: State, step: Step) -> Array:
    """Covariance (2, 2) of a new vehicle's speed across and along, in squares of `top_speed`."""
    motion = step.motion
    tracks = state.tracks
    followed = tracks.drives.gaussians.take(tracks.confirmed & tracks.beliefs.has_driven)
    speeds = followed.speeds(motion.focal)
    return state.experience.speeds.spread(speeds, motion.top_speed, step.period)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Observation of vehicles: detections are given to them, and those left over may be new ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NO_BOXES
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.association import Pairs, assigned, birth_costs, pair_costs
from vehicle_pf_tracker.trackers.traffic.births import begin_tracks
from vehicle_pf_tracker.trackers.traffic.bodies import updated_companions
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.candidates import Candidates, weigh
from vehicle_pf_tracker.trackers.traffic.correction import correct
from vehicle_pf_tracker.trackers.traffic.existence import add_evidence, position_evidence
from vehicle_pf_tracker.trackers.traffic.identity import merge_returned, number_proven, unify
from vehicle_pf_tracker.trackers.traffic.misses import count_misses
from vehicle_pf_tracker.trackers.traffic.parts import grow_to_enclosing, inside_of, shrink_joined
from vehicle_pf_tracker.trackers.traffic.recognition import coloured
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.state import State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

_LIKELY = 0.0
"""Log odds above which a detection is rather a vehicle than not: even odds."""


class Assignment(NamedTuple):
    """State of the tracker while detections are given to its vehicles.

    Attributes
    ----------
    state : State
        State of the tracker, as corrected so far.
    free : (N,) array
        True for detections that no track has been given yet.
    candidates : Candidates
        The N detections of the frame.
    step : Step
        Input of the step.
    """

    state: State
    free: Bools
    candidates: Candidates
    step: Step


def observe(state: State, step: Step, detections: Detections) -> State:
    """Associate the detections of this frame, correct and doubt tracks, and begin new ones.

    The order of the steps is load-bearing: each works on what those before it left over.
    """
    # 1. Every detection is as likely a vehicle as earlier ones of its score and place have been.
    # The image is counted before: false alarms are a rate per image.
    state.experience.detections.begin_image(are_shapes=detections.are_shapes)
    candidates = weigh(detections.usable(*step.size), state.experience.detections, step.size)
    assignment = Assignment(state, np.ones(len(candidates), np.bool_), candidates, step)
    # 2. Vehicles that are known choose first, and among likely detections first: else a false
    # alarm near by would be taken by one, and its own detection would be left to another.
    # What is left over inside a vehicle that was seen is a part of it. Parts go after each pass:
    # in the second one a bonnet of one vehicle would be a likely detection of its neighbour.
    for least in (_LIKELY, -np.inf):
        assignment = _without_parts(_associate_known(assignment, least))
    # 3. What is not known yet to be a vehicle chooses by density against clutter: whether it is
    # one is not to depend on whether one is expected. After the known ones, as a tentative track
    # beside a vehicle would otherwise take its detection and be confirmed by it.
    assignment = _associate_new(assignment)
    # 4. One vehicle has one number: one that was hidden may have been taken for a new one, and
    # one that was known by a part is not the box around it. Before step 5, since a vehicle that is
    # found again here was not missed.
    if step.parameters.returning:
        assignment = assignment._replace(state=merge_returned(assignment.state))
    assignment = _associate_outgrown(assignment)
    assignment = _unify_bodies(assignment)
    # 5. Only now it is known who was missed, in plain sight.
    assignment = assignment._replace(state=count_misses(assignment.state, step))
    # 6. A box around a vehicle that has its own is no new one either. The others may be. Here
    # missed vehicles count, too: step 4 had the first call on the boxes around them.
    assignment = _without_parts(assignment, either=True)
    return begin_tracks(assignment.state, candidates, np.flatnonzero(assignment.free), step)


def _associate_known(assignment: Assignment, least: float) -> Assignment:
    """Associate free detections of log odds from `least` with vehicles that have none."""
    state, free, candidates, _ = assignment
    rows = np.flatnonzero(state.tracks.confirmed & ~state.tracks.detected)
    columns = np.flatnonzero(free & (candidates.log_odds >= least))
    return _associate(assignment, rows, columns, pair_costs)


def _associate_new(assignment: Assignment) -> Assignment:
    """Associate free detections with tracks that are not known yet to be vehicles."""
    rows = np.flatnonzero(~assignment.state.tracks.confirmed)
    return _associate(assignment, rows, np.flatnonzero(assignment.free), birth_costs)


def _associate_outgrown(assignment: Assignment) -> Assignment:
    """Associate boxes around vehicles that were known by a part only with these."""
    state, free, candidates, _ = assignment
    columns = np.flatnonzero(free)
    if not len(columns):
        return assignment
    tracks, rows = grow_to_enclosing(state.tracks, candidates.edges[columns])
    assignment = assignment._replace(state=state._replace(tracks=tracks))
    return _associate(assignment, rows, columns, pair_costs)


def _associate(
    assignment: Assignment,
    rows: Integers,
    columns: Integers,
    costs_of: Callable[[Tracks, Candidates, Integers, MeasurementModel], tuple[Array, Array]],
) -> Assignment:
    """Update tracks at `rows` by detections at `columns`, in pairs of the least total cost."""
    if not (len(rows) and len(columns)):
        return assignment
    state, _, candidates, step = assignment
    costs, odds = costs_of(state.tracks.take(rows), candidates, columns, step.measurement)
    pairs = assigned(rows, columns, costs, odds)
    return _update(assignment, pairs) if len(pairs.rows) else assignment


def _unify_bodies(assignment: Assignment) -> Assignment:
    """Let a lorry and its cab, which were both detected, be one; shapes are joined as blobs are."""
    state, _, candidates, step = assignment
    if candidates.are_shapes:
        return assignment
    companions = updated_companions(state.companions, state.tracks, step.measurement)
    return assignment._replace(state=unify(state._replace(companions=companions)))


def _update(assignment: Assignment, pairs: Pairs) -> Assignment:
    """Correct tracks by their detections, add the evidence of these, and number new vehicles."""
    state, free, candidates, step = assignment
    rows, columns, fits = pairs
    free = free.copy()
    free[columns] = False
    tracks = state.tracks.take(rows)
    edges = candidates.edges[columns]
    # 1. Divide before correcting: a box of two vehicles would else take the detection of one for a
    # part of itself, and stay too large.
    tracks = replace(tracks, drives=shrink_joined(tracks.drives, edges, candidates.edges))
    tracks, whole = correct(tracks, edges, step.measurement)
    # 2. Learn appearance and growth only from what is seen whole: a covered vehicle has the colours
    # of its occluder, and a width that says nothing about the road.
    tracks = _learn_appearance(tracks, candidates, columns, whole, step)
    # 3. Whether it stands is judged by the corrected speed, and counts for the belief.
    fits = position_evidence(tracks, candidates, columns, fits)
    tracks, proven = add_evidence(tracks, candidates, columns, fits, state.experience, step)
    state = state._replace(tracks=state.tracks.put(rows, tracks))
    # 4. Number last: a vehicle that is found again takes over its new track, whose row then goes,
    # and `rows` would point to others.
    if proven.any():
        every = np.zeros(len(state.tracks), np.bool_)
        every[rows[proven]] = True
        state = number_proven(state, every, returning=step.parameters.returning)
    return assignment._replace(state=state, free=free)


def _learn_appearance(
    tracks: Tracks, candidates: Candidates, columns: Integers, whole: Bools, step: Step
) -> Tracks:
    """Learn what vehicles look like and how they grow from detections that show the `whole`."""
    edges = candidates.edges[columns]
    labels = [candidates.labels[column] for column in columns.tolist()]
    appearance = tracks.appearance
    if whole.any():
        colours = step.colours.histograms(edges[whole], [NO_BOXES] * int(whole.sum()))
        appearance = coloured(appearance, colours, whole)
    # A width that the border cuts grows with the distance from the border, not from the horizon.
    grows = whole & ~step.measurement.cut_edges(edges).any(axis=1)
    growths = tracks.drives.growths.added(edges, grows)
    return replace(
        tracks,
        names=tracks.names.voted(labels),
        drives=replace(tracks.drives, growths=growths),
        appearance=appearance,
        latest=replace(tracks.latest, score=candidates.scores[columns]),
    )


def _without_parts(assignment: Assignment, *, either: bool = False) -> Assignment:
    """Drop free detections inside vehicles, bonnets or second boxes, or `either` in the other."""
    state, free, candidates, _ = assignment
    tracks = state.tracks
    columns = np.flatnonzero(free)
    if not len(columns):
        return assignment
    boxes = tracks.edges[tracks.confirmed & (either | tracks.detected)]
    parts = columns[inside_of(boxes, candidates.edges[columns], either=either)]
    if not len(parts):
        return assignment
    # They stood beside a vehicle: their place is none where false alarms come from nothing.
    state.experience.detections.learn(candidates.samples(parts), False, alone=False)
    free = free.copy()
    free[parts] = False
    return assignment._replace(free=free)

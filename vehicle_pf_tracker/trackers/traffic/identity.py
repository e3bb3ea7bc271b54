# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One number for one vehicle: new ones get one, hidden ones keep theirs, doubles have none.

Before a new vehicle gets a number, it is compared with those that are hidden near by: by distance,
size and colours.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.trackers.traffic.bodies import LONG_DRIVE, MISSED_FOR, SHORT_DRIVE
from vehicle_pf_tracker.trackers.traffic.colours import similarities
from vehicle_pf_tracker.trackers.traffic.existence import CERTAIN_LOG_ODDS
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers, objects
from vehicle_pf_tracker.trackers.traffic.state import State
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks, added_votes

_HIDDEN_FOR = 4.0
"""Nominal periods without a detection from which a vehicle is hidden: fewer come by chance."""
_OUT_OF_SIGHT = 0.5
"""Visible share of a hidden vehicle below which it is still behind another one: most of it is."""
_MOST_GROWN = 2.0
"""Ratio of the areas of two boxes below which they fit one vehicle: it reappears part by
part, and a half is enough to be detected as a whole. A choice."""
_FARTHER_IN = 30.0
"""Nominal periods, one second of 30 Hz, in which the distance at which a hidden vehicle may
reappear grows by its width. A choice: at the usual 2 m/s² it is half a width off by then."""
_NEAR_A_DOUBLE = 0.5
"""Share of that distance within which one that has a number already may be the same: beside a lorry
that hides a car there often is another car."""
_FALL = 0.2
"""Fall of the colours' similarity below its usual value above which it is not the vehicle. A
choice, looser than `pixel_hold` has it: the vehicle comes back in another light."""
_SHARED = 0.5
"""Share of the smaller box that two boxes share above which they are of one vehicle: most of it."""


def number_proven(state: State, proven: Bools, *, returning: bool) -> State:
    """Give tracks that are `proven` to be vehicles (N,) their numbers, one after the other.

    One that was hidden before keeps its number; a second box of another vehicle gets none.
    """
    tracks = state.tracks
    kept = np.ones(len(proven), np.bool_)
    identity = state.last_identity
    are_shapes = state.experience.detections.are_shapes
    rows = np.flatnonzero(proven)
    # Of those that are proven in the same image the one that was seen first gets the lower number.
    for row in rows[np.argsort(tracks.names.serial[rows])].tolist():
        hidden = None
        if returning:
            hidden = find_hidden(tracks, row, tracks.confirmed, are_shapes=are_shapes)
        if hidden is not None:
            # The number stays with the old row, the new one goes: rows are dropped at the end, so
            # that the others keep their indices meanwhile.
            tracks = resume(tracks, hidden, row)
            kept[row] = False
        elif (body := body_of(state._replace(tracks=tracks), row)) is not None:
            # Beside a part that is still detected it is no more than a double at first.
            if _replaces(state._replace(tracks=tracks), body, row):
                tracks = _resume_as_body(tracks, body, row)
                kept[row] = False
        elif not is_double(tracks, row, are_shapes=are_shapes):
            # A double gets no number, and stays tentative.
            identity += 1
            tracks = _numbered(tracks, row, identity)
    tracks = tracks if kept.all() else tracks.take(kept)
    return state._replace(tracks=tracks, last_identity=identity)


def number_by_hand(state: State) -> State:
    """Give the last track, which a user has added, its number."""
    row = len(state.tracks) - 1
    identity = state.last_identity + 1
    tracks = _numbered(state.tracks, row, identity)
    names = tracks.names
    log_odds = tracks.beliefs.log_odds.copy()
    by_hand = names.by_hand.copy()
    log_odds[row] = CERTAIN_LOG_ODDS
    by_hand[row] = True
    names = replace(names, by_hand=by_hand)
    tracks = replace(tracks, names=names, beliefs=replace(tracks.beliefs, log_odds=log_odds))
    return state._replace(tracks=tracks, last_identity=identity)


def _numbered(tracks: Tracks, row: int, identity: int) -> Tracks:
    numbers = tracks.names.identity.copy()
    numbers[row] = identity
    return replace(tracks, names=replace(tracks.names, identity=numbers))


def merge_returned(state: State) -> State:
    """Merge vehicles that were born a second time with the ones that they are."""
    tracks = state.tracks
    age = tracks.beliefs.paths.age
    undetected = tracks.absences.undetected
    # Only who is missed now can have come back under another number.
    missed = tracks.confirmed & ~tracks.detected
    if not missed.any():
        return state
    # A twin is younger than the absence that it ends; a cheap bound before the search.
    young = tracks.confirmed & ~tracks.names.by_hand & (age < undetected[missed].max())
    kept = np.ones(len(tracks), np.bool_)
    are_shapes = state.experience.detections.are_shapes
    for row in np.flatnonzero(young).tolist():
        if not tracks.detected[row]:
            continue
        twin = find_hidden(tracks, row, missed, are_shapes=are_shapes)
        if twin is not None:
            tracks = resume(tracks, twin, row)
            # Either can be merged once: a vehicle has one twin.
            kept[row] = missed[twin] = False
    return state if kept.all() else state._replace(tracks=tracks.take(kept))


def unify(state: State) -> State:
    """Let vehicles that turned out to be one body have one number, that of the elder."""
    tracks = state.tracks
    kept = np.ones(len(tracks), np.bool_)
    confirmed = tracks.confirmed & ~tracks.names.by_hand
    for row in np.flatnonzero(confirmed & tracks.detected).tolist():
        elder = body_of(state._replace(tracks=tracks), row, LONG_DRIVE)
        if elder is not None and kept[elder]:
            tracks = _resume_as_body(tracks, elder, row)
            kept[row] = False
    return state if kept.all() else state._replace(tracks=tracks.take(kept))


def body_of(state: State, row: int, least_drive: float = SHORT_DRIVE) -> int | None:
    """Find the elder vehicle that is one body with the track at `row`, if there is one."""
    names = state.tracks.names
    own = int(names.serial[row])
    for pair, together in state.companions.items():
        if own in pair and together.is_one(least_drive):
            (other,) = np.flatnonzero(names.serial == sum(pair) - own).tolist() or (None,)
            # The lower number is the elder: a track that began first may be confirmed last.
            if other is not None and 0 < names.identity[other] < (names.identity[row] or np.inf):
                return int(other)
    return None


def _replaces(state: State, elder: int, row: int) -> bool:
    """Test whether the vehicle at `elder` goes on as the track at `row`, with which it is one."""
    if state.tracks.absences.searched[elder] >= MISSED_FOR:
        return True
    # Of two boxes that overlap by half either will do.
    size, known = areas(state.tracks.latest.detection[[row, elder]])
    return bool(size > _MOST_GROWN * known) and body_of(state, row, LONG_DRIVE) == elder


def _resume_as_body(tracks: Tracks, elder: int, row: int) -> Tracks:
    """Let the vehicle at `elder` go on in the larger box of its own and the track's at `row`."""
    detections = tracks.latest.detection
    drives = tracks.drives
    larger = row if areas(detections[row]) > areas(detections[elder]) else elder
    new = tracks.take(np.array([larger]))
    tracks = resume(tracks, elder, row)
    # With its growth: that of a part is not the whole's.
    return replace(tracks, drives=drives.put(np.array([elder]), new.drives))


def is_double(tracks: Tracks, row: int, *, are_shapes: bool = False) -> bool:
    """Test whether most of a new vehicle's detection is in that of another one, or reversely.

    Networks give one vehicle two boxes, for many frames on end: of it all and of its front, or with
    and without its shadow. Two vehicles side by side soon show more of each.
    """
    detections = tracks.latest.detection
    # Also in those that a network misses for an image or two; blobs join, and one of two goes.
    is_recent = tracks.absences.searched < MISSED_FOR
    recent = tracks.confirmed & (tracks.detected if are_shapes else is_recent)
    # Latest detections, not states, which follow them with a delay, of those that have one.
    known = np.where(tracks.detected[:, np.newaxis], detections, tracks.edges)
    boxes = known[recent]
    own = detections[row]
    smaller = np.minimum(areas(boxes), areas(own))
    return bool((intersections(own, boxes) > _SHARED * smaller).any())


def find_hidden(tracks: Tracks, row: int, others: Bools, *, are_shapes: bool = False) -> int | None:
    """Find the hidden vehicle, among `others` (N,), that the new one at `row` is, if it is any."""
    undetected = tracks.absences.undetected
    hidden = others & tracks.confirmed & (undetected >= _HIDDEN_FOR)
    # Behind a nearer vehicle it cannot be what was just detected in the open.
    hidden &= tracks.visibility.uncovered >= _OUT_OF_SIGHT
    hidden[row] = False
    is_named = bool(tracks.confirmed[row])
    hidden &= ~_beside(tracks, row)
    rows = np.flatnonzero(hidden)
    appearance = tracks.appearance
    # Without colours nothing but the distance speaks: too little for a number.
    if not len(rows) or not appearance.colours[row].any():
        return None
    distance, ratio = _apart(tracks.edges[row], tracks.edges[rows])
    # The longer it was hidden, the less its prediction is worth.
    distance /= 1 + undetected[rows] / _FARTHER_IN
    may_be = (ratio > 1 / _MOST_GROWN) & (ratio < _MOST_GROWN)
    may_be &= distance <= (_NEAR_A_DOUBLE if is_named else 1.0)
    if is_named and not are_shapes:  # the first shape may have been of several vehicles
        # One that comes from elsewhere, and drives up to where the hidden one is, is another.
        may_be &= _born_away(tracks, row, rows) <= 1.0
    # Colours last: few are near enough to be compared.
    rows = rows[may_be]
    distance = distance[may_be]
    colours = appearance.colours
    fall = appearance.usual_similarity[rows] - similarities(colours[rows], colours[row])
    rows = rows[fall <= _FALL]
    distance = distance[fall <= _FALL]
    if not len(rows):
        return None
    # The nearest, of equally near ones the oldest track, so that runs repeat.
    nearest = np.lexsort((tracks.names.serial[rows], distance))
    return int(rows[nearest[0]])


def _beside(tracks: Tracks, row: int) -> Bools:
    """Find the tracks (N,) beside which the one at `row` was detected: they are other vehicles."""
    together = tracks.beliefs.paths.age[row] - tracks.absences.undetected
    if tracks.confirmed[row]:
        return np.asarray(together >= 0)
    # A new one may have been a second box of the vehicle that it is, which shares most of it.
    detections = tracks.latest.detection
    own = detections[row]
    smaller = np.minimum(areas(detections), areas(own))
    apart = intersections(own, detections) <= _SHARED * smaller
    return np.asarray((together >= _HIDDEN_FOR) & apart)


def _born_away(tracks: Tracks, row: int, hidden: Integers) -> Array:
    """Distance (K,) of the first detection of the new track at `row` from vehicles `hidden` (K,).

    From where each was by then, on the way from its last detection to its prediction; in shares of
    the distance at which it may reappear.
    """
    edges = tracks.edges[hidden]
    last = tracks.latest.detection[hidden]
    # Of a vehicle given by hand, and never detected, only the prediction is known.
    last = np.where((last[:, 2] > last[:, 0])[:, np.newaxis], last, edges)
    undetected = tracks.absences.undetected[hidden]
    paths = tracks.beliefs.paths
    before = np.maximum(undetected - paths.age[row], 0.0)
    share = before / np.maximum(undetected, 1.0)
    then = last + share[:, np.newaxis] * (edges - last)
    distance, _ = _apart(paths.first[row], then)
    return np.asarray(distance / (1 + before / _FARTHER_IN))


def _apart(new: Array, old: Array) -> tuple[Array, Array]:
    """Distance (K,) of a box (4,) from boxes (K, 4) in widths, and ratio (K,) of the areas."""
    size, sizes = (np.maximum(edges[..., 2:] - edges[..., :2], 1.0) for edges in (new, old))
    away = new[:2] + size / 2 - (old[:, :2] + sizes / 2)
    # In the mean of both widths, geometric: neither is known to be the whole one.
    width = np.sqrt(size[0] * sizes[:, 0])
    return np.hypot(*away.T) / width, size.prod() / sizes.prod(axis=1)


def resume(tracks: Tracks, hidden: int, row: int) -> Tracks:
    """Let the vehicle at `hidden` go on as the new track at `row` that it turned out to be."""
    at = np.array([hidden])
    new = tracks.take(np.array([row]))
    old = tracks.take(at)
    # 1. Number, whether given by hand, and growth are the old ones; classes are voted by both.
    votes = added_votes(old.names.votes[0], new.names.votes[0])
    names = replace(old.names, joined=new.names.serial, votes=objects([votes]))
    # 2. Place and speed are the new ones: the old prediction was wrong, or the detections would
    # have been associated with it.
    extents = replace(
        old.drives.extents,
        shown=new.drives.extents.shown,
        partial=new.drives.extents.partial,
    )
    gaussians = new.drives.gaussians
    before = new.drives.before
    drives = replace(old.drives, gaussians=gaussians, before=before, extents=extents)
    # 3. The better of both beliefs: either track is evidence for the same vehicle.
    beliefs = replace(
        old.beliefs,
        has_driven=old.beliefs.has_driven | new.beliefs.has_driven,
        log_odds=np.maximum(old.beliefs.log_odds, new.beliefs.log_odds),
    )
    # 4. Colours are those of before, learnt for longer; the detection is of now.
    resumed_track = Tracks(
        names=names,
        drives=drives,
        beliefs=beliefs,
        visibility=replace(new.visibility, hidden_by=np.zeros(1, np.intp)),
        absences=old.absences.ended(),
        appearance=old.appearance,
        latest=new.latest,
    )
    return tracks.put(at, resumed_track)

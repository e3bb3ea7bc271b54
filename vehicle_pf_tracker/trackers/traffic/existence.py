# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that tracks are vehicles: what detections add to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.candidates import Candidates
from vehicle_pf_tracker.trackers.traffic.driving import (
    are_moving,
    have_driven,
    moved_as_a_whole,
)
from vehicle_pf_tracker.trackers.traffic.parameters import IGNORE_STANDING
from vehicle_pf_tracker.trackers.traffic.parts import have_rest
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.state import Experience, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks

CERTAIN_LOG_ODDS = 7.0
"""Log odds, one in a thousand, beyond which nothing is surer: however long a vehicle was seen, some
missed detections in plain sight speak against it."""
_MOST_PER_DETECTION = 3.0
"""Log odds, one in twenty, that one detection adds at most by its score, and by where it is: no
single one proves a vehicle."""
_SAID_OF_NOTHING = 5.0
"""Log odds, one in 150, against a detection by score and place above which its fit counts for
nothing. Chosen on a jam with poor boxes and behind a bridge."""
_SCORE_DOUBT = 0.5
"""Log odds that one score of dense images takes off at most, so that a detector which knows little
about a vehicle does not hide it for ever; and that are taken off each, in confirming by scores
alone."""
_PROOF_BY_SCORES = 4.0
"""Sum of the log odds of scores that stands for a drive: one in 55, two detections at least."""
_PIECE_FOR = 0.5
"""Time in s before a shape is a vehicle that has a rest beside it, or no straight drive: the pieces
of a blob are soon joined."""
_STANDS = 0.1
"""Displacement, in widths, below which a track has not moved: networks' boxes shake by half of
it."""
_KEPT_SAMPLES = 30
"""Latest detections, one second of 30 Hz, not learnt from until it drives: it may be about to."""


def position_evidence(
    tracks: Tracks, candidates: Candidates, columns: Integers, fits: Array
) -> Array:
    """Bound the log odds (N,) that detections at `columns` are their tracks', by position.

    Where a vehicle stands, any false alarm there would fit: only a drive is evidence. Nor is a fit
    where the detector says the same of nothing, as of lights far behind: some of it always fits.
    """
    stands = tracks.beliefs.has_driven & ~are_moving(tracks)
    bounded = np.minimum(np.maximum(fits, -_MOST_PER_DETECTION), _MOST_PER_DETECTION)
    usual = tracks.confirmed & _score_as_clutter(candidates, columns, _SAID_OF_NOTHING)
    bounded = np.where(usual, np.minimum(bounded, 0.0), bounded)
    return np.where(tracks.confirmed & stands, 0.0, bounded)


def _score_as_clutter(candidates: Candidates, columns: Integers, bound: float) -> Bools:
    """Find detections (N,) of scores that the detector gives, in their places, to what never drove.

    Log odds beyond `bound` are against them. Scores of shapes say how full their boxes are, and
    tell nothing of it.
    """
    if candidates.are_shapes:
        return np.zeros(len(columns), np.bool_)
    return np.asarray(candidates.log_odds[columns] < -bound)


def add_evidence(
    tracks: Tracks,
    candidates: Candidates,
    columns: Integers,
    fits: Array,
    experience: Experience,
    step: Step,
) -> tuple[Tracks, Bools]:
    """Add the evidence of a detection to each track; also return which it proves to be vehicles.

    Parameters
    ----------
    tracks : Tracks
        N tracks, corrected already.
    candidates : Candidates
        Detections of the frame.
    columns : (N,) array
        Which of them each track's is.
    fits : (N,) array
        Log odds by where it is.
    experience : Experience
        Learns what became of detections.
    step : Step
        The frame, and inputs that all parts of a step share.
    """
    edges = candidates.edges[columns]
    # 1. Add the evidence of this detection.
    tracks = _end_absences(tracks, edges)
    tracks, lengths = _with_log_odds(tracks, candidates, columns, fits, step)
    # 2. All evidence makes it ripe, a drive or sure scores prove it.
    beliefs = tracks.beliefs
    is_ripe = tracks.confirmed | (beliefs.log_odds >= step.parameters.birth.evidence)
    now_drives = is_ripe & ~(beliefs.has_driven | tracks.names.by_hand)
    if now_drives.any():
        now_drives &= have_driven(tracks, step, are_shapes=candidates.are_shapes)
    proven = beliefs.strength > _PROOF_BY_SCORES
    if candidates.are_shapes:
        is_old = beliefs.paths.age >= _PIECE_FOR / step.period
        # A piece drives as straight as its vehicle, whose rest is beside it until both are joined.
        now_drives &= is_old | ~have_rest(edges, candidates.edges)
        # Scores say how full they are, and the hole of what has left, or a digit of a clock, is as
        # full image after image: part of a drive besides.
        proven &= is_old & moved_as_a_whole(tracks, step)
    # What has driven stays proven: a second box of another vehicle may part from it later.
    drove = now_drives | beliefs.has_driven
    proven |= drove
    if step.parameters.birth.standing == IGNORE_STANDING:
        proven &= drove | (lengths >= _STANDS)
    # 3. Teach detections only now: what they show depends on the drive.
    tracks = _learn_outcomes(tracks, now_drives, lengths, candidates, columns, experience)
    return tracks, np.asarray(~tracks.confirmed & is_ripe & proven)


def _with_log_odds(
    tracks: Tracks, candidates: Candidates, columns: Integers, fits: Array, step: Step
) -> tuple[Tracks, Array]:
    """Add the evidence of scores, places and paths; also return the paths' lengths (N,).

    See `add_evidence`.
    """
    beliefs = tracks.beliefs
    log_odds = candidates.log_odds[columns]
    # The usual odds of a score count once, at the birth: a new track gains by likelihood ratios.
    gains = np.where(tracks.confirmed, log_odds, candidates.gains[columns])
    # Scores of one spot repeat from image to image, and a second of them says as much at any rate:
    # of fewer each takes off more, but no more than one may add.
    most_doubt = min(_SCORE_DOUBT * step.sparsity, _MOST_PER_DETECTION)
    gains = np.minimum(np.maximum(gains, -most_doubt), _MOST_PER_DETECTION)
    paths = beliefs.paths.added(candidates.edges[columns])
    lengths = paths.lengths(tracks.edges)
    proof = np.where(lengths < _STANDS, candidates.at_rest[columns], log_odds)
    proof = np.minimum(np.maximum(proof - _SCORE_DOUBT, -_SCORE_DOUBT), _MOST_PER_DETECTION)
    strength = beliefs.strength + proof
    stands = paths.stands
    beliefs = replace(
        beliefs,
        log_odds=np.minimum(beliefs.log_odds + gains + fits, CERTAIN_LOG_ODDS),
        # A time of standing is no debt: having stood makes nothing less likely once it drives.
        doubt=np.where(stands, 0.0, np.maximum(beliefs.doubt - gains, 0.0)),
        strength=np.where(stands, np.maximum(strength, 0.0), strength),
        paths=paths,
    )
    return replace(tracks, beliefs=beliefs), lengths


def _end_absences(tracks: Tracks, edges: Array) -> Tracks:
    """End the absences of tracks detected in boxes (N, 4) in px: nothing hides them."""
    return replace(
        tracks,
        visibility=replace(tracks.visibility, hidden_by=np.zeros(len(tracks), np.intp)),
        absences=tracks.absences.ended(),
        latest=replace(tracks.latest, detection=edges),
    )


def _learn_outcomes(
    tracks: Tracks,
    now_drives: Bools,
    lengths: Array,
    candidates: Candidates,
    columns: Integers,
    experience: Experience,
) -> Tracks:
    """Learn from the detections of what has driven, or stands for long."""
    beliefs = tracks.beliefs
    evidence = experience.detections
    settled = beliefs.has_driven | tracks.names.by_hand
    moves = tracks.names.by_hand | are_moving(tracks)
    # A vehicle far away may take clutter for itself, and would teach that this is a vehicle: by
    # what is likelier clutter than any fit can outweigh.
    moves &= ~_score_as_clutter(candidates, columns, _MOST_PER_DETECTION)
    if settled.all():  # the usual case, in one call
        evidence.learn(candidates.samples(columns[moves]), True)
        return tracks
    stands = ~tracks.confirmed & (lengths < _STANDS)
    samples = beliefs.samples.copy()
    rows = zip(settled.tolist(), moves.tolist(), now_drives.tolist(), stands.tolist(), strict=True)
    new = candidates.samples(columns)
    for row, (is_settled, does_move, does_drive, does_stand) in enumerate(rows):
        if is_settled:
            if does_move:  # where it stands, a false alarm would fit, too
                evidence.learn(new[row : row + 1], True)
            continue
        every = (*samples[row], new[row])
        known = len(every) if does_drive else max(len(every) - _KEPT_SAMPLES, 0)
        if does_drive or does_stand:
            evidence.learn(every[:known], does_drive)
        samples[row] = every[known:]
    beliefs = replace(beliefs, has_driven=beliefs.has_driven | now_drives, samples=samples)
    return replace(tracks, beliefs=beliefs)

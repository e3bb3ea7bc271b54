# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that vehicles exist: what detections add to it, and what their absence takes off."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.trackers.traffic.box_edges import INWARD_SIGNS, both_ends, sides_of
from vehicle_pf_tracker.trackers.traffic.candidates import Candidates
from vehicle_pf_tracker.trackers.traffic.parameters import IGNORE_STANDING
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.state import DENSE, Experience, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import IN_SIGHT, Absences, Tracks

CERTAIN_LOG_ODDS = 7.0
"""Log odds, one in a thousand, beyond which nothing is surer: however long a vehicle was seen, some
missed detections in plain sight speak against it."""
_MOST = 3.0
"""Log odds, one in twenty, that one detection adds at most by its score, and by where it is: no
single one proves a vehicle."""
_SAID_OF_NOTHING = 5.0
"""Log odds, one in 150, against a detection by score and place above which its fit counts for
nothing. IDF1 of a dusk's last 860 images 72.8 to 78.5. At 3 they are 82.1, but a jam with poor
boxes falls from 70.3 to 56.1: chosen there, and on the bridge."""
_SCORE_DOUBT = 0.5
"""Log odds that one score of dense images takes off at most, so that a detector which knows little
about a vehicle does not hide it for ever; and that are taken off each, in confirming by scores
alone."""
_PROVEN = 4.0
"""Sum of the log odds of scores that stands for a drive: one in 55, two detections at least."""
_PART_OF_DRIVE = 0.5
"""Way of two edges, of that asked for, above which a shape may be a vehicle, by its scores or by
its centre's way. Where none is asked for, a clock's digits and holes have numbers; where scores
stand for nothing, HOTA / IDF1 of *highway* are 52.9 / 76.2 instead of 59.7 / 90.1; where the whole
way is asked of two edges, `traffic-overtaking` has 35.5 / 44.2 instead of 29.7 / 33.2, but
*highway* behind the bridge 51.9 / 69.4 instead of 54.6 / 72.4."""
_MISSED = 0.3
"""Log odds that a detection missed in plain sight takes off a vehicle: something unknown may hide
it, so that only 25 take off all that it can have. At .15 ghosts stay twice as long: 1660 images at
dusk have IDF1 81.2 instead of 84.6; cameras left out hardly tell both apart."""
_WAIT = 0.5
"""Time in s before a shape is a vehicle that has a rest beside it, or no straight drive: the pieces
of a blob are soon joined. 34 public clips of 24 to 30 Hz, before a lone one was excepted: IDF1
42.4, 44.0 and 43.3 at 8, 15 and 22 images."""
_REACH = 0.5
"""Distance, of its size, within which the rest of a piece is."""
_REST = 0.25
"""Least area of a rest, of the piece's own. With a reach of a quarter and half the area, or without
both, 1 and 6 more pieces of a close scene are vehicles."""
_SURELY_DRIVES = 50.0
"""Evidence for a drive above which scores may be ignored: false alarms side by side reach 35."""
_OWN_WIDTH = 1.0
"""Way of such a drive, of its width, from which they are: what creeps by less is a light, or the
box of what is far behind. Not chosen between values. YOLOX from .05 in the rest of a dusk: IDF1
86.0 and 85.5 instead of 71.7 and 71.5."""
_STRAIGHT_ENOUGH = 7.0
"""Evidence for a drive, one in a thousand, above which it is one."""
_STRAIGHT_SHAPE = 18.0
"""The same for shapes in dense images, which come by the dozen where leaves move: of 7 clips by
motion, 50 vehicles and 4 others are as straight; at 7, 53 and 25, at 14, 50 and 9, at 22, 47 and
4."""
_DOUBTED = 0.5
"""Further way, of that asked for, per log odd of scores against it: a choice, whose bound is the
loss without this doubt, HOTA / IDF1 3.5 / 5.6 (YOLOX from .05)."""
_MOVES = 3.0
"""Standard deviations of speed above which a vehicle drives: in 2-D 1 in 90 that stand is there."""
_STANDS = 0.1
"""Way, of its width, below which a track has not moved: networks' boxes shake by half of it."""
_KEPT_SAMPLES = 30
"""Latest detections, one second of 30 Hz, not learnt from until it drives: it may be about to. By
time three phases of every fifth image at dusk have IDF1 79.2, 70.5, 76.6 for 72.3, 82.6, 78.6."""
_BLIND_FROM = 2
"""Vehicles in sight, all missed in one image, by which the detector failed: all do not vanish."""
_BLIND_FOR = 150.0
"""Nominal periods after which an undetected vehicle is doubted even so: 5 s at 30 Hz. A choice: by
time the scores of four sparse clips (2.8 to 5/s) stay the same."""


def fits_of_known(tracks: Tracks, candidates: Candidates, columns: Integers, fits: Array) -> Array:
    """Log odds (N,) that count of those by where the detections, at `columns`, of tracks are.

    Where a vehicle stands, any false alarm there would fit: only a drive tells. Nor does a fit tell
    where the detector says the same of nothing, as of lights far behind: some of it always fits.
    """
    stands = tracks.beliefs.has_driven & (tracks.drives.gaussians.speed_ratio < _MOVES)
    bounded = np.minimum(np.maximum(fits, -_MOST), _MOST)
    usual = tracks.confirmed & _usual_clutter(candidates, columns, _SAID_OF_NOTHING)
    bounded = np.where(usual, np.minimum(bounded, 0.0), bounded)
    return np.where(tracks.confirmed & stands, 0.0, bounded)


def _usual_clutter(candidates: Candidates, columns: Integers, bound: float) -> Bools:
    """Find detections (N,) of scores that the detector gives, in their places, to what never drove.

    Log odds beyond `bound` are against them. Scores of shapes say how full their boxes are, and
    tell nothing of it.
    """
    if candidates.are_shapes:
        return np.zeros(len(columns), np.bool_)
    return np.asarray(candidates.log_odds[columns] < -bound)


def believed(
    tracks: Tracks,
    candidates: Candidates,
    columns: Integers,
    fits: Array,
    experience: Experience,
    step: Step,
) -> tuple[Tracks, Bools]:
    """Add the evidence of a detection to each track; and tell which it proves to be vehicles.

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
    # 1. Add what this detection tells.
    tracks = _seen(tracks, edges)
    tracks, lengths = _weighed(tracks, candidates, columns, fits, step)
    # 2. All evidence makes it ripe, a drive or sure scores prove it.
    beliefs = tracks.beliefs
    is_ripe = tracks.confirmed | (beliefs.log_odds >= step.parameters.birth.evidence)
    now_drives = is_ripe & ~(beliefs.has_driven | tracks.names.given)
    if now_drives.any():
        now_drives &= drives(tracks, step, are_shapes=candidates.are_shapes)
    proven = beliefs.strength > _PROVEN
    if candidates.are_shapes:
        is_old = beliefs.ways.age >= _WAIT / step.period
        # A piece drives as straight as its vehicle, whose rest is beside it until both are joined.
        now_drives &= is_old | ~have_rest(edges, candidates.edges)
        # Scores say how full they are, and the hole of what has left, or a digit of a clock, is as
        # full image after image: part of a drive besides.
        shared = beliefs.ways.shared_lengths(tracks.edges, step.size, step.edge_noise)
        proven &= is_old & (shared > _PART_OF_DRIVE * step.parameters.birth.displacement)
    # What has driven stays proven: a second box of another vehicle may part from it later.
    drove = now_drives | beliefs.has_driven
    proven |= drove
    if step.parameters.birth.standing == IGNORE_STANDING:
        proven &= drove | (lengths >= _STANDS)
    # 3. Teach detections only now: what they show depends on the drive.
    tracks = _taught(tracks, now_drives, lengths, candidates, columns, experience)
    return tracks, np.asarray(~tracks.confirmed & is_ripe & proven)


def _weighed(
    tracks: Tracks, candidates: Candidates, columns: Integers, fits: Array, step: Step
) -> tuple[Tracks, Array]:
    """Add what scores, places and ways of the detections tell; and the ways' lengths (N,).

    See `believed`.
    """
    beliefs = tracks.beliefs
    log_odds = candidates.log_odds[columns]
    # The usual odds of a score count once, at the birth: a new track gains by likelihood ratios.
    gains = np.where(tracks.confirmed, log_odds, candidates.gains[columns])
    # Scores of one spot repeat from image to image, and a second of them says as much at any rate:
    # of fewer each takes off more, but no more than one may add.
    most_doubt = min(_SCORE_DOUBT * step.sparsity, _MOST)
    gains = np.minimum(np.maximum(gains, -most_doubt), _MOST)
    ways = beliefs.ways.added(candidates.edges[columns])
    lengths = ways.lengths(tracks.edges)
    proof = np.where(lengths < _STANDS, candidates.sure[columns], log_odds)
    proof = np.minimum(np.maximum(proof - _SCORE_DOUBT, -_SCORE_DOUBT), _MOST)
    strength = beliefs.strength + proof
    stands = ways.stands
    beliefs = replace(
        beliefs,
        log_odds=np.minimum(beliefs.log_odds + gains + fits, CERTAIN_LOG_ODDS),
        # A time of standing is no debt: having stood makes nothing less likely once it drives.
        doubt=np.where(stands, 0.0, np.maximum(beliefs.doubt - gains, 0.0)),
        strength=np.where(stands, np.maximum(strength, 0.0), strength),
        ways=ways,
    )
    return replace(tracks, beliefs=beliefs), lengths


def have_rest(edges: Array, others: Array) -> Bools:
    """Find boxes (N, 4) among `others` (M, 4), all, that have another one beside them."""
    reach = _REACH * both_ends(sides_of(edges))
    near = intersections((edges - reach * INWARD_SIGNS)[:, np.newaxis], others) > 0
    near &= areas(others) > _REST * areas(edges)[:, np.newaxis]  # a speck is no rest
    return np.asarray(near.sum(axis=1) > 1)  # itself is one


def _seen(tracks: Tracks, edges: Array) -> Tracks:
    """End the absences of tracks detected in boxes (N, 4) in px: nothing hides them."""
    return replace(
        tracks,
        visibility=replace(tracks.visibility, hidden_by=np.zeros(len(tracks), np.intp)),
        absences=tracks.absences.ended(),
        latest=replace(tracks.latest, detection=edges),
    )


def drives(tracks: Tracks, step: Step, *, are_shapes: bool = False) -> Bools:
    """Find tracks (N,) whose ways show that they are no part of the scene.

    Parameters
    ----------
    tracks : Tracks
        Tracks.
    step : Step
        The frame, and inputs that all parts of a step share.
    are_shapes : bool
        Their detections are shapes, whose scores tell nothing of their drive.
    """
    ways = tracks.beliefs.ways
    lengths = ways.lengths(tracks.edges)
    evidence = ways.evidence()
    displacement = step.parameters.birth.displacement
    if are_shapes:
        # A swing of leaves is straight in as many images as see it: of fewer less is asked.
        straight = max(_STRAIGHT_SHAPE / step.sparsity, _STRAIGHT_ENOUGH)
        # The centre of what stands moves, too, as one edge of it does.
        shared = ways.shared_lengths(tracks.edges, step.size, step.edge_noise)
        moves = shared > _PART_OF_DRIVE * displacement
        return np.asarray(moves & (lengths > displacement) & (evidence > straight))
    # A stand whose boxes shook by too much to be told lies on no line with the drive. Shapes do not
    # stand: by motion the bridge's HOTA would be 54.9 instead of 56.1.
    evidence = np.maximum(evidence, ways.latest_evidence())
    # False alarms side by side look like a short drive.
    is_sure = (evidence >= _SURELY_DRIVES) & (lengths >= _OWN_WIDTH)
    doubt = np.where(is_sure, 0.0, tracks.beliefs.doubt)
    needed = displacement * (1 + _DOUBTED * doubt)
    return np.asarray((lengths > needed) & (evidence > _STRAIGHT_ENOUGH))


def _taught(
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
    settled = beliefs.has_driven | tracks.names.given
    moves = tracks.names.given | (tracks.drives.gaussians.speed_ratio > _MOVES)
    # A vehicle far away may take clutter for itself, and would teach that this is a vehicle: by
    # what is likelier clutter than any fit can outweigh.
    moves &= ~_usual_clutter(candidates, columns, _MOST)
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


def _sparse_price(absences: Absences, rates: Array, step: Step) -> Array:
    """Price (N,) of a look that misses a vehicle where looks are rare; `rates` find vehicles.

    Misses of dense looks have one cause, and tell the less the more there are in a second; rare
    ones are independent, and of these each tells what a detection would have.
    """
    looks = np.maximum(absences.passed, 1)
    seconds = absences.undetected * step.period / looks
    return np.asarray(np.minimum(_MISSED * seconds / DENSE, -np.log(1 - rates)))


def doubt(state: State, step: Step) -> State:
    """Take off evidence from tracks that a detector has missed in plain sight."""
    tracks = state.tracks
    elapsed = step.elapsed
    confirmed = tracks.confirmed
    detected = tracks.detected
    # The image counts for all that the detector has not found in it.
    passed = np.where(detected, 0, tracks.absences.passed + 1)
    absences = replace(tracks.absences, passed=passed)
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
    missed = ~detected & in_sight & ~(tracks.names.given & is_seen)
    taken = np.zeros(len(tracks))
    # Also of what pixels alone hold at the border, where most of it is outside: too little to ask
    # the detector for it, but road that stands would hold the box of one that has left for ever.
    held = ~detected & is_seen & (tracks.visibility.uncovered > IN_SIGHT) & ~tracks.names.given
    lost = (missed | held) & confirmed
    if lost.any():
        taken[lost] = np.maximum(elapsed * _MISSED, _sparse_price(absences, rates, step))[lost]
    for row in (missed & ~confirmed).nonzero()[0].tolist():
        taken[row] = elapsed * -math.log(1 - rates[row])
    beliefs = replace(tracks.beliefs, log_odds=tracks.beliefs.log_odds - taken)
    return state._replace(tracks=replace(tracks, beliefs=beliefs))

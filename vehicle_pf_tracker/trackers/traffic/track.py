# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that are followed: state, evidence of existence, colours."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NOTHING
from vehicle_pf_tracker.trackers.traffic.colours import BINS
from vehicle_pf_tracker.trackers.traffic.detection_evidence import CERTAIN, HALF, Place, Sample
from vehicle_pf_tracker.trackers.traffic.estimate import BORDER, SCENE, TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.horizon import Growth
from vehicle_pf_tracker.trackers.traffic.straight_drive import StraightDrive
from vehicle_pf_tracker.trackers.traffic.vehicle_state import ACROSS, Drive, VehicleState, W

SEEN_WITHIN = 2.0
"""Nominal periods within which a vehicle counts as seen: one frame may fail."""
FEW = 4
"""Detections, or nominal periods without one, that tell something: fewer come by chance."""
RATE = 1 / FEW
"""Rate per detection at which colours, their usual similarity and residuals of edges are learnt:
the latest few count for two thirds."""
FALL = 0.2
"""Fall of the colours' similarity below its usual value above which it is not the vehicle."""


@dataclass(eq=False, slots=True)
class Track:
    """A vehicle among others.

    Attributes
    ----------
    serial : int
        Number of the track.
    state : VehicleState
        Place, size and velocity.
    identity : int
        Number of the vehicle; 0 until it is confirmed.
    votes : dict of str to int
        Number of its detections by their class.
    log_odds : float
        Evidence that the vehicle exists.
    strength : float
        Evidence by the scores of its detections alone.
    doubt : float
        Log odds against a vehicle by these scores; never below zero.
    matches, partial, short : int
        Number of its detections; and of the latest in a row that showed only a part of it, and that
        were smaller than earlier ones.
    missed : int
        Number of the latest looks of the detector, in a row, that missed it in plain sight.
    vanished : Place or None
        Where it was missed several times in a row.
    shortened : Place or None
        Where several in a row were smaller, until it is known whether the rest comes back.
    crowded : int
        Number of its latest detections in a row that had another one beside them in its box.
    shown : (2,) array
        Largest width and height of its latest detections, of its own.
    lost : bool
        It has been hidden for too long to be predicted, has left, or is rather not there.
    has_driven : bool
        Its way shows that it is no part of the scene.
    given : bool
        It was given by hand: that no detector finds it does not refute it.
    joined : int
        Number of the track as which it was found again; 0 if of none.
    score : float
        Score of its detection in this frame; NaN without one.
    detection : (4,) array
        Edges of its latest detection, px.
    age, unseen, undetected : float
        Nominal periods since it was first seen, last seen, last detected.
    visible, inside : float
        Share of its box that no nearer vehicle hides, and that lies in the image.
    covers : (K, 4) array
        Edges of the nearer boxes over its box, px.
    hidden_by : int or None
        Nearest vehicle that hides a good part of it.
    before : (4,) array
        Edges in the frame before, px.
    samples : list of Sample
        Detections before the vehicle was confirmed.
    drift : (4,) array
        Mean of the latest outward residuals of its edges, in standard deviations.
    lag : (4,) array
        What its state stays behind, px: its edges are reported with it.
    usual_similarity : float
        Similarity of its colours to those learnt, while it is detected.
    growth : Growth
        Regression of the width on the lower edge.
    """

    serial: int
    state: VehicleState
    identity: int = 0
    colours: Array = field(default_factory=lambda: np.zeros(BINS))
    votes: dict[str, int] = field(default_factory=dict)
    log_odds: float = 0.0
    strength: float = 0.0
    doubt: float = 0.0
    matches: int = 0
    partial: int = 0
    missed: int = 0
    vanished: Place | None = None
    short: int = 0
    shortened: Place | None = None
    crowded: int = 0
    shown: Array = field(default_factory=lambda: np.zeros(2))
    lost: bool = False
    has_driven: bool = False
    given: bool = False
    joined: int = 0
    score: float = math.nan
    detection: Array = field(default_factory=lambda: np.zeros(4))
    age: float = 0.0
    unseen: float = 0.0
    undetected: float = 0.0
    visible: float = 1.0
    inside: float = 1.0
    covers: Array = field(default_factory=lambda: NOTHING)
    hidden_by: int | None = None
    before: Array = field(default_factory=lambda: np.zeros(4))
    samples: list[Sample] = field(default_factory=list)
    drift: Array = field(default_factory=lambda: np.zeros(4))
    lag: Array = field(default_factory=lambda: np.zeros(4))
    usual_similarity: float = 1.0
    growth: Growth = field(default_factory=Growth)
    _first: Array = field(default_factory=lambda: np.zeros(2))
    _drive: StraightDrive = field(default_factory=StraightDrive)

    @property
    def confirmed(self) -> bool:
        """True once it is known to be a vehicle."""
        return self.identity > 0

    @property
    def in_sight(self) -> bool:
        """True where nothing known hides it, and it is in the image."""
        return min(self.visible, self.inside) > HALF

    @property
    def label(self) -> str:
        """Class that most of its detections say."""
        return max(self.votes, key=self.votes.__getitem__, default="")

    def go_on(self, elapsed: float) -> None:
        """Go on by `elapsed` nominal periods, before the state is predicted."""
        self.before = self.state.edges
        self.age += elapsed
        self.unseen += elapsed
        self.undetected += elapsed
        self.score, self.lag = math.nan, np.zeros(4)

    def show(self, visible: float, inside: float, covers: Array, hidden_by: int | None) -> None:
        """Take what of it is in sight, and what hides the rest."""
        self.visible, self.inside = visible, inside
        self.covers, self.hidden_by = covers, hidden_by

    def confirm(self, identity: int, *, given: bool = False) -> None:
        """Become the vehicle of this number, by hand if it is `given`: then without a doubt."""
        self.identity, self.given = identity, given
        if given:
            self.log_odds = CERTAIN

    def resume(self, track: Track) -> None:
        """Go on where the new track is that this hidden vehicle turned out to be."""
        self.state, self.before, self.joined = track.state, track.before, track.serial
        self.score, self.detection = track.score, track.detection
        for label, votes in track.votes.items():
            self.votes[label] = self.votes.get(label, 0) + votes
        self.has_driven = self.has_driven or track.has_driven
        self._be_found()
        self.log_odds = max(self.log_odds, track.log_odds)
        self.show(track.visible, track.inside, track.covers, None)
        self.shown, self.partial, self.short = track.shown, track.partial, track.short

    def name(self, label: str, score: float) -> None:
        """Take score and class of its detection in this frame."""
        self.score = score
        if label:
            self.votes[label] = self.votes.get(label, 0) + 1

    def measured(self, sides: Array, drift: Array, lag: Array, *, is_whole: bool) -> None:
        """Take largest sides (2,) and lag (4,) in px, drift (4,), and if a detection was whole."""
        self.shown, self.drift, self.lag = sides / self.state.mean[W:ACROSS], drift, lag
        self.partial = 0 if is_whole else self.partial + 1

    def shorten(self, place: Place, *, is_short: bool) -> int:
        """Count the latest detections in a row, this one here, that were smaller than before."""
        self.short = self.short + 1 if is_short else 0
        if self.short == FEW:
            self.shortened = place
        return self.short

    def take_shortened(self) -> Place | None:
        """Hand out where it became smaller."""
        place, self.shortened = self.shortened, None
        return place

    def crowd(self, *, crowded: bool) -> int:
        """Count the detections in a row that had another one beside them in the box."""
        self.crowded = self.crowded + 1 if crowded else 0
        return self.crowded

    def fill(self, edges: Array) -> None:
        """Be as large as a box (4,), and there."""
        self.crowded = 0
        self.shown = np.ones(2)
        self.state.resize(edges)

    def hold(self, edges: Array, deviations: Array) -> None:
        """Take edges (4,) by the pixels, px, and their standard deviations."""
        self.unseen = 0.0
        self.state.measure(edges, deviations)

    def learn_colours(self, colours: Array) -> None:
        """Let the colours follow those of a box in plain sight."""
        known = self.colours.any()
        self.colours = self.colours + (RATE if known else 1.0) * (colours - self.colours)

    def learn_similarity(self, similarity: float) -> None:
        """Let the usual similarity of the colours follow that of a detected vehicle."""
        self.usual_similarity += RATE * (similarity - self.usual_similarity)

    def add_evidence(self, edges: Array, score: float, fit: float) -> None:
        """Take the evidence of a detection.

        Parameters
        ----------
        edges : (4,) array
            Edges of the detection, px.
        score, fit : float
            Log odds by its score, and by where it is.
        """
        self._be_found()
        self.hidden_by, self.detection = None, edges
        self.matches += 1
        self.doubt = max(self.doubt - score, 0.0)
        self.log_odds = min(self.log_odds + score + fit, CERTAIN)
        x, y = ((edges[:2] + edges[2:]) / 2).tolist()
        if self.matches == 1:
            self._first = np.array([x, y])
        self._drive.add(self.age, x, y)

    def drive(self) -> float:
        """Evidence that its detections are a straight drive at constant speed."""
        return self._drive.evidence()

    def prove(self, doubted: float, sample: Sample) -> None:
        """Take the evidence by the score of a detection, of which it is not known what it shows."""
        self.strength += doubted
        if not (self.has_driven or self.given):
            self.samples.append(sample)

    def judge(self, has_driven: bool) -> None:
        """Take whether its way shows that it is no part of the scene."""
        self.has_driven = has_driven

    def take_samples(self, kept: int = 0) -> list[Sample]:
        """Hand out its earliest detections, of which nothing is known yet, but the latest ones."""
        count = max(len(self.samples) - kept, 0)
        taken, self.samples = self.samples[:count], self.samples[count:]
        return taken

    def miss(self, log_odds: float, place: Place) -> None:
        """Take evidence against it: it was not detected, in this place."""
        self.log_odds -= log_odds
        self.missed += 1
        if self.confirmed and not self.given and self.missed == FEW:
            self.vanished = place

    def _be_found(self) -> None:
        self.unseen = self.undetected = 0.0
        self.missed, self.vanished = 0, None

    def lose(self, lost: bool) -> None:
        """Be predicted no longer, or again."""
        self.lost = lost

    @property
    def way(self) -> float:
        """Distance from its first detection, in its present widths; 0 before it."""
        if not self.matches:
            return 0.0
        left, top, right, bottom = self.state.edges.tolist()
        x, y = self._first.tolist()
        moved = math.hypot((left + right) / 2 - x, (top + bottom) / 2 - y)
        return float(moved / max(right - left, 1.0))

    @property
    def mode(self) -> TrackMode:
        """Claim about it."""
        if not self.confirmed:
            return TrackMode.TENTATIVE
        if self.lost:
            return TrackMode.LOST
        return TrackMode.TRACKING if self.unseen < SEEN_WITHIN else TrackMode.OCCLUDED

    def estimate(self) -> TrackEstimate:
        """Estimate of this frame."""
        mode, state = self.mode, self.state
        confidence = 1 / (1 + math.exp(-self.log_odds))
        hidden = mode in (TrackMode.OCCLUDED, TrackMode.LOST)
        unknown = SCENE if self.inside >= HALF else BORDER
        return TrackEstimate(
            identity=self.identity,
            serial=self.serial,
            joined=self.joined,
            box=state.shown(self.lag),
            velocity=state.velocity,
            mode=mode,
            confidence=confidence * (HALF if hidden else 1.0),
            label=self.label,
            score=self.score,
            age=self.age,
            hidden_by=(self.hidden_by or unknown) if hidden else None,
            foot_covariance=state.foot_covariance,
        )


def edges_of(tracks: Sequence[Track]) -> Array:
    """Return the edges (T, 4) of tracks, px."""
    return np.array([track.state.edges for track in tracks]).reshape(-1, 4)


def predict(tracks: Sequence[Track], horizon: float, elapsed: float, drive: Drive) -> list[Track]:
    """Predict vehicles below a horizon (row in px), and return those whose states are sound."""
    states = VehicleState.stacked([track.state for track in tracks])
    for track in tracks:
        track.go_on(elapsed)
    states.move_horizon(horizon)
    states.predict(elapsed, drive)
    states.give_back([track.state for track in tracks])
    return [track for track, sound in zip(tracks, states.is_sound.tolist(), strict=True) if sound]

# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""One vehicle that is followed: its state, the evidence that it exists, and its looks."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.colours import BINS
from vehicle_pf_tracker.trackers.traffic.detection_evidence import Sample
from vehicle_pf_tracker.trackers.traffic.estimate import SCENE, TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.horizon import Growth
from vehicle_pf_tracker.trackers.traffic.vehicle_state import VehicleState

MOST_EVIDENCE = 8.0
"""Bound of the log odds that a vehicle exists: however long it was seen, some ten missed
detections in plain sight speak against it."""
SEEN_WITHIN = 2.0
"""Nominal periods within which a vehicle counts as seen: one frame may fail."""
_COLOUR_RATE = 0.1
"""Rate per detection at which colours and their usual similarity are learnt."""
_FIRST_SIMILARITY = 0.9
"""Similarity of a vehicle's colours from frame to frame before it is known."""
_HIDDEN_CONFIDENCE = 0.5
"""Share of the confidence that is left while a vehicle is predicted only."""


@dataclass(eq=False, slots=True)
class Track:
    """A vehicle among others.

    Attributes
    ----------
    identity : int
        Number of the vehicle.
    state : VehicleState
        Place, size and velocity.
    label : str
        Class as its detections say it.
    log_odds : float
        Evidence that the vehicle exists.
    strength : float
        Evidence by the scores of its detections alone.
    matches, partial : int
        Number of its detections, and of the latest in a row that showed only a part of it.
    crowded : int
        Number of its latest detections in a row that had another one beside them in its box.
    sides : (2,) array
        Largest width and height of its latest detections, px.
    confirmed, lost : bool
        It is reported; it has been hidden for too long to be predicted.
    given : bool
        It was given by hand: that no detector finds it does not refute it.
    score : float
        Score of its detection in this frame; NaN without one.
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
        Its detections before it was confirmed.
    usual_similarity : float
        Similarity of its colours to those learnt, while it is detected.
    growth : Growth
        How its size depends on its place.
    """

    identity: int
    state: VehicleState
    colours: Array = field(default_factory=lambda: np.zeros(BINS))
    label: str = ""
    log_odds: float = 0.0
    strength: float = 0.0
    matches: int = 0
    partial: int = 0
    crowded: int = 0
    sides: Array = field(default_factory=lambda: np.zeros(2))
    confirmed: bool = False
    lost: bool = False
    given: bool = False
    score: float = math.nan
    age: float = 0.0
    unseen: float = 0.0
    undetected: float = 0.0
    visible: float = 1.0
    inside: float = 1.0
    covers: Array = field(default_factory=lambda: np.empty((0, 4)))
    hidden_by: int | None = None
    before: Array = field(default_factory=lambda: np.zeros(4))
    samples: list[Sample] = field(default_factory=list)
    usual_similarity: float = _FIRST_SIMILARITY
    growth: Growth = field(default_factory=Growth)
    _first: Array = field(default_factory=lambda: np.zeros(2))
    _drive: Array = field(default_factory=lambda: np.zeros(8))

    def predict(self, elapsed: float) -> None:
        """Go on by `elapsed` nominal periods."""
        self.before = self.state.edges
        self.state.predict(elapsed)
        self.age += elapsed
        self.unseen += elapsed
        self.undetected += elapsed
        self.score = math.nan

    def learn_colours(self, colours: Array) -> None:
        """Let the colours follow those of a box in plain sight."""
        known = self.colours.any()
        self.colours = self.colours + (_COLOUR_RATE if known else 1.0) * (colours - self.colours)

    def learn_similarity(self, similarity: float) -> None:
        """Let the usual similarity of the colours follow that of a detected vehicle."""
        self.usual_similarity += _COLOUR_RATE * (similarity - self.usual_similarity)

    def note_place(self, centre: Array) -> None:
        """Note the centre (px) of a detection, from which the straightness of its way is known."""
        x, y = centre.tolist()
        if not self._drive[0]:
            self._first = centre
        time = self.age
        self._drive += (1, time, time**2, x, y, time * x, time * y, x * x + y * y)

    @property
    def straightness(self) -> float:
        """Share of its detections' scatter that a straight drive at constant speed explains.

        A vehicle comes close to one; what flickers in one place, a tree in the wind, to zero; so
        does a vehicle whose detections are not noted, because it was given by hand.
        """
        count, time, squared, x, y, time_x, time_y, places = self._drive.tolist()
        if not count:
            return 0.0
        scatter = places - (x * x + y * y) / count
        duration = squared - time * time / count
        if scatter <= 0 or duration <= 0:
            return 0.0
        along_x, along_y = time_x - time * x / count, time_y - time * y / count
        return float((along_x**2 + along_y**2) / duration / scatter)

    @property
    def way(self) -> float:
        """Distance from its first detection, in its present widths."""
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
        mode = self.mode
        confidence = 1 / (1 + math.exp(-self.log_odds))
        hidden = mode in (TrackMode.OCCLUDED, TrackMode.LOST)
        return TrackEstimate(
            identity=self.identity,
            box=self.state.box,
            velocity=self.state.velocity,
            mode=mode,
            confidence=confidence * (_HIDDEN_CONFIDENCE if hidden else 1.0),
            label=self.label,
            score=self.score,
            age=self.age,
            hidden_by=(self.hidden_by or SCENE) if hidden else None,
        )

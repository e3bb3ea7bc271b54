# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detections of one frame, with what is known about each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.detection.detections import NO_SCORE, Detections
from vehicle_pf_tracker.trackers.traffic.box_edges import sides_of
from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    NO_CLAIM,
    DetectionEvidence,
    Sample,
    claims_of,
    places_of,
)
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers

_ORDINARY = 0.5
"""Share of the vehicles' detections with lower scores above which a score is better than most: the
median."""
_UNSCORED = math.log(2)
"""Log odds, two to one, of a box without a score where nothing has moved: who gives none has cut
what is doubtful. A choice, by which what stands is reported after 21 detections.
laboratory/notes/traffic.md has what it gains and costs."""
SIZE_SPREAD = 2.0
"""Logarithm of the ratio of the largest and the smallest false alarms, by which they are spread:
with a narrower spread vehicles that pass close and fast are found late."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidates:
    """Detections of one frame that may be vehicles.

    Attributes
    ----------
    edges : (N, 4) array
        Left, top, right and bottom in px.
    scores : (N,) array
        As the detector gave them.
    labels : tuple of str
        Classes.
    are_shapes : bool
        True where they may be of pieces of vehicles, which drive as well, and are soon joined.
    places : (N,) array
        Index of the grid cell, see `places_of`, that each box's centre is in.
    log_odds : (N,) array
        Log odds that each is a vehicle.
    gains : (N,) array
        Log likelihood ratio of each score, vehicle over false alarm.
    at_rest : (N,) array
        Log odds that its score alone is worth where nothing has moved.
    clutter : (N,) array
        Logarithm of the false alarms per image, if all places had as many as each one's.
    false_density : (N,) array
        Logarithm of the density of false alarms at each box, over its four edges, px^-4.
    """

    edges: Array
    scores: Array
    labels: tuple[str, ...]
    are_shapes: bool
    places: Integers
    log_odds: Array
    gains: Array
    at_rest: Array
    clutter: Array
    false_density: Array

    def __len__(self) -> int:
        return len(self.edges)

    def samples(self, indices: Integers) -> list[Sample]:
        """Scores and places of those at `indices`, for learning what becomes of them."""
        scores = self.scores[indices].tolist()
        return list(map(Sample, scores, self.places[indices].tolist()))


def weigh(detections: Detections, evidence: DetectionEvidence, size: tuple[int, int]) -> Candidates:
    """Weigh usable detections by what became of earlier ones.

    Parameters
    ----------
    detections : Detections
        Usable ones.
    evidence : DetectionEvidence
        Outcomes of earlier detections.
    size : (int, int)
        Width and height of the image.
    """
    # 1. Edges and places, by which clutter is known.
    boxes = detections.boxes
    scores = detections.scores
    low = boxes[:, :2]
    edges = np.concatenate([low, low + boxes[:, 2:]], axis=1)
    places = places_of(edges, size)
    clutter = evidence.clutter(places)
    # 2. A shape's score is how full its box is, no probability.
    claims = np.full(len(scores), NO_CLAIM) if detections.are_shapes else claims_of(scores)
    has_none = (scores == NO_SCORE) & (not detections.are_shapes)
    by_score = evidence.by_score(scores, claims)
    log_odds = evidence.log_odds(by_score, places)
    # 3. Poisson clutter, as usual, in the space of the edges, of which (left, right) has the same
    # measure as (centre, width): false alarms are anywhere in the image, and of any size.
    false_density = (
        clutter - math.log(size[0] * size[1]) - np.log(sides_of(edges) * SIZE_SPREAD).sum(axis=1)
    )
    return Candidates(
        edges=edges,
        scores=scores,
        labels=detections.labels,
        are_shapes=detections.are_shapes,
        places=places,
        log_odds=log_odds,
        gains=evidence.gains(by_score),
        at_rest=_odds_at_rest(log_odds, claims, evidence.ranks(scores), has_none),
        clutter=clutter,
        false_density=false_density,
    )


def _odds_at_rest(log_odds: Array, claims: Array, ranks: Array, has_none: Bools) -> Array:
    """Log odds (N,) that scores are worth where nothing has moved.

    A spot that looks a little like a vehicle does so each time, and many such scores are worth one:
    both the detector and what became of such scores here have to be sure of each. Where a detector
    makes no claims, most vehicles have to have lower scores. A box that `has_none` is believed a
    little, unless what became of such boxes here speaks against it.
    """
    # Finite, as `claims_of` bounds claims away from 0 and 1.
    claimed = np.log(claims / (1 - claims))
    # Nothing claimed bounds nothing, of scores above the median; the lower half stays at even odds.
    claimed[(claims == NO_CLAIM) & (ranks >= _ORDINARY)] = np.inf
    return np.where(has_none, np.minimum(log_odds, 0.0) + _UNSCORED, np.minimum(log_odds, claimed))

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that detections are vehicles, learnt from what became of earlier ones.

Two things tell: the score, and the place, because a tree in the wind is reported again and
again. A place only speaks against a detection: where many vehicles pass, parts of vehicles are
detected as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.rows import Integers

_MEMORY = 2000
"""Detections that are remembered. A choice: some minutes of a few vehicles."""
_PLACES_FOR = 2000
"""Images after which what is known of places is halved: light and wind change in a minute."""
_NEIGHBOURS = 40
"""Detections of about the same score, by rank, that a probability is taken from: of 40 the share
has a standard deviation of .08 at most, and rarer scores are still distinguished."""
_PRIOR = 2.0
"""Weight of the prior on each side, in detections. A choice: one outcome then moves even odds by
.4, and forty outweigh it."""
_GRID = 16
"""Places along each side of the image: 20 px in 320, about one distant vehicle. A choice: with
larger places a tree would speak against the road beside it, smaller ones are seldom learnt."""
PLACE_COUNT = _GRID**2
"""Places of the image."""
_FALSE_ALARMS = 1.0
"""False alarms per image that are expected before any is seen. A choice: good detectors have fewer,
poor ones more."""
_ASSUMED_FOR = 30
"""Images, one second of 30 Hz, that this is worth, and the mean of all places for the number of
one. A choice."""
_CLUTTERED = 0.5
"""False alarms in a place from which it is said to be cluttered: one, halved once at most."""
NO_CLAIM = 0.5
"""Probability of a vehicle where a detector claims nothing: even odds."""
_LEAST_CLAIM = 0.01
"""Least probability that a detector's own score is taken for, either way: one in a hundred. It
keeps the logarithm of the odds finite, and a detector from being surer than what became of its
scores."""
_SUREST = 7.0
"""Log odds, one in a thousand, beyond which scores and places say nothing surer."""


class Sample(NamedTuple):
    """Score and place of a detection whose outcome is to be learnt."""

    score: float
    place: int


def places_of(edges: Array, size: tuple[int, int]) -> Integers:
    """Places (N,), in a grid over the image, of boxes (N, 4) in px."""
    centres = (edges[:, :2] + edges[:, 2:]) / 2
    # A box of a vehicle that leaves may have its centre outside.
    places = np.minimum(np.maximum(centres / size * _GRID, 0), _GRID - 1)
    columns, rows = places.astype(np.intp).T
    return np.asarray(rows * _GRID + columns)


def claims_of(scores: Array) -> Array:
    """Probabilities (N,) that detections are vehicles, as their detector says them; a half: unsaid.

    Networks give scores between 0 and 1. Of 34 000 boxes of two networks on two cameras, those of
    .5 to .6 were vehicles in 77 to 100 %, and no false alarm that stayed in one place for half a
    second had more than .37 in the mean. A score of 1 is that of a detector that gives none.
    """
    if not ((scores >= 0) & (scores <= 1)).all():
        return np.full(len(scores), NO_CLAIM)
    says = (scores > 0) & (scores < 1)
    bounded = np.minimum(np.maximum(scores, _LEAST_CLAIM), 1 - _LEAST_CLAIM)
    return np.where(says, bounded, NO_CLAIM)


class DetectionEvidence:
    """Outcomes of detections by score, and false alarms by place.

    Attributes
    ----------
    are_shapes : bool
        True where the latest detections were shapes, which may be of pieces of vehicles.
    """

    def __init__(self) -> None:
        self.are_shapes = False
        self._outcomes = np.zeros((_MEMORY, 2))  # score, and 1 of a vehicle's, 0 of a false alarm
        self._learnt = self._fresh = 0
        # Sorted scores, and running sums of their outcomes: counts between any two scores are then
        # one subtraction.
        self._sorted = np.empty(0)
        self._sums = np.zeros(1)
        self._images = 0.0
        # False alarms that stood alone, and all outcomes (false, genuine) by place.
        self._false = np.zeros(PLACE_COUNT)
        self._places = np.full((2, PLACE_COUNT), _PRIOR)

    def begin_image(self, *, are_shapes: bool = False) -> None:
        """Note that the detector has looked at another image, and whether it reports shapes."""
        self.are_shapes = are_shapes
        self._images += 1
        if self._images > _PLACES_FOR:
            self._images /= 2
            self._false /= 2
            # Halved, but for the prior, which stays what it is.
            self._places = (self._places + _PRIOR) / 2
        # Sorted anew only when half of a neighbourhood is new. Never within an image, so that the
        # order of its detections does not matter.
        if self._fresh >= min(_NEIGHBOURS // 2, self._learnt) > 0:
            scores, genuine = self._outcomes[: self._learnt].T
            order = np.argsort(scores, kind="stable")
            self._sorted = scores[order]
            self._sums = np.concatenate([[0.0], np.cumsum(genuine[order])])
            self._fresh = 0

    @property
    def cluttered(self) -> int:
        """Number of places that had a false alarm lately."""
        return int(np.count_nonzero(self._false >= _CLUTTERED))

    def learn(self, samples: Sequence[Sample], genuine: bool, *, alone: bool = True) -> None:
        """Add outcomes of detections; one beside a vehicle is no false alarm of its place."""
        is_false = alone and not genuine
        places = self._places[int(genuine)]
        for score, place in samples:
            # A ring: the oldest outcome goes.
            self._outcomes[self._learnt % _MEMORY] = score, genuine
            self._learnt += 1
            places[place] += 1
            if is_false:
                self._false[place] += 1
        self._fresh += len(samples)

    def log_odds(self, by_score: Array, places: Integers) -> Array:
        """Logarithm of the odds that detections are vehicles, (N,), of that by their scores.

        A place only speaks against a detection: where many vehicles pass, parts of vehicles are
        detected as well.
        """
        totals = self._places.sum(axis=1)
        here = self._places[:, places]
        # Relative to the usual odds, which scores have in them already: else they counted twice.
        by_place = np.log(here[1] / here[0]) - np.log(totals[1] / totals[0])
        both = by_score + np.minimum(by_place, 0.0)
        return np.asarray(np.minimum(np.maximum(both, -_SUREST), _SUREST))

    def gains(self, by_score: Array) -> Array:
        """Logarithm of how much more often vehicles have such scores (N,) than false alarms."""
        genuine = self._sums[-1]
        total = len(self._sorted)
        # Without the usual odds, a likelihood ratio: those of a new track are counted at its birth.
        usual = np.log((genuine + _PRIOR) / (total - genuine + _PRIOR))
        return np.asarray(by_score - usual)

    def ranks(self, scores: Array) -> Array:
        """Share of the vehicles' detections with lower scores, (N,); 0 before enough are known."""
        # Of at least `_NEIGHBOURS`, so that the first few scores are not better than most.
        below = self._sums[np.searchsorted(self._sorted, scores)]
        return np.asarray(below / max(self._sums[-1], _NEIGHBOURS))

    def clutter(self, places: Integers) -> Array:
        """Logarithm of the false alarms per image, (N,), in a place as large as the image.

        The number in one place is that of a Poisson process, its prior the mean of all places.
        """
        images = self._images + _ASSUMED_FOR
        usual = (self._false.sum() + _FALSE_ALARMS * _ASSUMED_FOR) / images
        # A gamma-Poisson mean: one place, scaled to the image, and the prior's images.
        seen = self._false[places] * PLACE_COUNT + _ASSUMED_FOR * usual
        return np.asarray(np.log(seen / images))

    def by_score(self, scores: Array, claims: Array) -> Array:
        """Logarithm of the odds that detections of these scores are vehicles, (N,).

        Before anything is known that is what their detector claims, (N,) probabilities.
        """
        # Between both ends of equal scores: a detector that gives all the same has one probability
        # for all.
        left = self._sorted.searchsorted(scores, "left")
        middle = (left + self._sorted.searchsorted(scores, "right")) // 2
        low = np.maximum(middle - _NEIGHBOURS // 2, 0)
        high = np.minimum(middle + _NEIGHBOURS // 2, len(self._sorted))
        genuine = self._sums[high] - self._sums[low]
        # A beta prior around what the detector claims, of the weight of `_PRIOR` on each side.
        yes = 2 * _PRIOR * claims
        no = 2 * _PRIOR * (1 - claims)
        return np.asarray(np.log((genuine + yes) / (high - low - genuine + no)))

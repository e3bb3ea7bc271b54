# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that detections are vehicles, learnt from the outcomes of earlier ones.

Two things tell: the score, of which only the order counts, so that a detector whose scores are
squared or halved is the same one; and the place, because a tree in the wind is reported again and
again. A place only speaks against a detection: where many vehicles pass, parts of vehicles are
detected as well.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.vehicle_state import SETTLED_AFTER

IntArray: TypeAlias = npt.NDArray[np.intp]
Place: TypeAlias = tuple[int, int]
"""Row and column of a grid over the image."""

INSIDE = 0.7
"""Share of a box inside another one above which it is a part of it: a bonnet, a second box."""
HALF, LITTLE = 0.5, 0.1
"""Shares of a box, or of what is counted, above which it is most of it, and below which none."""
LEAST_PART = 0.15
"""Smallest share of a vehicle that is seen as a part of it. At a tenth IDF1 of YOLOX behind the
bridge falls by six (association); with other shares for blobs, HOTA by motion there by seven."""
_MEMORY = 2000
"""Detections that are remembered, some minutes of a few vehicles; and images after which what is
known of places is halved: light and wind change in a minute."""
_NEIGHBOURS = 40
"""Detections of about the same score, by rank, that a probability is taken from."""
_PRIOR = 2.0
"""Weight of the prior on each side, in detections."""
GRID = 16
"""Places along each side of the image."""
_FALSE_ALARMS = 1.0
"""False alarms per image that are expected before any is seen; this, and the mean of all places for
the number of one, is worth `SETTLED_AFTER` images."""
CERTAIN = 7.0
"""Log odds, one in a thousand, beyond which nothing is surer: however long a vehicle was seen, some
missed detections in plain sight speak against it."""


class Sample(NamedTuple):
    """Score and place of a detection whose outcome is to be learnt."""

    score: float
    place: Place


def places_of(edges: Array, size: tuple[int, int]) -> list[Place]:
    """Rows and columns, in a grid over the image, of boxes (N, 4) in px."""
    centres = (edges[:, :2] + edges[:, 2:]) / 2
    cells = np.clip(centres / size * GRID, 0, GRID - 1).astype(int)
    return [(row, column) for column, row in cells.tolist()]


class DetectionEvidence:
    """Outcomes of detections by score, and false alarms by place."""

    def __init__(self) -> None:
        self._outcomes = np.zeros((_MEMORY, 2))  # score, and 1 of a vehicle's
        self._learnt = self._fresh = 0
        self._sorted = np.empty(0)
        self._sums = np.zeros(1)
        self._images = 0.0
        self._false = np.zeros((GRID, GRID))
        self._places = np.full((2, GRID, GRID), _PRIOR)

    def look(self) -> None:
        """Note that the detector has looked at another image."""
        self._images += 1
        if self._images > _MEMORY:
            self._images /= 2
            self._false /= 2
            self._places = (self._places + _PRIOR) / 2
        if self._fresh >= min(_NEIGHBOURS // 2, self._learnt) > 0:
            scores, genuine = self._outcomes[: self._learnt].T
            order = np.argsort(scores, kind="stable")
            self._sorted = scores[order]
            self._sums = np.concatenate([[0.0], np.cumsum(genuine[order])])
            self._fresh = 0

    def samples(self, edges: Array, scores: Array, size: tuple[int, int]) -> list[Sample]:
        """Describe detections by their edges (N, 4) in px and their scores."""
        places = places_of(edges, size)
        return [Sample(*one) for one in zip(scores.tolist(), places, strict=True)]

    @property
    def cluttered(self) -> int:
        """Number of places, of a grid, that had a false alarm lately."""
        return int(np.count_nonzero(self._false >= 0.5))

    def learn(self, sample: Sample, genuine: bool, *, alone: bool = True) -> None:
        """Add the outcome of a detection; one beside a vehicle is no false alarm of its place."""
        self._outcomes[self._learnt % _MEMORY] = sample.score, genuine
        self._learnt += 1
        self._fresh += 1
        row, column = sample.place
        self._false[row, column] += alone and not genuine
        self._places[int(genuine), row, column] += 1

    def log_odds(self, samples: list[Sample]) -> Array:
        """Logarithm of the odds that detections are vehicles, (N,); 0 where nothing is known.

        A place only speaks against a detection: where many vehicles pass, parts of vehicles are
        detected as well.
        """
        scores, rows, columns = _columns(samples)
        totals = self._places.sum(axis=(1, 2))
        here = self._places[:, rows, columns]
        by_place = np.log(here[1] / here[0]) - np.log(totals[1] / totals[0])
        both = self._by_score(scores) + np.minimum(by_place, 0.0)
        return np.asarray(np.clip(both, -CERTAIN, CERTAIN))

    def gains(self, scores: Array) -> Array:
        """Logarithm of how much more often vehicles have scores (N,) than false alarms have."""
        genuine, total = self._sums[-1], len(self._sorted)
        usual = np.log((genuine + _PRIOR) / (total - genuine + _PRIOR))
        return np.asarray(self._by_score(scores) - usual)

    def ranks(self, scores: Array) -> Array:
        """Share of the vehicles' detections with lower scores, (N,); 0 before enough are known."""
        below = self._sums[np.searchsorted(self._sorted, scores)]
        return np.asarray(below / max(self._sums[-1], _NEIGHBOURS))

    def clutter(self, samples: list[Sample]) -> Array:
        """Logarithm of the false alarms per image, (N,), in a place as large as the image.

        The number in one place is that of a Poisson process, its prior the mean of all places.
        """
        _, rows, columns = _columns(samples)
        images = self._images + SETTLED_AFTER
        usual = (self._false.sum() + _FALSE_ALARMS * SETTLED_AFTER) / images
        seen = self._false[rows, columns] * GRID**2 + SETTLED_AFTER * usual
        return np.asarray(np.log(seen / images))

    def _by_score(self, scores: Array) -> Array:
        left = np.searchsorted(self._sorted, scores, "left")
        middle = (left + np.searchsorted(self._sorted, scores, "right")) // 2
        low = np.maximum(middle - _NEIGHBOURS // 2, 0)
        high = np.minimum(middle + _NEIGHBOURS // 2, len(self._sorted))
        genuine = self._sums[high] - self._sums[low]
        return np.asarray(np.log((genuine + _PRIOR) / (high - low - genuine + _PRIOR)))


def _columns(samples: list[Sample]) -> tuple[Array, IntArray, IntArray]:
    """Scores, rows and columns (N,) of samples."""
    places = np.array([one.place for one in samples], dtype=np.intp).reshape(-1, 2)
    return np.array([one.score for one in samples]), places[:, 0], places[:, 1]

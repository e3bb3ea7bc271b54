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

"""Probability that a detection is a vehicle, learnt from the outcomes of earlier ones.

Two things tell: the score, of which only the order counts, so that a detector whose scores are
squared or halved is the same one; and the place, because a tree in the wind is reported again and
again. A place only speaks against a detection: where many vehicles pass, parts of vehicles are
detected as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array

_REMEMBERED = 2000
"""Detections that are remembered: some minutes of a few vehicles."""
_NEIGHBOURS = 40
"""Detections of about the same score, by rank, that a probability is taken from."""
_PRIOR = 2.0
"""Weight of the prior on each side, in detections."""
_REFRESHED_EVERY = 20
"""New outcomes after which the order is taken anew."""
_GRID = 16
"""Places along each side of the image."""
_OLD = 200.0
"""Outcomes at a place from which on they are halved: light and wind change."""
_LARGEST_LOG_ODDS = 6.0


@dataclass(frozen=True, slots=True)
class Sample:
    """Score and place of a detection whose outcome is to be learnt."""

    score: float
    place: tuple[int, int]


class DetectionEvidence:
    """Outcomes of detections by score and place."""

    def __init__(self) -> None:
        self._scores = np.empty(_REMEMBERED)
        self._genuine = np.empty(_REMEMBERED)
        self._count = 0
        self._fresh = 0
        self._sorted = np.empty(0)
        self._sums = np.zeros(1)
        self._places = np.full((2, _GRID, _GRID), _PRIOR)

    def sample(self, edges: Array, score: float, size: tuple[int, int]) -> Sample:
        """Describe a detection by its edges (px) and its score."""
        centre = (edges[:2] + edges[2:]) / 2
        column, row = np.clip(centre / size * _GRID, 0, _GRID - 1).astype(int).tolist()
        return Sample(score, (row, column))

    def learn(self, sample: Sample, genuine: bool) -> None:
        """Add the outcome of a detection."""
        index = self._count % _REMEMBERED
        self._scores[index], self._genuine[index] = sample.score, genuine
        self._count += 1
        self._fresh += 1
        if self._fresh >= min(_REFRESHED_EVERY, self._count):
            self._refresh()
        row, column = sample.place
        self._places[int(genuine), row, column] += 1
        if self._places[:, row, column].sum() > _OLD:
            self._places[:, row, column] /= 2

    def log_odds(self, samples: list[Sample]) -> Array:
        """Logarithm of the odds that detections are vehicles, (N,); 0 where nothing is known."""
        if not samples:
            return np.zeros(0)
        by_score = self._by_score(np.array([one.score for one in samples]))
        rows, columns = np.array([one.place for one in samples]).T
        totals = self._places.sum(axis=(1, 2))
        here = self._places[:, rows, columns]
        by_place = np.log(here[1] / here[0]) - np.log(totals[1] / totals[0])
        both = by_score + np.minimum(by_place, 0.0)
        return np.asarray(np.clip(both, -_LARGEST_LOG_ODDS, _LARGEST_LOG_ODDS))

    def _by_score(self, scores: Array) -> Array:
        left = np.searchsorted(self._sorted, scores, "left")
        middle = (left + np.searchsorted(self._sorted, scores, "right")) // 2
        low = np.maximum(middle - _NEIGHBOURS // 2, 0)
        high = np.minimum(middle + _NEIGHBOURS // 2, len(self._sorted))
        genuine = self._sums[high] - self._sums[low]
        return np.asarray(np.log((genuine + _PRIOR) / (high - low - genuine + _PRIOR)))

    def _refresh(self) -> None:
        count = min(self._count, _REMEMBERED)
        order = np.argsort(self._scores[:count], kind="stable")
        self._sorted = self._scores[order]
        self._sums = np.concatenate([[0.0], np.cumsum(self._genuine[order])])
        self._fresh = 0

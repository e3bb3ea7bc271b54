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

"""Evidence on visibility: log-likelihood ratios of visible to hidden, and of whole to partial.

The vehicle is whole, partly hidden or hidden. Each hypothesis judges for itself whether it is
hidden (`Hypotheses`); whether all of a visible one is seen, is judged here, for all of them.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation_filter import climbed
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.parameters import VisibilityParameters

_LARGEST_LOG_RATIO = 6.0
"""Bound of one observation's log ratio: no single frame is believed beyond 400 to 1."""
_LARGEST_PARTIAL_LOG_RATIO = 3.0
"""The same of whole against partial, 20 to 1: errors of flow last over frames."""
_HIGHEST_RESPONSE = 1.2
"""Response above which more of it tells nothing more."""
_PEAK_REACH = 6
"""Places of the response around the mean within which its peak is the estimate: a third of the
target's side."""
WIDE_FROM = 0.5
"""Spread of the hypotheses, of the size, from which a wide patch is searched."""
SAME_VEHICLE = 0.5
"""Distance from the best hypothesis, of the size, within which others mean the same vehicle."""


class Climb(NamedTuple):
    """Neighbourhood within which a hypothesis is moved to a better place.

    Attributes
    ----------
    reach : int
        Places of the response to each side.
    sigma : float
        Standard deviation, in places, that a move is paid for with.
    """

    reach: int
    sigma: float


CLIMB_FREELY, CLIMB_ON_PATH, STAY = Climb(5, 3.0), Climb(3, 1.0), Climb(0, 1.0)
"""Where the path is known better than the place it has to keep to it: while hidden, else all would
gather at clutter. A measured first motion is kept to exactly: a standing part of the first box
answers better than the vehicle, and the filter cannot tell which of them it was shown."""


class Visibility(Enum):
    """How much of the vehicle is seen."""

    VISIBLE = "visible"
    PARTLY_HIDDEN = "partly hidden"
    TURNING = "turning"
    HIDDEN = "hidden"
    GONE = "gone"

    @property
    def is_seen(self) -> bool:
        """True where the vehicle itself tells where it is."""
        return self not in (Visibility.HIDDEN, Visibility.GONE)


@functools.cache
def _costs(climb: Climb) -> Array:
    """Costs of all moves in reach, as log ratios, by [y, x]."""
    offsets = np.arange(-climb.reach, climb.reach + 1) ** 2
    return np.asarray(0.5 * (offsets[:, np.newaxis] + offsets) / climb.sigma**2)


def response_evidence(
    view: View, positions: Array, climb: Climb, parameters: VisibilityParameters
) -> tuple[Array, Array]:
    """Judge hypotheses by the filter's response close by.

    Parameters
    ----------
    view : View
        The response around the prediction.
    positions : (N, 2) array
        Positions of the hypotheses, px.

    Returns
    -------
    positions : (N, 2) array
        Moved to the best place in reach, px.
    log_ratios : (N,) array
        Log-likelihood ratio there, less what the move costs.
    """
    seen = np.minimum(np.maximum(view.response, 0), np.float32(_HIGHEST_RESPONSE))
    ratios = parameters.response_slope * (seen.astype(np.float64) - parameters.response_middle)
    moves, log_ratios = climbed(ratios, view.places(positions), _costs(climb))
    return positions + moves / view.steps, np.clip(
        log_ratios, -_LARGEST_LOG_RATIO, _LARGEST_LOG_RATIO
    )


def likeliest_peak(view: View, particles: Hypotheses, extent: float) -> tuple[Array, float]:
    """Peak of the response at the best of the visible hypotheses: its position in px, and height.

    Parameters
    ----------
    extent : float
        Geometric mean of the vehicle's sides, px.
    """
    votes = particles.weights * particles.visible
    best = particles.positions[int(votes.argmax())]
    apart = np.linalg.norm(particles.positions - best, axis=1)
    votes = np.where(apart < SAME_VEHICLE * extent, votes, 0.0)
    return view.peak_near(votes @ particles.positions / votes.sum(), _PEAK_REACH)


def points_evidence(share: float, parameters: VisibilityParameters) -> float:
    """Log-likelihood ratio by the share of the surface's points that move with the vehicle."""
    return parameters.points_slope * (min(share, 1.0) - parameters.points_middle)


@dataclass(slots=True)
class Wholeness:
    """The states *whole* and *partial* of a vehicle that is visible, as a Markov chain.

    Attributes
    ----------
    probability : float
        Probability that it is whole, given that it is visible.
    """

    probability: float = 0.99

    @property
    def is_likely(self) -> bool:
        """True where whole is likelier than partial."""
        return self.probability > 0.5

    def judge(self, share: float, elapsed: float, parameters: VisibilityParameters) -> None:
        """Let `elapsed` frames pass, and take the share of the surface as evidence.

        Covering begins and ends as often as occlusions do; an occluder shows in the share while
        response and position do not yet fall.
        """
        if not parameters.partial_slope:
            self.probability = 1.0
            return
        covered = 1 - (1 - parameters.hiding_rate) ** elapsed
        uncovered = 1 - (1 - parameters.return_rate) ** elapsed
        before = self.probability * (1 - covered) + (1 - self.probability) * uncovered
        ratio = parameters.partial_slope * (share - parameters.partial_middle)
        bound = _LARGEST_PARTIAL_LOG_RATIO
        whole = before * math.exp(min(max(ratio, -bound), bound))
        self.probability = whole / (whole + (1 - before))

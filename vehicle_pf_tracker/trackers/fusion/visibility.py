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

"""Evidence for the vehicle being visible: log-likelihood ratios of visible against hidden."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.parameters import VisibilityParameters

_LARGEST_LOG_RATIO = 6.0
"""Bound of one observation's log ratio: no single frame is believed beyond 400 to 1."""
_HIGHEST_RESPONSE = 1.2
"""Response above which more of it tells nothing more."""
_PEAK_REACH = 6
"""Places of the response around the mean within which its peak is the estimate: a third of the
target's side."""
_SAME_VEHICLE = 0.5
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


@functools.cache
def _moves(climb: Climb) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], Array]:
    """All moves in reach along x and y, in places, and what they cost as log ratios."""
    offsets = np.arange(-climb.reach, climb.reach + 1)
    dy, dx = (grid.ravel() for grid in np.meshgrid(offsets, offsets, indexing="ij"))
    return dx, dy, np.asarray(0.5 * (dx**2 + dy**2) / climb.sigma**2)


def response_evidence(
    view: View, positions: Array, climb: Climb, parameters: VisibilityParameters
) -> tuple[Array, Array]:
    """Judge hypotheses by the filter's response close by.

    Parameters
    ----------
    view : View
        The response around the prediction.
    positions : (N, 2) array
        Of the hypotheses, px.

    Returns
    -------
    positions : (N, 2) array
        Moved to the best place in reach, px.
    log_ratios : (N,) array
        Log-likelihood ratio there, less what the move costs.
    """
    dx, dy, costs = _moves(climb)
    places = view.places(positions)
    last = len(view.response) - 1
    rows = np.clip(places[:, 1, np.newaxis] + dy, 0, last)
    columns = np.clip(places[:, 0, np.newaxis] + dx, 0, last)
    rows *= last + 1
    rows += columns
    near = view.response.ravel().take(rows)
    near = np.minimum(np.maximum(near, 0), np.float32(_HIGHEST_RESPONSE)).astype(np.float64)
    ratios = parameters.response_slope * (near - parameters.response_middle)
    ratios -= costs
    best = ratios.argmax(axis=1)
    moves = np.column_stack([dx[best], dy[best]]) / view.steps
    log_ratios = ratios[np.arange(len(best)), best]
    return positions + moves, np.clip(log_ratios, -_LARGEST_LOG_RATIO, _LARGEST_LOG_RATIO)


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
    votes = np.where(apart < _SAME_VEHICLE * extent, votes, 0.0)
    return view.peak_near(votes @ particles.positions / votes.sum(), _PEAK_REACH)


def points_evidence(survival: float, parameters: VisibilityParameters) -> float:
    """Log-likelihood ratio by the survival of points on the surface, of the usual survival."""
    return parameters.points_slope * (min(survival, 1.0) - parameters.points_middle)

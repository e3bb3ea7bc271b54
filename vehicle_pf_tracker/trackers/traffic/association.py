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

"""Assignment of detections to tracks.

The cost of a pair is the squared Mahalanobis distance of the four edges, or, where the detection
lies inside the predicted box because something hides a part, that of the edges that are not drawn
in; and the difference in colour.
"""

from __future__ import annotations

import importlib.util

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.traffic.numbers import SHIPPED, TrafficNumbers

GATE = 30.0
"""Largest cost of a pair: the 0.9999 quantile of chi-squared with four degrees of freedom is 23.5,
and colours may differ."""
INWARD = np.array([1.0, 1.0, -1.0, -1.0])
"""Sign of a residual (detection less prediction) of left, top, right, bottom that points inward."""
_LEAST_PART = 0.15
"""Smallest share of the vehicle that a detection may show."""


def check_library() -> None:
    """Check at the start, not in the first frame, that the library of `assign` is there.

    Raises
    ------
    InputError
        If it is not.
    """
    if importlib.util.find_spec("scipy") is None:
        raise InputError(
            "traffic needs the Python module scipy: install the extra [traffic], "
            "pip install 'vehicle_pf_tracker[traffic]', or with apt python3-scipy"
        )


def edge_costs(
    predicted: Array, deviations: Array, detected: Array, numbers: TrafficNumbers = SHIPPED
) -> Array:
    """Cost of each pair by the edges, (tracks, detections).

    Parameters
    ----------
    predicted, deviations : (T, 4) arrays
        Edges of the tracks and their standard deviations, measurement included, px.
    detected : (D, 4) array
        Edges of the detections, px.
    numbers : TrafficNumbers
        Costs of detections that show a part of the vehicle.
    """
    inward = (detected[np.newaxis] - predicted[:, np.newaxis]) * INWARD
    normal = inward / deviations[:, np.newaxis]
    whole = (normal**2).sum(axis=2)
    outward = (np.minimum(normal, 0.0) ** 2).sum(axis=2)
    size = (predicted[:, 2:] - predicted[:, :2])[:, np.newaxis]
    lacking = np.maximum(inward, 0.0)
    kept = np.clip(1 - (lacking[..., :2] + lacking[..., 2:]) / size, 0.0, 1.0).prod(axis=2)
    part = outward + numbers.partial + numbers.missing * (1 - kept)
    return np.asarray(np.where(kept > _LEAST_PART, np.minimum(whole, part), whole))


def assign(costs: Array) -> list[tuple[int, int]]:
    """Pairs (row, column) of least total cost, each below the gate."""
    if costs.size == 0:
        return []
    # Not at the top: help and parameters of `traffic` are printed without this library.
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415

    bounded = np.minimum(costs, GATE)
    rows, columns = linear_sum_assignment(bounded)
    good = bounded[rows, columns] < GATE
    return list(zip(rows[good].tolist(), columns[good].tolist(), strict=True))

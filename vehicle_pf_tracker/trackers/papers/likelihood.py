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

"""Colour likelihood (P1 eq. 25), and the parameters that variants of several papers have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.filtering.resampling import SCHEMES
from vehicle_pf_tracker.filtering.weights import Weights
from vehicle_pf_tracker.image.similarity import hellinger_distance
from vehicle_pf_tracker.parameters.table import parameter


@dataclass(frozen=True, slots=True)
class LikelihoodParameters:
    """Decrease of the weights with the distance of the histograms."""

    sigma_v: float = parameter(
        0.1, "Smaller: weights fall faster as a particle's histogram departs from the reference.",
        bounds=(1e-3, 100.0), source="P1 eq. 25, interpretation 1 (printed: 1.5)", tuned=True,
    )  # fmt: skip
    squared_distance: bool = parameter(
        True, "False takes the distance unsquared, as printed; the weights are then almost flat.",
        source="P1 eq. 25, interpretation 1",
    )  # fmt: skip


def log_likelihood(coefficients: Array, parameters: LikelihoodParameters) -> Weights:
    """Logarithm of equation 25 without its constant factor.

    Parameters
    ----------
    coefficients : (N,) array
        Bhattacharyya coefficients of the particles' histograms with the reference.
    parameters : LikelihoodParameters
        Spread of the distance, and whether it is squared.

    Returns
    -------
    (N,) array
        ``-d_B² / (2 sigma_v²)``, or with ``d_B`` in place of its square.
    """
    distance = hellinger_distance(coefficients)
    if parameters.squared_distance:
        distance = np.square(distance)
    return np.asarray(distance / (-2 * parameters.sigma_v**2))


def as_printed_switch(source: str) -> Any:
    """Make the switch that follows the paper to the letter; `source` names what it undoes."""
    return parameter(
        False, "Follow the paper to the letter: overrides every interpretation below.",
        source=source,
    )  # fmt: skip


def histogram_bits_parameter(*, tuned: bool = False) -> Any:
    """Make the resolution of joint colour histograms."""
    return parameter(
        3, "More: finer colours, more easily upset by light and noise.", bounds=(1, 5),
        unit="bits/channel", source="P1 section III-C", effect="relearns", tuned=tuned,
    )  # fmt: skip


def resampling_parameter(source: str) -> Any:
    """Make the choice of a resampling scheme; `source` is where the paper resamples."""
    return parameter(
        "multinomial", "How ancestors are drawn; systematic and stratified vary less.",
        choices=SCHEMES, source=source,
    )  # fmt: skip

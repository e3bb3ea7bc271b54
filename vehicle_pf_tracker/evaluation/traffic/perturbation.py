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

"""Detections made worse, or scored otherwise, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from vehicle_pf_tracker.core.array import Array

UNCHANGED = "unchanged"
DROPPED = 0.2
"""Share of detections that `dropped` leaves out."""
_SEED = 20
"""Seed of what is left out: the same for every system."""
_PERIOD, _FIRST = 200, 100
"""Frames from one gap to the next, and the first gap's first frame: the tracks before it are old
enough, and the last clip has four gaps."""

Perturbation = Callable[[Array], Array]
"""Takes rows (frame, left, top, width, height, score) and returns others."""


def _dropped(rows: Array) -> Array:
    kept: Array = rows[np.random.default_rng(_SEED).uniform(size=len(rows)) >= DROPPED]
    return kept


def _with_gaps(length: int) -> Perturbation:
    def without(rows: Array) -> Array:
        late = rows[:, 0] - _FIRST
        kept: Array = rows[(late < 0) | (late % _PERIOD >= length)]
        return kept

    return without


def _scored(change: Callable[[Array], Array]) -> Perturbation:
    return lambda rows: np.column_stack([rows[:, :5], change(rows[:, 5])])


PERTURBATIONS: Mapping[str, Perturbation] = MappingProxyType(
    {
        UNCHANGED: lambda rows: rows,
        "dropped": _dropped,
        "gap20": _with_gaps(20),
        "gap40": _with_gaps(40),
        "squared": _scored(np.square),
        "halved": _scored(lambda scores: scores / 2),
    }
)
"""A fifth of the detections dropped; 20 and 40 of every 200 frames without any; other scores."""

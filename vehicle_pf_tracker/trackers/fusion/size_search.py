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

"""Width and height of the box, by trying sizes a step larger and smaller."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.parameters import SizeParameters

_DIRECTIONS = ((1.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
"""Axes that are stretched, one pair of sizes per frame in turns: vehicles mostly keep their aspect,
so that both sides together have every second turn."""


def searched_size(
    size: Array, turn: int, peak: Callable[[Array], float],
    parameters: SizeParameters,
) -> Array:  # fmt: skip
    """Move the size towards the vertex of the response over three sizes.

    Parameters
    ----------
    size : (2,) array
        Width and height, px.
    turn : int
        Number of the frame, which decides the direction that is tried.
    peak : callable
        Response at a size.
    """
    direction = np.array(_DIRECTIONS[turn % len(_DIRECTIONS)])
    together = direction.all()
    gain = parameters.gain if together else parameters.aspect_gain
    if not parameters.step or not gain:
        return size
    factor = (1 + parameters.step) ** direction
    at_size, smaller, larger = peak(size), peak(size / factor), peak(size * factor)
    bend = smaller + larger - 2 * at_size
    if bend < -1e-6 * at_size:
        steps = min(max(0.5 * (smaller - larger) / bend, -1.0), 1.0)
    else:
        steps = float(np.sign(larger - smaller))
    return np.asarray(size * factor ** (gain * steps))

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

"""Re-identification of a vehicle that reappears away from its predicted position.

Before a new vehicle is reported, those that are hidden near by are asked whether it is one of them:
by distance, size and colours.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.trackers.traffic.colours import similarity
from vehicle_pf_tracker.trackers.traffic.track import Track

_MISSED_FOR = 5.0
"""Nominal periods without a detection from which on a vehicle may be hidden."""
_IN_SIGHT = 0.5
"""Share of its prediction that is in sight, below which it is where it is thought to be, behind
another one: what appears near by is not it. Without this a car that comes out behind a lorry is
taken for the one that the lorry hides."""
_REACH = 1.0
"""Distance from the prediction, in widths, within which a vehicle can reappear at once; ..."""
_REACH_GROWTH = 1 / 30
"""... and its growth per nominal period, of itself: roads bend, drivers brake."""
_SIZE_RATIO = 2.0
"""Largest ratio of areas: a vehicle reappears part by part. At 4, boxes of two merged vehicles were
taken for one of them (of three seeds of `traffic-forty` with `poor`, IDF1 lower by 0.5 on
average)."""
_LARGEST_FALL = 0.25
"""Fall of the colours' similarity below its usual value up to which it may be the same vehicle."""


def former(track: Track, others: Sequence[Track]) -> Track | None:
    """Find the hidden vehicle that a new one is, if it is any.

    Parameters
    ----------
    track : Track
        The new one.
    others : sequence of Track
        All tracks.
    """
    costs = [(cost, one.identity, one) for one in others if (cost := _cost(track, one)) is not None]
    return min(costs)[2] if costs else None


def resume(hidden: Track, track: Track) -> None:
    """Go on with a hidden vehicle where the new track that it turned out to be is."""
    hidden.state, hidden.before = track.state, track.before
    hidden.score, hidden.label = track.score, track.label or hidden.label
    hidden.unseen = hidden.undetected = 0.0
    hidden.log_odds = max(hidden.log_odds, track.log_odds)
    hidden.visible, hidden.covers, hidden.hidden_by = track.visible, track.covers, None
    hidden.sides, hidden.partial = track.sides, track.partial


def _cost(track: Track, other: Track) -> float | None:
    """Distance in reaches; None where it cannot be the same vehicle."""
    if other is track or not other.confirmed or other.undetected < _MISSED_FOR:
        return None
    if other.visible < _IN_SIGHT:
        return None
    new, old = track.state.box, other.state.box
    ratio = new.area / old.area
    if not 1 / _SIZE_RATIO < ratio < _SIZE_RATIO:
        return None
    (x, y), (u, v) = new.centre, old.centre
    width = math.sqrt(new.width * old.width)
    distance = math.hypot(x - u, y - v) / width / (_REACH * (1 + _REACH_GROWTH * other.undetected))
    fall = other.usual_similarity - similarity(other.colours, track.colours)
    if distance > 1 or fall > _LARGEST_FALL or not np.any(track.colours):
        return None
    return distance

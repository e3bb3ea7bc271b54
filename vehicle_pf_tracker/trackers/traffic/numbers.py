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

"""Numbers of `traffic` that can be fitted but that no user turns.

`laboratory/traffic_fit.py` fits them to synthetic scenes. The defaults were chosen by hand;
laboratory/notes/traffic.md has the comparison.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TrafficNumbers:
    """Weights and thresholds.

    Attributes
    ----------
    agreement : float
        Log odds that a detection adds by being where a track predicts it.
    proven_by_scores : float
        Sum of the log odds of scores from which on no drive is asked for.
    missed_held, missed_hidden : float
        Log odds that a detection missed in plain sight takes off a vehicle that its pixels hold,
        and off one that may be hidden by something unknown.
    partial : float
        Cost of taking a detection for a part of the vehicle.
    missing : float
        Cost of all of the vehicle that the detection lacks.
    held_fall : float
        Fall of the colours' similarity below its usual value from which on pixels do not hold it.
    held_caution : float
        Factor on the deviations of pixels: errors of successive frames go the same way and add up.
    colour_threshold : float
        Sum of the differences of the three channels from which on a pixel has changed.
    patience : float
        Images for which what has changed is not learnt as background: four seconds, in which a slow
        lorry passes.
    shadow : float
        Least brightness of a shadow, of the background's.
    apart : float
        Advantage in shape from which on a blob is taken for several vehicles.
    """

    agreement: float = 1.2
    proven_by_scores: float = 4.0
    missed_held: float = 0.3
    missed_hidden: float = 0.12
    partial: float = 3.0
    missing: float = 12.0
    held_fall: float = 0.15
    held_caution: float = 1.5
    colour_threshold: float = 32.0
    patience: float = 100.0
    shadow: float = 0.35
    apart: float = 1.0


SHIPPED = TrafficNumbers()
"""Numbers in use."""

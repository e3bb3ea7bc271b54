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

"""Every k-th pixel of large windows, so that a step takes as long for a near vehicle as for others.

Where k is 1, nothing is changed by a single bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Positions, Window

MOST_PIXELS = 100_000
"""Of a window: 25 particles of `hpfms` with three shifts each take 30 ms for so many. Vehicles of
316 px squared and less are not reduced, which are all but the nearest in 1080p."""


@dataclass(frozen=True, slots=True)
class Reduction:
    """Mapping of positions in a frame to those in its every `step`-th row and column."""

    step: int = 1

    @classmethod
    def of_window(cls, window: Window) -> Reduction:
        """Return the least reduction that leaves at most `MOST_PIXELS` of a window."""
        return cls(max(math.ceil(math.sqrt(window.width * window.height / MOST_PIXELS)), 1))

    def frame(self, frame: Frame) -> Frame:
        """View of the pixels that are left."""
        return frame if self.step == 1 else frame[:: self.step, :: self.step]

    def window(self, window: Window) -> Window:
        """Measure a window in pixels that are left."""
        if self.step == 1:
            return window
        return Window.of_size(window.width / self.step, window.height / self.step)

    def positions(self, positions: Positions) -> Positions:
        """Positions in the reduced frame: the centre of pixel 0 stays where it is."""
        return positions if self.step == 1 else (positions - 0.5) / self.step + 0.5

    def back(self, positions: Positions) -> Positions:
        """Positions in the whole frame of those in the reduced one."""
        return positions if self.step == 1 else (positions - 0.5) * self.step + 0.5

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

"""First boxes that are a little off: OTB's spatial robustness."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box

_SHIFT = 0.1
"""Shift of OTB's spatial robustness (Wu, Lim and Yang 2013), in widths and heights of the box."""
_SCALES = (0.8, 0.9, 1.1, 1.2)
_SIDES = {
    "left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1),
    "left_up": (-1, -1), "right_up": (1, -1), "left_down": (-1, 1), "right_down": (1, 1),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Start:
    """Displacement of the first box, in its widths and heights, and the factor of its sides."""

    name: str = ""
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def box(self, true: Box) -> Box:
        """Return the box to start on."""
        if self == TRUE_START:
            return true
        x, y = true.centre
        centre = x + self.shift[0] * true.width, y + self.shift[1] * true.height
        return Box.around(centre, true.width * self.scale, true.height * self.scale)


TRUE_START = Start()
"""The true box."""


def shifted_starts() -> list[Start]:
    """Return the twelve starts of OTB: eight shifts by a tenth of the box, and four scales."""
    shifts = [Start(name, (_SHIFT * x, _SHIFT * y)) for name, (x, y) in _SIDES.items()]
    return shifts + [Start(f"scale_{scale:g}", scale=scale) for scale in _SCALES]

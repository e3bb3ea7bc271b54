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

"""Starts of the OTB benchmark: shifted and scaled first boxes, and later frames.

Source: Wu, Lim and Yang 2013, "Online object tracking: a benchmark", spatial and temporal
robustness evaluation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth

_SHIFT = 0.1
"""Shift of OTB's spatial robustness, in widths and heights of the box."""
_SCALES = (0.8, 0.9, 1.1, 1.2)
_SIDES = {
    "left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1),
    "left_up": (-1, -1), "right_up": (1, -1), "left_down": (-1, 1), "right_down": (1, 1),
}  # fmt: skip
_LAST_START = 0.8
"""Share of a recording in which runs start: a fifth of it at least is left to track."""


@dataclass(frozen=True, slots=True)
class Start:
    """Displacement of the first box, in its widths and heights, and the factor of its sides."""

    name: str = ""
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def box(self, true: Box) -> Box:
        """Return the box to start on."""
        if self == USUAL:
            return true
        x, y = true.centre
        centre = x + self.shift[0] * true.width, y + self.shift[1] * true.height
        return Box.around(centre, true.width * self.scale, true.height * self.scale)


USUAL = Start()
"""The true box."""


def shifted_starts() -> list[Start]:
    """Return the twelve starts of OTB: eight shifts by a tenth of the box, and four scales."""
    shifts = [Start(name, (_SHIFT * x, _SHIFT * y)) for name, (x, y) in _SIDES.items()]
    return shifts + [Start(f"scale_{scale:g}", scale=scale) for scale in _SCALES]


def later_starts(truths: Sequence[Truth | None], count: int) -> list[int]:
    """Return the indices of `count` frames with truth, spread evenly over most of a sequence.

    The first one is left out. Where the vehicle is hidden, even in part, the next frame in which it
    is not is taken; so there may be fewer.
    """
    known = [(index, truth) for index, truth in enumerate(truths) if truth is not None]
    found = []
    for number in range(1, count + 1):
        begin = round(number * _LAST_START * (len(known) - 1) / count)
        clear = (n for n in range(begin, len(known)) if known[n][1].occlusion is Occlusion.NONE)
        found.append(next(clear, 0))
    return [known[n][0] for n in dict.fromkeys(found) if n]

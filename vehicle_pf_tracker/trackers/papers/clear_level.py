# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Occlusion test of `apf`: departure of a similarity from its level in clear frames.

Similarities of real vehicles vary with size, light and pose, those of synthetic ones hardly do. A
drop is therefore compared with the running mean and mean deviation of clear frames, with
hysteresis. A drop to a small share of the mean counts whatever the deviation. The paper has a fixed
threshold in its place; this test is an extension of it (interpretation 27).
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.trackers.evidence import RunningLevel
from vehicle_pf_tracker.trackers.parameters import share

RELATIVE_RULE = "extension: the relative rule (interpretation 27)"
"""Source of the parameters that the extension has and the paper has not."""
_LEAST_DEVIATION = 0.005
"""Deviation that is assumed at least, for images without noise: half of the smallest that was
measured on 19 real sequences (0.011)."""


@dataclass(frozen=True, slots=True)
class ClearLevelParameters:
    """Thresholds at which a similarity leaves its clear level and returns to it."""

    enter: float = parameter(
        6.0, "Higher: deeper falls of the similarity are needed to switch to the occlusion regime.",
        bounds=(0.0, 100.0), unit="mean deviations below the level", source=RELATIVE_RULE,
        tuned=True,
    )  # fmt: skip
    leave: float = parameter(
        4.0, "Higher: the regular regime returns while less of the vehicle is visible.",
        bounds=(0.0, 100.0), unit="mean deviations below the level", source=RELATIVE_RULE,
    )  # fmt: skip
    certain: float = share(
        0.65, "Higher: smaller falls are occlusions however much the similarity varies; 0: never.",
        unit="of the level", source=RELATIVE_RULE, tuned=True,
    )  # fmt: skip
    rate: float = share(
        0.05, "Higher: level and deviation follow the similarity faster.", unit="per frame",
        source=RELATIVE_RULE,
    )  # fmt: skip


class ClearLevel(RunningLevel):
    """Level of one similarity in clear frames; `clear` is true while the similarity is at it."""

    def __init__(self) -> None:
        super().__init__()
        self.clear = True

    def judge(self, similarity: float, parameters: ClearLevelParameters) -> None:
        """Compare `similarity` with the level, which sets `clear`; the level stays."""
        if self.count == 0:
            # Of a vehicle that has not been seen clear yet no deviation is known: only a fall to a
            # small share of Pi_0 = 1 (step 2) counts.
            self.clear = similarity >= parameters.certain
        else:
            multiple = parameters.enter if self.clear else parameters.leave
            least = self.value - multiple * max(self.deviation, _LEAST_DEVIATION)
            # An occlusion in the first frames meets a deviation that is still wide.
            self.clear = similarity >= max(least, parameters.certain * self.value)

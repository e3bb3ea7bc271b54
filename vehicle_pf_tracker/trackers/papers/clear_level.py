"""Whether a similarity is at its usual level, judged by how much it varies while it is.

Similarities of real vehicles change with size, light and pose, those of made ones hardly do. So a
fall is held against the running mean and the running mean deviation of clear frames, with
hysteresis. A fall to a small share of the mean is one whatever the deviation.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter

_FIRST_DEVIATION = 0.05
"""Deviation to begin with, so that larger changes are borne until the true one is known."""
_LEAST_DEVIATION = 0.005
"""Deviation below which noise would decide."""

_LARGEST_AWAY = 2.0
"""Deviations that one frame can count as, at most."""


@dataclass(frozen=True, slots=True)
class ClearLevelParameters:
    """When a similarity leaves its clear level, and when it is back."""

    enter: float = parameter(
        6.0,
        "Higher: deeper falls of the similarity are needed to switch to the occlusion regime.",
        minimum=0.0,
        maximum=100.0,
        unit="mean deviations below the level",
        tuned=True,
    )
    leave: float = parameter(
        4.0,
        "Higher: the regular regime returns while less of the vehicle is seen again.",
        minimum=0.0,
        maximum=100.0,
        unit="mean deviations below the level",
    )
    certain: float = parameter(
        0.65,
        "Higher: smaller falls are occlusions however much the similarity varies; 0: never.",
        minimum=0.0,
        maximum=1.0,
        unit="of the level",
        tuned=True,
    )
    rate: float = parameter(
        0.05,
        "Higher: level and deviation follow the similarity faster.",
        minimum=0.0,
        maximum=1.0,
        unit="per frame",
    )


class ClearLevel:
    """Keeps level and deviation of one similarity; `clear` tells whether the last was at it."""

    def __init__(self) -> None:
        self.value = 0.0
        self.deviation = _FIRST_DEVIATION
        self.clear = True
        self._frames = 0

    def judge(self, similarity: float, parameters: ClearLevelParameters) -> None:
        """Hold `similarity` against the level, which sets `clear`; does not count it."""
        if self._frames > 0:
            share = parameters.enter if self.clear else parameters.leave
            least = self.value - share * max(self.deviation, _LEAST_DEVIATION)
            # An occlusion in the first frames meets a deviation that is still wide.
            self.clear = similarity >= max(least, parameters.certain * self.value)

    def follow(self, similarity: float, parameters: ClearLevelParameters) -> None:
        """Count the similarity of a clear frame."""
        self._frames += 1
        # A plain mean at first, since the first value alone says little about the level.
        rate = max(parameters.rate, 1.0 / self._frames)
        if self._frames > 1:
            # Counted whole, a fall that goes on would widen the very bound it is held against.
            away = min(abs(similarity - self.value), _LARGEST_AWAY * self.deviation)
            self.deviation += parameters.rate * (away - self.deviation)
        self.value += rate * (similarity - self.value)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Visibility of the vehicle: the mode of every variant, from evidence with hysteresis.

The evidence is the similarity of the image at the estimate to the reference. It is compared with
its own running level in clear frames, because the similarity of a visible vehicle differs between
vehicles and cameras. The regime of an algorithm takes no part in this.
"""

from __future__ import annotations

from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.parameters import CommonParameters

FIRST_DEVIATION = 0.05
"""Deviation to start from. Colour similarities deviate by 0.02 to 0.08 on average in the first 30
frames of 19 real sequences, so that ordinary changes are tolerated before their size is known."""

_LARGEST_EXCESS = 2.0
"""Deviations that one value counts as, at most. Counted in full, a decline that goes on would widen
the very bound that it is compared with."""


class RunningLevel:
    """Running mean of a measurement and of its absolute deviation from that mean.

    The first values are averaged with equal weights, since the first alone is a poor estimate
    of the level; later ones with the given rate.

    Attributes
    ----------
    value : float
        Level in the measurement's unit; 0 before the first value.
    deviation : float
        Mean absolute deviation from the level.
    count : int
        Number of values so far.
    """

    def __init__(self) -> None:
        self.value = 0.0
        self.deviation = FIRST_DEVIATION
        self.count = 0

    def add(self, value: float, rate: float) -> None:
        """Let level and deviation follow `value`, by the share `rate` (0 to 1) of the distance."""
        self.count += 1
        # The first value has no level to be apart from.
        if self.count > 1:
            distance = min(abs(value - self.value), _LARGEST_EXCESS * self.deviation)
            self.deviation += rate * (distance - self.deviation)
        # A plain mean at first; from 1 / rate values on an exponential one.
        self.value += max(rate, 1.0 / self.count) * (value - self.value)


class EvidenceJudge:
    """Clear level of the evidence, and the mode that follows from each frame's."""

    def __init__(self) -> None:
        self.mode = Mode.TRACKING
        self.seconds_without = 0.0
        self._level = RunningLevel()

    @property
    def level(self) -> float:
        """Running level of the similarity in clear frames, 0 to 1."""
        return self._level.value

    def measures_anew(self) -> None:
        """Find the clear level again, as another reference has another one.

        It stays where the target is not visible now: the level would be that of its occluder.
        """
        if self.mode is Mode.TRACKING:
            self._level = RunningLevel()

    def judge(
        self, similarity: float, seconds: float, parameters: CommonParameters, *, left_image: bool
    ) -> Mode:
        """Take one frame's evidence and return the mode.

        Parameters
        ----------
        similarity : float
            Similarity of the image at the estimate to the reference, 0 to 1.
        seconds : float
            Time since the previous frame, in s.
        parameters : CommonParameters
            Their thresholds count, and the time after which the target is lost.
        left_image : bool
            True where the cloud's mean crossed the border before it was clipped.
        """
        # Two thresholds: with one, similarities close to it would change the mode in each frame.
        visible = self.mode is Mode.TRACKING
        evidence = parameters.evidence
        share = evidence.occluded_below if visible else evidence.clear_above
        if similarity >= max(evidence.minimum, share * self.level):
            self.mode = Mode.TRACKING
            self.seconds_without = 0.0
            # Only here: a level that followed an occluder would take it for the vehicle.
            self._level.add(similarity, evidence.level_rate)
            return self.mode
        self.seconds_without += seconds
        # Lost stays lost without evidence: an estimate at the border does not come back by waiting.
        # At the border at once: a vehicle that has driven out is not hidden.
        is_long = self.seconds_without >= parameters.lost_after
        lost = left_image or is_long or self.mode is Mode.LOST
        self.mode = Mode.LOST if lost else Mode.OCCLUDED
        return self.mode

    def confidence(self, similarity: float) -> float:
        """Similarity relative to its clear level, 0 to 1."""
        return min(similarity / self.level, 1.0) if self.level > 0 else 0.0

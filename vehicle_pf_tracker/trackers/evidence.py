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

"""Visibility of the vehicle: the mode of every variant, from evidence with hysteresis.

The evidence is the similarity of the image at the estimate to the reference. It is compared with
its own running level in clear frames, because the similarity of a visible vehicle differs between
vehicles and cameras. The regime of an algorithm takes no part in this.
"""

from __future__ import annotations

from vehicle_pf_tracker.core.running_level import RunningLevel
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.parameters import EvidenceParameters


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

    def judge(
        self,
        similarity: float,
        seconds: float,
        parameters: EvidenceParameters,
        *,
        lost_after: float,
        left_image: bool,
    ) -> Mode:
        """Take one frame's evidence and return the mode.

        Parameters
        ----------
        similarity : float
            Similarity of the image at the estimate to the reference, 0 to 1.
        seconds : float
            Time since the previous frame, in s.
        parameters : EvidenceParameters
            Thresholds.
        lost_after : float
            Seconds without evidence after which the target counts as lost.
        left_image : bool
            True where the cloud's mean crossed the border before it was clipped.
        """
        if self._is_evidence(similarity, parameters):
            self.mode, self.seconds_without = Mode.TRACKING, 0.0
            self._level.add(similarity, parameters.level_rate)
            return self.mode
        self.seconds_without += seconds
        lost = left_image or self.seconds_without >= lost_after or self.mode is Mode.LOST
        self.mode = Mode.LOST if lost else Mode.OCCLUDED
        return self.mode

    def confidence(self, similarity: float) -> float:
        """Similarity relative to its clear level, 0 to 1."""
        return min(similarity / self.level, 1.0) if self.level > 0 else 0.0

    def _is_evidence(self, similarity: float, parameters: EvidenceParameters) -> bool:
        visible = self.mode is Mode.TRACKING
        share = parameters.occluded_below if visible else parameters.clear_above
        return similarity >= max(parameters.minimum, share * self.level)

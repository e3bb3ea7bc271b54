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

"""Detection of moving vehicles before a standing camera."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate


class MotionDetector:
    """Model of the background, whose difference to the image shows vehicles."""

    def detect(self, frame: Frame, tracks: Sequence[TrackEstimate] = ()) -> Detections:
        """Find what moves.

        Parameters
        ----------
        frame : Frame
            RGB image.
        tracks : sequence of TrackEstimate
            Estimates of the frame before; the background is not learnt where they stand.
        """
        raise NotImplementedError

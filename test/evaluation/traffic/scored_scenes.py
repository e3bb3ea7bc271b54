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

"""Scenes of many vehicles whose truth is written down by hand."""

from pathlib import Path

import numpy as np

from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence


def scene(truth, size, hidden=None, ignored=(), frames=None):
    """A scene with truth rows (frame, identity, left, top, width, height), nothing hidden."""
    truth = np.array(truth, dtype=float).reshape(-1, 6)
    return TrafficSequence(
        folder=Path("scene"),
        frame_count=frames or int(truth[:, 0].max()),
        frame_rate=30,
        size=size,
        truth=truth,
        hidden=np.zeros(len(truth), dtype=bool) if hidden is None else np.array(hidden, dtype=bool),
        ignored=np.array(ignored, dtype=float).reshape(-1, 5),
        detections={},
    )

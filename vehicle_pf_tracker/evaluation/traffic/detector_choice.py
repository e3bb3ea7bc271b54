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

"""The detector that the parameters ask for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from vehicle_pf_tracker.evaluation.traffic.onnx_file import open_network
from vehicle_pf_tracker.trackers.traffic.detector_parameters import (
    MODEL,
    MOTION,
    DetectorParameters,
)
from vehicle_pf_tracker.trackers.traffic.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.network_detector import NetworkDetector
from vehicle_pf_tracker.trackers.traffic.session import Detector


def detector_maker(parameters: DetectorParameters) -> Callable[[], Detector] | None:
    """Return a function that makes the detector; None where there shall be none.

    Raises
    ------
    InputError
        If the network cannot be used.
    """
    if parameters.kind == MOTION:
        return MotionDetector
    if parameters.kind == MODEL:
        path = Path(parameters.model)
        network = NetworkDetector(open_network(path), str(path), parameters)
        return lambda: network  # it keeps nothing between images
    return None

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

"""The detector that the parameters ask for.

A network of the user's in an ONNX file, loaded with ONNX Runtime (the extra `onnx`).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.traffic.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.network_detector import Network, NetworkDetector
from vehicle_pf_tracker.trackers.traffic.parameters import MODEL, MOTION, DetectorParameters
from vehicle_pf_tracker.trackers.traffic.session import Detector


def open_network(path: Path) -> Network:
    """Load a network.

    Raises
    ------
    InputError
        If ONNX Runtime is not installed, or the file cannot be used.
    """
    try:
        runtime = importlib.import_module("onnxruntime")
    except ImportError:
        raise InputError(
            "networks need ONNX Runtime: install the extra [onnx], "
            "pip install 'vehicle_pf_tracker[onnx]'"
        ) from None
    if not path.is_file():
        raise InputError(f"there is no network {path}")
    options = runtime.SessionOptions()
    options.log_severity_level = 3  # errors: it warns of every unused weight
    try:
        network: Network = runtime.InferenceSession(
            str(path), options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # ONNX Runtime's errors have no base of their own
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"the network {path} cannot be loaded: {reason}") from None
    return network


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

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

"""A network of the user's in an ONNX file, loaded with ONNX Runtime (the extra `onnx`)."""

from __future__ import annotations

import importlib
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.traffic.network_detector import Network


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

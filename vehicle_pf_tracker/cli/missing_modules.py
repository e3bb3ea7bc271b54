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

"""Remedies for Python modules that are not installed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

EXTRAS: Mapping[str, str] = MappingProxyType(
    {
        "matplotlib": "evaluation",
        "jinja2": "evaluation",
        "scipy": "traffic",  # `evaluation` brings it too, and says so before
        "numba": "numba",
        "av": "video",
        "onnxruntime": "onnx",
        "distributed": "cluster",
        "fsspec": "cluster",
        "optuna": "tune",
    }
)
"""The extra that brings a module, by its name."""

_ROS_ENDINGS = ("_msgs", "_interfaces", "_srvs")


def remedy(module: str) -> str:
    """Return one sentence that names `module` and what to install or source."""
    name = module.partition(".")[0]
    if name == "rclpy" or name.endswith(_ROS_ENDINGS):
        how = "source ROS's setup.bash, or install the extra [ros], "
        how += "pip install 'vehicle_pf_tracker[ros]'"
    elif name in EXTRAS:
        extra = EXTRAS[name]
        how = f"install the extra [{extra}], pip install 'vehicle_pf_tracker[{extra}]'"
    else:
        how = "it belongs to every installation by pip; where the others are apt's, "
        how += "`pip install mcap lz4 zstandard rosbags rich`"
    return f"the Python module {name} is not there: {how}"

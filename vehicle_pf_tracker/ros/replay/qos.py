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

"""Quality of service of a replay's publishers: as recorded, or as a file says."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml_file

_POLICIES = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
_DURATIONS = ("deadline", "lifespan", "liveliness_lease_duration")
_CONVENTIONS = "avoid_ros_namespace_conventions"
_DEEPEST = 100_000
"""Messages; so many small ones are kept without harm, and a larger number is a mistake."""


def recorded_qos(offered: str, depth: int) -> QoSProfile:
    """Return the QoS to publish a recorded topic with.

    Latched topics (transient local) stay latched, with their depth. All are published reliably:
    that suits best-effort subscriptions too, and lock-step needs it.

    Parameters
    ----------
    offered : str
        The recorded profiles as the recording's YAML text; may be empty or damaged.
    depth : int
        Of topics that are not latched.
    """
    profiles = [one for one in _listed(offered) if isinstance(one, dict)]
    # rosbag2 writes names since Jazzy, and the numbers of rmw before.
    is_latched = profiles and all(
        one.get("durability") in ("transient_local", 1) for one in profiles
    )
    if not is_latched:
        return QoSProfile(depth=depth)
    depths = [one.get("depth") for one in profiles]
    known = [one for one in depths if isinstance(one, int) and 0 < one <= _DEEPEST]
    is_all = any(one.get("history") in ("keep_all", 2) for one in profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL if is_all else HistoryPolicy.KEEP_LAST,
        depth=max(known, default=1),
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
    )


def read_qos_overrides(path: Path) -> dict[str, QoSProfile]:
    """Read a file of QoS by recorded topic, as rosbag2's ``--qos-profile-overrides-path`` does.

    Raises
    ------
    InputError
        If it cannot be read, or says something that is not understood.
    """
    document = read_yaml_file(path, "QoS file")
    if not isinstance(document, dict):
        raise InputError(f"the QoS file {path} does not name topics")
    try:
        return {str(topic): _profile(one) for topic, one in document.items()}
    except (InputError, TypeError, ValueError) as error:
        raise InputError(f"the QoS file {path}: {error}") from None


def _listed(text: str) -> list[Any]:
    try:
        found = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        return []
    return found if isinstance(found, list) else []


def _profile(wanted: Any) -> QoSProfile:
    if not isinstance(wanted, Mapping):
        raise InputError(f"{wanted!r:.60} is not a profile, like {{durability: transient_local}}")
    values: dict[str, Any] = {"history": HistoryPolicy.KEEP_LAST, "depth": 10}
    for key, value in wanted.items():
        values[str(key)] = _value(str(key), value)
    return QoSProfile(**values)


def _value(key: str, value: Any) -> object:
    if key in _POLICIES:
        try:
            return _POLICIES[key][str(value).upper()]
        except KeyError:
            known = ", ".join(name.lower() for name in _POLICIES[key].__members__)
            raise InputError(f"{key} must be one of {known}, not {value!r:.60}") from None
    if key == "depth" and isinstance(value, int) and 0 < value <= _DEEPEST:
        return value
    if key in _DURATIONS and isinstance(value, Mapping) and set(value) <= {"sec", "nsec"}:
        return Duration(seconds=value.get("sec", 0), nanoseconds=value.get("nsec", 0))
    if key == _CONVENTIONS and isinstance(value, bool):
        return value
    known = ", ".join([*_POLICIES, "depth", *_DURATIONS, _CONVENTIONS])
    raise InputError(f"{key}: {value!r:.60} is not understood; there are {known}")

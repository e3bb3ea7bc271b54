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

"""Interface of a recording that can be played; `recordings.reader.Recording` has it.

Where the images of a recording are, for the launch file of a replay.

Quality of service of a replay's publishers: as recorded, or as a file says.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

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
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.parameters.files import read_yaml_file
from vehicle_pf_tracker.recordings.topics import COMPRESSED_IMAGE


class PlayableTopic(Protocol):
    """A topic of a recording."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def type_name(self) -> str:
        """Its ROS type, empty where it is not known."""

    @property
    def is_cdr(self) -> bool:
        """True where its messages are serialized as ROS 2 does it."""

    @property
    def offered_qos(self) -> str:
        """Its recorded QoS profiles as YAML text, empty where they are not known."""


class PlayableMessage(Protocol):
    """A message as it was recorded."""

    @property
    def topic(self) -> str:
        """Its topic."""

    @property
    def log_time_ns(self) -> int:
        """When it was recorded, in ns."""

    @property
    def stamp_ns(self) -> int | None:
        """Stamp of its header in ns, None without one."""

    @property
    def data(self) -> bytes:
        """The message in CDR."""


class Playable(Protocol):
    """A recording, read anew by each call of `messages`."""

    @property
    def path(self) -> object:
        """Path or URL, for messages to the user."""

    @property
    def image_topic(self) -> str:
        """The topic whose images are tracked."""

    @property
    def image_type(self) -> str:
        """Its ROS type."""

    @property
    def topics(self) -> Sequence[PlayableTopic]:
        """All topics."""

    @property
    def start_ns(self) -> int:
        """Log time of the first message in ns."""

    @property
    def end_ns(self) -> int:
        """Log time of the last message in ns."""

    def messages(
        self,
        topics: Collection[str] | None = None,
        start_offset: float = 0.0,
        duration: float | None = None,
    ) -> Iterator[PlayableMessage]:
        """Yield messages in the order of their log times."""

    def truth(self) -> tuple[Truth, ...]:
        """Read all truth."""

    def first_truth(self) -> Truth | None:
        """Read the earliest truth."""


_COMPRESSED = "/compressed"


class RecordedImages(NamedTuple):
    """Where the images of a recording are, and how a node hears them.

    Attributes
    ----------
    topic : str
        As recorded.
    base : str
        What the node's ``image`` is remapped to.
    transport : str
        The node's parameter ``image_transport``.
    published : str
        What the replay publishes them as.
    """

    topic: str
    base: str
    transport: str
    published: str


def recorded_images(recording: Playable) -> RecordedImages:
    """Find how nodes hear the images of a recording."""
    name = recording.image_topic
    if recording.image_type != COMPRESSED_IMAGE:
        return RecordedImages(name, name, "raw", name)
    base = name.removesuffix(_COMPRESSED)
    return RecordedImages(name, base, "compressed", base + _COMPRESSED)


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

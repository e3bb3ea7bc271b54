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

"""Interface of a recording that can be played; `recordings.reader.Recording` has it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Protocol

from vehicle_pf_tracker.core.truth import Truth


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

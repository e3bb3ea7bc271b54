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

"""Where the images of a recording are, for the launch file of a replay."""

from __future__ import annotations

from typing import NamedTuple

from vehicle_pf_tracker.recordings.topics import COMPRESSED_IMAGE
from vehicle_pf_tracker.ros.replay.playable import Playable

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

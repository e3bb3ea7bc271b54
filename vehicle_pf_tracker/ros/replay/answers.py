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

"""Images that a node has answered, and its answers."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.trackers.road_follower import ROAD_COLUMNS

DROPPED = "DROPPED"
"""Mode of a frame that a node never answered; all numbers are empty."""


class Answers:
    """Pairs the `~/mode` messages of one node with the images published, by stamp.

    Images of the same stamp are answered in the order in which they were published.

    Attributes
    ----------
    count : int
        Images answered, in all passes.
    """

    def __init__(self) -> None:
        self.count = 0
        self._stamps: dict[int, int] = {}
        self._waiting: dict[int, deque[int]] = {}
        self._rows: dict[int, EstimateRow] = {}
        self._on_road: dict[int, Mapping[str, str]] = {}

    def begin_pass(self) -> None:
        """Discard earlier frames; a loop begins again with their stamps."""
        self._stamps.clear()
        self._waiting.clear()
        self._rows.clear()
        self._on_road.clear()

    def expect(self, frame: int, stamp_ns: int) -> None:
        """Note that the image number `frame` was published."""
        self._stamps[frame] = stamp_ns
        self._waiting.setdefault(stamp_ns, deque()).append(frame)

    def receive(self, message: Any) -> None:
        """Take a `DiagnosticArray` of `~/mode`; answers to other images are passed over."""
        stamp = message.header.stamp
        stamp_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        frames = self._waiting.get(stamp_ns)
        if not frames or not message.status:
            return
        frame = frames.popleft()
        if not frames:
            del self._waiting[stamp_ns]
        status = message.status[0]
        scalars = {"mode": status.message, **{pair.key: pair.value for pair in status.values}}
        self._rows[frame] = EstimateRow.from_scalars(frame, stamp_ns, scalars)
        if "road" in scalars:
            self._on_road[frame] = scalars
        self.count += 1

    def has(self, frame: int) -> bool:
        """Return whether image number `frame` of this pass was answered."""
        return frame in self._rows

    def road_columns(self) -> dict[str, list[float | None]]:
        """Return places and speeds on the road, a value for each of `rows`; none without a road."""
        if not self._on_road:
            return {}
        answers = [self._on_road.get(frame, {}) for frame in self._stamps]
        return {
            name: [float(one[name]) if name in one else None for one in answers]
            for name in ROAD_COLUMNS
        }

    def rows(self) -> tuple[EstimateRow, ...]:
        """One row for each image of this pass, in order."""
        return tuple(
            self._rows.get(frame) or EstimateRow.without(frame, stamp_ns, DROPPED)
            for frame, stamp_ns in self._stamps.items()
        )

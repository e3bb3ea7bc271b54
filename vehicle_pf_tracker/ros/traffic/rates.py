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

"""Rates of a node of many vehicles, and which of them leaves its usual range."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Collection, Mapping
from typing import NamedTuple

_WINDOW = 60.0
"""Seconds that rates are of, as they are per minute."""
_RATE = 1 / 600
"""Share by which the usual mean and variance follow each judgement: ten minutes, in which traffic
changes by itself."""
_SETTLED = 120
"""Judgements, one a second, until mean and variance are usual: two windows."""
_USUAL = 5.0
"""Standard deviations, and 1 of any unit, that a usual value is within: no false alarm in a day of
values that are independent for a minute."""


class _Image(NamedTuple):
    when: float
    births: int
    ends: int
    detections: int
    believed: int
    latency_ms: float
    cluttered: int


class Rates:
    """Counts what comes and goes.

    Parameters
    ----------
    clock : callable
        Steady time in s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._images: deque[_Image] = deque()
        self._known: frozenset[int] = frozenset()
        self._judged = 0
        self._usual: dict[str, tuple[float, float]] = {}

    def note(
        self,
        vehicles: Collection[int],
        detections: int,
        believed: int,
        latency: float,
        cluttered: int = 0,
    ) -> None:
        """Note an image.

        Parameters
        ----------
        vehicles : collection of int
            Identities that have had enough evidence.
        detections, believed : int
            What the detector found, and vehicles that are visible.
        latency : float
            Time that the detector took, s.
        cluttered : int
            Places in the image that have had false alarms.
        """
        before, self._known = self._known, frozenset(vehicles)
        births, ends = len(self._known - before), len(before - self._known)
        now = self._clock()
        self._images.append(
            _Image(now, births, ends, detections, believed, latency * 1e3, cluttered)
        )
        while self._images[0].when < now - _WINDOW:
            self._images.popleft()

    @property
    def values(self) -> Mapping[str, float]:
        """The rates by name; empty before the first image."""
        images = self._images
        if not images:
            return {}
        minutes = max(self._clock() - images[0].when, 1.0) / 60.0
        return {
            "births per minute": sum(one.births for one in images) / minutes,
            "ends per minute": sum(one.ends for one in images) / minutes,
            "detections per image": sum(one.detections for one in images) / len(images),
            "of them believed": sum(one.believed for one in images) / len(images),
            "detector's latency (ms)": sum(one.latency_ms for one in images) / len(images),
            "places with false alarms": float(images[-1].cluttered),
        }

    def judge(self) -> str:
        """Compare each rate with its usual one, once a second; name those that are not usual."""
        self._judged += 1
        unusual = [name for name, value in self.values.items() if self._is_unusual(name, value)]
        return f"not as usual: {', '.join(unusual)}" if unusual else ""

    def _is_unusual(self, name: str, value: float) -> bool:
        mean, variance = self._usual.get(name, (value, 0.0))
        distance, rate = value - mean, max(_RATE, 1.0 / self._judged)
        self._usual[name] = mean + rate * distance, variance + rate * (distance**2 - variance)
        return self._judged > _SETTLED and abs(distance) > _USUAL * math.sqrt(variance) + 1.0

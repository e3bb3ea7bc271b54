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

"""Follow ten thousand vehicles that come and go, without ROS.

    python test/robustness/traffic_soak.py

Boxes of a perfect detector on a small grey road: vehicles drive through in lanes, one after the
other, and now and then the detector misses some or sees what is not there. Prints how many came,
the numbers they were given, and how the resident memory went. Exit status 1 if a number was issued
twice, a vehicle never had one, or memory grew.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from lanes import Numbers, Road, Sighting, Traffic

from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

MB = 1e6
ROAD = Road()
PERIOD_NS = 40_000_000
SETTLED = 0.1
"""Share of the run until memory has to stay as it is."""
GROWTH = 2.0
"""MB that the resident memory may grow by from then on: 200 bytes for each vehicle."""


def resident() -> int:
    """Resident memory of this process in bytes."""
    fields = Path("/proc/self/statm").read_text().split()
    return int(fields[1]) * 4096


def sightings(estimates: Iterable[TrackEstimate]) -> list[Sighting]:
    """Reduce estimates to what numbers are judged by."""
    return [Sighting(one.identity, *one.box.centre, one.mode in CONFIRMED) for one in estimates]


class Soak:
    """Runs the tracker."""

    def __init__(self, total: int, seed: int) -> None:
        self.traffic = Traffic(ROAD, total, seed)
        self.numbers = Numbers(ROAD, total)
        self.images = 0
        self.sizes: list[tuple[int, int]] = []
        self._session = TrafficSession(TrafficTracker())

    def run(self) -> None:
        """Show images until all vehicles have gone."""
        empty = ROAD.empty()
        while not self.traffic.is_over:
            corners = self.traffic.step(self.images)
            found = Detections.make(self.traffic.detect(corners))
            frame, stamp = ROAD.painted(empty, corners), self.images * PERIOD_NS
            self.numbers.judge(sightings(self._session.feed(frame, stamp, found)), corners)
            if self.images % 500 == 0:
                self.sizes.append((self.images, resident()))
            self.images += 1
        self.numbers.judge((), {})


def main() -> None:
    """Run as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--vehicles", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    soak, began = Soak(args.vehicles, args.seed), time.monotonic()
    soak.run()
    seconds = time.monotonic() - began
    images, sizes = np.array(soak.sizes).T
    settled = sizes[images >= SETTLED * images[-1]] / MB
    growth = settled[-1] - settled[0]
    print(f"{soak.traffic.begun} vehicles in {soak.images} images, {seconds:.0f} s")
    soak.numbers.report()
    print(
        f"resident memory {settled[0]:.1f} MB after a tenth of the run, {settled[-1]:.1f} MB at "
        f"the end ({growth:+.1f} MB), {settled.max():.1f} MB at most"
    )
    is_bad = growth > GROWTH or soak.numbers.reissued or (soak.numbers.of == 0).any()
    raise SystemExit(1 if is_bad else 0)


if __name__ == "__main__":
    main()

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
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

MB = 1e6
WIDTH, HEIGHT = 160, 120
LANES = 5
SIZE = (16.0, 12.0)
SPEED = 4.0
"""Way of a vehicle per image in px, which differs between lanes."""
GAP = 10
"""Images between two vehicles of a lane: 40 px, two and a half lengths."""
PERIOD_NS = 40_000_000
MISSED, FALSE = 0.03, 0.02
"""Shares of boxes that the detector misses, and of images with a false one."""
SETTLED = 0.1
"""Share of the run until memory has to stay as it is."""
GROWTH = 2.0
"""MB that the resident memory may grow by from then on: 200 bytes for each vehicle."""
FOREIGN = 0.2
"""Share of its images from which on a number that is on another vehicle has been handed on."""


class Traffic:
    """Vehicles in lanes, at most `total`.

    Attributes
    ----------
    begun : int
        Vehicles that have come.
    """

    def __init__(self, total: int, seed: int) -> None:
        self.begun = 0
        self._total = total
        self._rng = np.random.default_rng(seed)
        self._there: dict[int, tuple[int, float]] = {}

    def step(self, image: int) -> dict[int, tuple[float, float]]:
        """Drive on by an image; returns the left upper corner of each vehicle in it, px."""
        for number, (lane, x) in list(self._there.items()):
            moved = x + SPEED + 0.4 * lane
            if moved < WIDTH:
                self._there[number] = lane, moved
            else:
                del self._there[number]
        for lane in range(LANES):
            if image % GAP == 2 * lane and self.begun < self._total:
                self._there[self.begun] = lane, -SIZE[0] + float(self._rng.uniform(0, 2))
                self.begun += 1
        return {number: (x, 8.0 + 22.0 * lane) for number, (lane, x) in self._there.items()}

    @property
    def is_over(self) -> bool:
        """True once all have come and gone."""
        return self.begun == self._total and not self._there

    def detect(self, corners: dict[int, tuple[float, float]]) -> Detections:
        """Detect them: noisy, some missed, and now and then what is not there."""
        rows = []
        for x, y in corners.values():
            if self._rng.random() >= MISSED:
                left, top = max(x, 0.0), y
                right = min(x + SIZE[0], WIDTH)
                noise = self._rng.normal(0, 0.3, 4)
                rows.append(np.array([left, top, right - left, SIZE[1]]) + noise)
        if self._rng.random() < FALSE:
            rows.append(np.array([*self._rng.uniform(0, 100, 2), 12.0, 9.0]))
        return Detections.make(np.array(rows).reshape(-1, 4))


def painted(road: np.ndarray, corners: dict[int, tuple[float, float]]) -> np.ndarray:
    """Paint each vehicle in a colour of its own."""
    frame = road.copy()
    for number, (x, y) in corners.items():
        columns = slice(max(int(x), 0), max(int(x + SIZE[0]), 0))
        colour = [(37 * number) % 200 + 30, (91 * number) % 200 + 30, (53 * number) % 200 + 30]
        frame[int(y) : int(y + SIZE[1]), columns] = colour
    return frame


def resident() -> int:
    """Resident memory of this process in bytes."""
    fields = Path("/proc/self/statm").read_text().split()
    return int(fields[1]) * 4096


def nearest(box: Box, corners: dict[int, tuple[float, float]]) -> int | None:
    """Return the vehicle whose box has its centre within a size of `box`'s."""
    x, y = box.centre
    for number, (left, top) in corners.items():
        if abs(left + SIZE[0] / 2 - x) < SIZE[0] / 2 and abs(top + SIZE[1] / 2 - y) < SIZE[1] / 2:
            return number
    return None


class Soak:
    """Runs the tracker, and keeps who had which number, in memory that does not grow.

    Attributes
    ----------
    issued : int
        The highest number that was issued.
    reissued : int
        Numbers that came back after they were gone, or came below one that was issued before.
    numbers : array
        Numbers that each vehicle had.
    handed_on : int
        Numbers that went over to another vehicle.
    """

    def __init__(self, total: int, seed: int) -> None:
        self.traffic = Traffic(total, seed)
        self.session = TrafficSession(TrafficTracker())
        self.images = self.issued = self.reissued = self.handed_on = 0
        self.numbers = np.zeros(total, np.int32)
        self.sizes: list[tuple[int, int]] = []
        self._votes: dict[int, Counter[int]] = {}

    def run(self) -> None:
        """Show images until all vehicles have gone."""
        road = np.random.default_rng(1).integers(96, 112, (HEIGHT, WIDTH, 3), np.uint8)
        while not self.traffic.is_over:
            corners = self.traffic.step(self.images)
            found = self.traffic.detect(corners)
            frame, stamp = painted(road, corners), self.images * PERIOD_NS
            self._judge(self.session.feed(frame, stamp, found), corners)
            if self.images % 500 == 0:
                self.sizes.append((self.images, resident()))
            self.images += 1
        self._judge((), {})

    def _judge(
        self, estimates: Sequence[TrackEstimate], corners: dict[int, tuple[float, float]]
    ) -> None:
        identities = [one.identity for one in estimates]
        self.reissued += len(identities) - len(set(identities))
        for gone in self._votes.keys() - set(identities):
            self._close(self._votes.pop(gone))
        highest = self.issued
        for one in estimates:
            if one.identity not in self._votes:
                self.reissued += one.identity <= highest
                self.issued = max(self.issued, one.identity)
                self._votes[one.identity] = Counter()
            vehicle = nearest(one.box, corners)
            if one.mode in CONFIRMED and vehicle is not None:
                self._votes[one.identity][vehicle] += 1

    def _close(self, votes: Counter[int]) -> None:
        """Note whose number it was."""
        if votes:
            ((vehicle, own),) = votes.most_common(1)
            self.numbers[vehicle] += 1
            self.handed_on += votes.total() - own > FOREIGN * votes.total()


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
    missing, split = (soak.numbers == 0).sum(), (soak.numbers > 1).sum()
    print(f"{soak.traffic.begun} vehicles in {soak.images} images, {seconds:.0f} s")
    print(f"numbers issued: {soak.issued}; twice: {soak.reissued}")
    print(f"vehicles without a number: {missing}; with more than one: {split}")
    print(f"numbers that went over to another vehicle: {soak.handed_on}")
    print(
        f"resident memory {settled[0]:.1f} MB after a tenth of the run, {settled[-1]:.1f} MB at "
        f"the end ({growth:+.1f} MB), {settled.max():.1f} MB at most"
    )
    raise SystemExit(1 if growth > GROWTH or soak.reissued or missing else 0)


if __name__ == "__main__":
    main()

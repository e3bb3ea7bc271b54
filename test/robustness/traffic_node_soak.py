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

"""Run the node of many vehicles for an hour while ten thousand vehicles come and go.

    python test/robustness/traffic_node_soak.py --vehicles 10000 --minutes 60

Vehicles drive through in lanes, under a bridge that hides each of them for a few images. A
detector publishes their boxes (vision_msgs, built from its definitions where it is not installed),
misses some, and sees what is not there; with `--detector motion` the node finds them itself. Once
in a while the detector fails: a flood of boxes, boxes that cannot be used, stamps of no image,
silence. Prints what was answered, which numbers were given and counted, what the node
said, and how the resident memory went. Exit status 1 if an image stayed unanswered, was rejected or
answered twice, a number was issued twice, a vehicle never had one, or memory grew; a traceback or
an end that is not clean ends it with the node's log.
"""

from __future__ import annotations

import argparse
import itertools
import re
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
from detector import Detector, sightings, vision
from diagnostic_msgs.msg import DiagnosticArray
from lanes import Corners, Numbers, Road, Traffic
from node_process import NodeProcess, growth
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from vehicle_pf_tracker.ros.messages import image_message, stamp_ns

WIDTH, HEIGHT = 320, 180
BRIDGE = slice(150, 180)
"""Columns under the bridge: a vehicle of 32 px is hidden for a few images."""
LEAST = 3.0
"""Least width in px that the detector sees of a vehicle that enters."""
LINE = 260
"""Column of the line at which vehicles are counted, px."""
GROWTH = 2.0
"""MB that the resident memory may grow by from then on: 200 bytes for each vehicle."""
FAULT_EVERY = 20.0
LASTS = 2.0
"""Seconds between two failures of the detector, and how long one lasts."""


class Soak:
    """Images at a rate, answers as they come.

    Parameters
    ----------
    node : NodeProcess
        The node.
    detector : Detector or None
        Publishes detections; None where the node finds vehicles itself.
    road : Road
        Vehicles and their ways.
    total : int
        Number of vehicles.
    rate : float
        Images per second.
    seed : int
        Seed of the traffic and the detector's mistakes.
    has_faults : bool
        Whether the detector fails once in a while.
    """

    def __init__(
        self,
        node: NodeProcess,
        detector: Detector | None,
        road: Road,
        total: int,
        rate: float,
        seed: int,
        *,
        has_faults: bool = True,
    ) -> None:
        self._node, self._detector, self._road, self._rate = node, detector, road, rate
        self._has_faults = has_faults
        self.traffic = Traffic(road, total, seed)
        self.numbers = Numbers(road, total)
        self.answers: Counter[str] = Counter()
        self.waiting: dict[int, float] = {}
        self.latencies: list[float] = []
        self.sizes: list[tuple[float, int]] = []
        self.counted = ""
        self.lost = 0
        self._corners: dict[int, Corners] = {}
        self._tracks = node.collect(PointCloud2, "tracks")
        self._counts = node.collect(DiagnosticArray, "counts")
        self._others = [
            node.collect(DiagnosticArray, "modes"),
            node.collect(MarkerArray, "markers"),
        ]
        self._faults = itertools.cycle((detector.faults if detector else {}).items())

    def begin(self) -> None:
        """Wait until the node answers an image of the empty road."""
        self._first = self._image(0, self._empty(), self._empty())
        self._node.begin(self._first)
        self._hear()

    def run(self) -> None:
        """Show images until all vehicles have gone, and wait for the last answers."""
        began, number, empty = time.monotonic(), 0, self._empty()
        while not self.traffic.is_over:
            number += 1
            corners = self.traffic.step(number)
            image = self._image(number, self._road.painted(empty, corners), empty)
            key = stamp_ns(image.header)
            self.waiting[key], self._corners[key] = time.monotonic(), corners
            self._node.publish(image)
            if self._detector is not None:
                self._detect(self._detector, number, image.header, corners)
            if number % round(10 * self._rate) == 0:
                self.sizes.append((time.monotonic() - began, self._node.resident))
            while (left := began + number / self._rate - time.monotonic()) > 0:
                self._node.spin(min(left, 0.01))
                self._hear()
        for _ in range(100):
            self._node.spin(0.02)
            self._hear()
        self.numbers.judge((), {})
        self.lost = self._node.lost

    def _empty(self) -> np.ndarray:
        empty = self._road.empty()
        empty[:, BRIDGE] = 60
        return empty

    def _image(self, number: int, frame: np.ndarray, empty: np.ndarray) -> Image:
        frame[:, BRIDGE] = empty[:, BRIDGE]
        header = Header(frame_id="camera")
        nanoseconds = round(number * 1e9 / self._rate)
        header.stamp.sec, header.stamp.nanosec = 1000 + nanoseconds // 10**9, nanoseconds % 10**9
        return image_message(header, frame)

    def _detect(self, detector: Detector, number: int, header: Header, corners: Corners) -> None:
        boxes = self.traffic.detect(corners)
        middle = boxes[:, 0] + boxes[:, 2] / 2
        is_hidden = (middle >= BRIDGE.start) & (middle < BRIDGE.stop)
        boxes = boxes[~is_hidden & (boxes[:, 2] >= LEAST)]
        since = number % round(FAULT_EVERY * self._rate)
        if not self._has_faults or number < FAULT_EVERY * self._rate or since > LASTS * self._rate:
            detector.right(header, boxes)
            return
        if since == 0:
            words, self._fault = next(self._faults)
            self.answers[f"fault: {words}"] += 1
        self._fault(header, boxes)

    def _hear(self) -> None:
        now = time.monotonic()
        while self._tracks:
            cloud = self._tracks.pop(0)
            self.numbers.judge(sightings(cloud), self._corners.pop(stamp_ns(cloud.header), {}))
        while self._counts:
            self.counted = self._counts.pop(0).status[0].message
        for messages in self._others:
            messages.clear()
        while self._node.modes:
            answer = self._node.modes.pop(0)
            if answer.header == self._first.header:
                continue  # it was sent until the node answered
            sent = self.waiting.pop(stamp_ns(answer.header), None)
            if sent is None:
                self.answers["second answers"] += 1
            else:
                self.latencies.append(now - sent)
            self.answers[f"mode: {answer.status[0].message}"] += 1


def report(soak: Soak, seconds: float, output: str) -> bool:
    """Print what came of it; returns False if something is wrong."""
    images = len(soak.latencies) + len(soak.waiting)
    print(f"{soak.traffic.begun} vehicles in {images} images, {seconds:.0f} s")
    print(f"images lost on the way: {soak.lost}")
    print(f"images without an answer: {len(soak.waiting)}")
    for key in sorted(soak.waiting):
        print(f"  with the stamp {key / 1e9:.3f} s")
    for answer, count in sorted(soak.answers.items()):
        print(f"  {answer:18} {count}")
    soak.numbers.report()
    print(f"counted at the line: {soak.counted}")
    middle, high, most = np.percentile(np.array(soak.latencies) * 1e3, [50, 95, 99])
    print(f"answers after {middle:.1f} ms (p50), {high:.1f} ms (p95), {most:.1f} ms (p99)")
    said = Counter(re.sub(r"\[.*\]: |\d+", "", line) for line in output.splitlines())
    for sentence, count in said.most_common():
        print(f"  the node said {count} times: {sentence}")
    grown = growth(soak.sizes)
    second = soak.answers["second answers"] + soak.answers["mode: REJECTED"]
    missing = (soak.numbers.of == 0).any()
    unanswered = len(soak.waiting) > soak.lost
    return not (unanswered or second or soak.numbers.reissued or missing or grown > GROWTH)


def main() -> None:
    """Run as asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--vehicles", type=int, default=10_000)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--rate", type=float, default=12.0, help="images per second")
    parser.add_argument("--detector", choices=("topic", "motion"), default="topic")
    parser.add_argument("--no-faults", action="store_true", help="a detector that never fails")
    parser.add_argument("--best-effort", action="store_true", help="images as a camera's")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="traffic_soak_") as folder:
        is_good = run(args, Path(folder))
    raise SystemExit(0 if is_good else 1)


def run(args: argparse.Namespace, folder: Path) -> bool:
    """Run and report; returns False if something is wrong."""
    messages = vision(folder) if args.detector == "topic" else None
    every = args.minutes * 60 * args.rate / args.vehicles
    road = Road(WIDTH, HEIGHT, lanes=6, size=(32.0, 20.0), speed=5.0, every=every)
    lines = folder / "lines.yaml"
    lines.write_text(f"lines: {{exit: {{from: [{LINE}, {HEIGHT}], to: [{LINE}, 0]}}}}\n")
    words = [f"detector.kind:={args.detector}", f"lines:={lines}", "queue_depth:=20"]
    node = NodeProcess("traffic", *words, target=None, is_reliable=not args.best_effort)
    detector = None if messages is None else Detector(node, messages, round(args.rate))
    soak = Soak(
        node, detector, road, args.vehicles, args.rate, args.seed, has_faults=not args.no_faults
    )
    soak.begin()
    began = time.monotonic()
    soak.run()
    is_good = report(soak, time.monotonic() - began, node.output)
    node.end()
    return is_good


if __name__ == "__main__":
    main()

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

"""Give the node of many vehicles one fault after the other, as a user's detector or camera would.

    python test/robustness/traffic_faults.py

The node is a process of its own. While slow vehicles drive through, its detector fails in one way
for some seconds, then works again; for the last fault the node detects motion, and its camera
moves. A flood of boxes comes once a second: its thousand vehicles more take a second on a busy
machine, and more of its 4 MB would keep images from arriving. Prints for each fault how many images
were answered, how many of the vehicles in view at its begin and after it have the same number, and
what the node said meanwhile. Exit status 1 if an image stayed unanswered or was rejected, a
sentence came more often than every 5 s, or the node did not end well.
"""

from __future__ import annotations

import argparse
import re
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
from detector import Detector, Fault, sightings, vision
from lanes import Corners, Road, Traffic
from node_process import NodeProcess
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from vehicle_pf_tracker.ros.messages import image_message, stamp_ns

RATE = 12.0
ROAD = Road(320, 180, lanes=6, size=(32.0, 20.0), speed=0.8, every=22.0, missed=0.0, false=0.0)
"""A vehicle takes half a minute to cross: most are in view before, during and after a fault."""
SETTLED = 180
"""Images before the first fault: vehicles are there, and the background is learnt."""
AFTER = 24
"""Images after a fault until vehicles are compared: two seconds for an answer to it."""
INTERVAL = 5.0
"""Seconds between two sentences of one kind that the node promises."""
IMAGES = ("queue_depth:=20", "qos_overrides./image.subscription.reliability:=reliable")
"""Parameters by which no image is lost on its way, so that each has to be answered."""
MOVES = "motion, the camera moves for a second"
MOVING = 1.0
"""Seconds that it moves, and stands where it is then."""


class Trial:
    """One node, a camera, and what was answered.

    Parameters
    ----------
    node : NodeProcess
        The node.
    seconds : float
        Length of a fault.
    """

    def __init__(self, node: NodeProcess, seconds: float) -> None:
        self._node = node
        self._count = round(seconds * RATE)
        self._traffic = Traffic(ROAD, 10**6, 0)
        self._tracks = node.collect(PointCloud2, "tracks")
        texture = np.random.default_rng(5).integers(80, 130, (6, 10, 3), np.uint8)
        self._empty = np.kron(texture, np.ones((30, 32, 1), np.uint8)) + ROAD.empty() // 8
        self._number = self._offset = 0
        self._corners: dict[int, Corners] = {}
        self.is_good = True

    def begin(self, detect: Fault) -> None:
        """Show images until vehicles are followed."""
        self._node.begin(image_message(Header(frame_id="camera"), self._empty))
        self._play(SETTLED, detect, 0)

    def give(self, words: str, fault: Fault, right: Fault, shift: int = 0) -> None:
        """Give a fault for a while, then none, and print what came of it."""
        before, said, began = self._numbers(), len(self._node.output), time.monotonic()
        self._play(self._count, fault, shift)
        self._play(AFTER, right, 0)
        after = self._numbers()
        both = before.keys() & after.keys()
        kept = sum(before[vehicle] == after[vehicle] for vehicle in both)
        sentences = Counter(
            re.sub(r"^.*?\]: |\d+", lambda found: "" if "]" in found[0] else "N", line)
            for line in self._node.output[said:].splitlines()
        )
        allowed = 2 + (time.monotonic() - began) / INTERVAL
        answered = sum(self._modes.values())
        self.is_good &= max(sentences.values(), default=0) <= allowed
        self.is_good &= answered == self._count + AFTER and "REJECTED" not in self._modes
        quoted = "; ".join(f"{count} times: {line}" for line, count in sentences.items())
        print(
            f"| {words} | {answered} of {self._count + AFTER} | {kept} of {len(both)} | {quoted} |"
        )

    def _play(self, count: int, detect: Fault, shift: int) -> None:
        """Show images; with a shift the camera moves by so many px each time, for a second."""
        if count != AFTER:
            self._modes: Counter[str] = Counter()
            still = self._offset
        for step in range(1, count + 1):
            began = time.monotonic()
            self._number += 1
            corners = self._traffic.step(self._number)
            frame = self._painted(corners)
            if shift:
                self._offset = still + shift * min(step, round(RATE * MOVING))
            header = Header(frame_id="camera")
            nanoseconds = round(self._number * 1e9 / RATE)
            header.stamp.sec, header.stamp.nanosec = divmod(nanoseconds, 10**9)
            self._corners[stamp_ns(header)] = corners
            self._node.modes.clear()
            self._node.publish(image_message(header, np.roll(frame, self._offset, axis=1)))
            boxes = self._traffic.detect(corners)
            detect(header, boxes[boxes[:, 2] >= 3])
            self._listen(header, began)

    def _painted(self, corners: Corners) -> np.ndarray:
        """Paint the vehicles, each with windows and shadows of its own, as pixels hold it by."""
        frame = ROAD.painted(self._empty, corners)
        for number, (x, y) in corners.items():
            left, top = int(x), int(y)
            texture = np.random.default_rng(number).integers(0, 60, (5, 8, 1), np.uint8)
            texture = np.kron(texture, np.ones((4, 4, 1), np.uint8))
            part = frame[top : top + 20, max(left, 0) : max(left + 32, 0)]
            part += texture[: part.shape[0], max(-left, 0) :][:, : part.shape[1]] // 2
        return frame

    def _listen(self, header: Header, began: float) -> None:
        """Wait for the answer, and at least until the next image is due."""
        wanted = [stamp_ns(header)]
        while wanted or time.monotonic() - began < 1 / RATE:
            self._node.spin(0.01)
            for answer in self._node.modes:
                if stamp_ns(answer.header) in wanted:
                    wanted.clear()
                    self._modes[str(answer.status[0].message)] += 1
            self._node.modes.clear()
            if time.monotonic() - began > INTERVAL:
                return

    def _numbers(self) -> dict[int, int]:
        """Return the number of each vehicle that is in view."""
        self._node.spin(0.2)
        found = {}
        if not self._tracks:
            return found
        key = stamp_ns(self._tracks[-1].header)
        corners = {
            number: (x + self._offset, y)
            for number, (x, y) in _inside(self._corners[key]).items()
            if x + self._offset <= ROAD.width - ROAD.size[0]
        }
        for one in sightings(self._tracks[-1]):
            vehicle = ROAD.nearest(one.x, one.y, corners)
            if one.is_confirmed and vehicle is not None:
                found[vehicle] = min(one.identity, found.get(vehicle, one.identity))
        del self._tracks[:-1]
        return found


def _inside(corners: Corners) -> Corners:
    """Leave out the vehicles that the image's border cuts."""
    return {
        number: (x, y) for number, (x, y) in corners.items() if 0 <= x <= ROAD.width - ROAD.size[0]
    }


def nothing(header: Header, boxes: np.ndarray) -> None:
    """Publish no detections: the node finds them itself."""


def main() -> None:
    """Try all faults."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=6.0, help="length of each fault")
    parser.add_argument("--only", default="", help="faults with this in their name")
    args = parser.parse_args()
    print("| fault | images answered | vehicles with their number | the node said |")
    print("|---|---:|---:|---|")
    with tempfile.TemporaryDirectory(prefix="traffic_faults_") as folder:
        messages = vision(Path(folder))
        node = NodeProcess("traffic", "detector.kind:=topic", *IMAGES, target=None)
        detector, trial = Detector(node, messages, round(RATE)), Trial(node, args.seconds)
        trial.begin(detector.right)
        for words, fault in detector.faults.items():
            if args.only in words:
                trial.give(words, fault, detector.right)
        node.end()
    is_good = trial.is_good
    node = NodeProcess("traffic", "detector.kind:=motion", *IMAGES, target=None)
    trial = Trial(node, args.seconds)
    trial.begin(nothing)
    if args.only in MOVES:
        trial.give(MOVES, nothing, nothing, shift=4)
    node.end()
    raise SystemExit(0 if is_good and trial.is_good else 1)


if __name__ == "__main__":
    main()

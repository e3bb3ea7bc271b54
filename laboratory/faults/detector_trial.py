# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Faults of a detector and of a camera for the node of many vehicles, one after the other.

While slow vehicles drive through, the detector fails in one way for some seconds, then works again;
for the last fault the node detects motion, and its camera moves. A flood of boxes comes once a
second: more of its 4 MB would keep images from arriving.
"""

from __future__ import annotations

import re
import time
from collections import Counter
from typing import Any

import numpy as np
from sensor_msgs.msg import PointCloud2

from laboratory.faults.detector import Detector, Fault
from laboratory.faults.drive import header_at
from laboratory.faults.lanes import Corners, Road, Traffic
from laboratory.faults.ledger import VARYING_PARTS, Ledger
from laboratory.faults.node_process import NodeProcess, Tester
from laboratory.faults.numbers import sightings
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.ros.messages import image_message, stamp_ns
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT

RATE = 12.0
"""Images a second: a node and this client keep up with it on one core."""
ROAD = Road(320, 180, lanes=6, size=(32.0, 20.0), speed=0.8, every=22.0, missed=0.0, false=0.0)
"""A vehicle takes half a minute to cross: most are in view before, during and after a fault."""
SETTLED = 180
"""Images before the first fault: vehicles are there, and the background is learnt."""
AFTER = 24
"""Images after a fault until vehicles are compared: two seconds for an answer to it."""
INTERVAL = 5.0
"""Seconds between two sentences of one kind that the node promises."""
MOVES = "motion, the camera moves for a second"
MOVING, SHIFT = 1.0, 4
"""Seconds that it moves, and px per image; it stands where it is then."""


def give_detector_faults(tester: Tester, messages: Any, seconds: float, only: str = "") -> bool:
    """Give the faults whose names contain `only`; return whether all held.

    An image must not stay unanswered or be rejected, and a sentence must not come more often than
    every 5 s.

    Parameters
    ----------
    tester : Tester
        Sends and hears.
    messages : module or None
        `vision_msgs.msg`; None leaves out a detector's faults.
    seconds : float
        Length of each fault.
    only : str
        Part of the names of the faults to give.
    """
    print("| fault | images answered | vehicles with their number | the node said |")
    print("|---|---:|---:|---|")
    is_good = True
    if messages is not None:
        detector = Detector(tester, messages, round(RATE))
        trial = Trial(tester, "topic", seconds, detector.right)
        for words, fault in detector.faults.items():
            if only in words:
                trial.give(words, fault)
        is_good = trial.end()
    if only in MOVES:
        trial = Trial(tester, "motion", seconds, lambda header, boxes: None)
        trial.give(MOVES, shift=SHIFT)
        is_good &= trial.end()
    return is_good


class Trial:
    """One node, a camera, and what was answered.

    Parameters
    ----------
    tester : Tester
        Sends and hears.
    kind : str
        Source of the node's detections, ``topic`` or ``motion``.
    seconds : float
        Length of a fault.
    right : Fault
        Detections of a detector that works.
    """

    def __init__(self, tester: Tester, kind: str, seconds: float, right: Fault) -> None:
        self._tester = tester
        self._right = right
        self._count = round(seconds * RATE)
        # 20 images may wait: a flood keeps the node busy for longer than an image lasts.
        self._node = NodeProcess(
            tester, TRAFFIC_VARIANT.name, f"detector.kind:={kind}", "queue_depth:=20"
        )
        self._ledger = Ledger(self._node, may_wait=True)
        self._traffic = Traffic(ROAD, 10**6, 0)
        self._tracks = tester.collect(PointCloud2, f"{self._node.name}/tracks")
        # Coarse blocks for a camera's motion to be measured by, and fine noise over them.
        texture = np.random.default_rng(5).integers(80, 130, (6, 10, 3), np.uint8)
        self._empty = np.kron(texture, np.ones((30, 32, 1), np.uint8)) + ROAD.empty() // 8
        self._number = self._offset = 0
        self._corners: dict[int, Corners] = {}
        self._is_good = True
        self._ledger.begin(tester, image_message(header_at(0), self._empty))
        self._play(SETTLED, right, 0)

    def give(self, words: str, fault: Fault | None = None, shift: int = 0) -> None:
        """Give a fault for a while, then none, and print what came of it."""
        # 1. The numbers before, then the fault, then a detector that works again.
        before = self._vehicles()
        said = len(self._node.output)
        began = time.monotonic()
        self._play(self._count, fault or self._right, shift)
        self._play(AFTER, self._right, 0)
        # 2. The same vehicles with the same numbers after it.
        after = self._vehicles()
        both = before.keys() & after.keys()
        kept = sum(before[vehicle] == after[vehicle] for vehicle in both)
        # 3. What the node said, without numbers and log heads, so that equal ones are counted.
        sentences = Counter(
            VARYING_PARTS.sub(_shortened, line) for line in self._node.output[said:].splitlines()
        )
        # A sentence at the beginning and one at the end are right in any case.
        allowed = 2 + (time.monotonic() - began) / INTERVAL
        self._is_good &= max(sentences.values(), default=0) <= allowed
        count = self._count + AFTER
        quoted = "; ".join(f"{count} times: {line}" for line, count in sentences.items())
        print(
            f"| {words} | {count - self._ledger.unanswered} of {count} | {kept} of {len(both)} "
            f"| {quoted} |",
            flush=True,
        )

    def end(self) -> bool:
        """End the node; return whether all held."""
        self._ledger.close()
        ledger = self._ledger
        return self._is_good and not (
            ledger.unanswered or ledger.second_answers or ledger.wrong_answers
        )

    def _play(self, count: int, detect: Fault, shift: int) -> None:
        """Show images; with a shift the camera moves by so many px each time, for a second."""
        # A shift ends after `MOVING`, where the camera then stands.
        still = self._offset
        for step in range(1, count + 1):
            began = time.monotonic()
            self._number += 1
            corners = self._traffic.step(self._number)
            frame = self._painted(corners)
            self._offset = still + shift * min(step, round(RATE * MOVING))
            header = header_at(round(self._number * 1e9 / RATE))
            self._corners[stamp_ns(header)] = corners
            # Rolled: what leaves on one side comes in on the other, so that no border appears.
            image = image_message(header, np.roll(frame, self._offset, axis=1))
            self._ledger.note(image, is_good=True)
            self._tester.show(image)
            boxes = self._traffic.detect(corners)
            # Slivers at the border are nothing that a detector finds.
            detect(header, boxes[boxes[:, 2] >= 3])
            # In step with the node's answers, but no faster than a camera.
            while self._ledger.unanswered or time.monotonic() - began < 1 / RATE:
                self._tester.spin(0.01)
                self._ledger.hear()
                if time.monotonic() - began > INTERVAL:
                    break

    def _painted(self, corners: Corners) -> Frame:
        """Paint the vehicles, each with windows and shadows of its own, as pixels hold it by."""
        frame = ROAD.with_vehicles(self._empty, corners)
        for number, (x, y) in corners.items():
            left = int(x)
            top = int(y)
            texture = np.random.default_rng(number).integers(0, 60, (5, 8, 1), np.uint8)
            texture = np.kron(texture, np.ones((4, 4, 1), np.uint8))
            part = frame[top : top + 20, max(left, 0) : max(left + 32, 0)]
            part += texture[: part.shape[0], max(-left, 0) :][:, : part.shape[1]] // 2
        return frame

    def _vehicles(self) -> dict[int, int]:
        """Return the number of each vehicle that is in view."""
        self._tester.spin(0.2)
        numbers: dict[int, int] = {}
        if not self._tracks:
            return numbers
        last = ROAD.width - ROAD.size[0]
        corners = {
            vehicle: (x + self._offset, y)
            for vehicle, (x, y) in self._corners[stamp_ns(self._tracks[-1].header)].items()
            # Wholly in view: of others the centre is not that of the true box.
            if x >= 0 and x + self._offset <= last
        }
        for sighting in sightings(self._tracks[-1]):
            vehicle = ROAD.nearest(sighting.x, sighting.y, corners)
            if sighting.is_confirmed and vehicle is not None:
                # Of several tracks on one vehicle the oldest counts.
                numbers[vehicle] = min(sighting.identity, numbers.get(vehicle, sighting.identity))
        del self._tracks[:-1]
        return numbers


def _shortened(varying: re.Match[str]) -> str:
    # A log's head ends in "]: "; everything else that matched is a number.
    return "" if "]" in varying[0] else "N"

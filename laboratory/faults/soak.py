# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Nodes at a camera's rate for hours, with faults mixed in, which have to stay as they were."""

from __future__ import annotations

import itertools
import random
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from geometry_msgs.msg import Point32, PolygonStamped
from sensor_msgs.msg import Image, PointCloud2

from laboratory.faults.detector import Detector, Fault, sightings, vision
from laboratory.faults.faulty_messages import FIRST_NS, Faults, header_at
from laboratory.faults.lanes import Corners, Numbers, Road, Traffic
from laboratory.faults.ledger import VARYING_PARTS, Ledger
from laboratory.faults.node_process import NodeProcess, Tester
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import image_message, stamp_ns
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT, find_node

if TYPE_CHECKING:
    from laboratory.faults.request import Request

WIDTH, HEIGHT = 320, 180
"""Size of the images, px: both nodes keep up with it beside the load."""
BRIDGE = slice(150, 180)
"""Columns under the bridge: a vehicle of 32 px is hidden for a few images."""
LEAST = 3.0
"""Least width in px that the detector sees of a vehicle that enters."""
LINE = 260
"""Column of the line at which vehicles are counted, px."""
FAULT_EVERY, LASTS = 20.0, 2.0
"""Seconds between two failures of the detector, and how long one lasts."""
TARGET_EVERY = CHANGE_EVERY = 5.0
"""Seconds between two targets, and between two changes of a parameter."""
LATE = 0.005
"""Seconds to listen before an image that is late: time for the some eight answers to one image."""
_DEPTH, _LONG_DEPTH = 10, 100
"""Images that wait for a node: two thirds of a second of a camera, and more than any pause."""
# Changes in their order, of every effect, each undone later.
CHANGES: list[tuple[str, object]] = [
    ("num_particles", 300),
    ("histogram_bits", 4),  # of the reference's effect "relearns"
    ("lost_after", 1.0),
    ("seed", 5),
    ("publish.velocity", False),
    ("num_particles", 100),
    ("window.width", 14.0),
    ("histogram_bits", 3),
    ("publish.velocity", True),
    ("evidence.clear_above", 0.85),
    ("seed", 6),
    ("window.width", 0.0),
    ("lost_after", 5.0),
    ("evidence.clear_above", 0.8),
    ("num_particles", 200),
]


class Scene:
    """Vehicles that drive through in lanes, under a bridge.

    Parameters
    ----------
    total : int
        Number of vehicles.
    every : float
        Images from one vehicle to the next.
    rate : float
        Images per second.
    """

    def __init__(self, total: int, every: float, rate: float) -> None:
        self.road = Road(WIDTH, HEIGHT, lanes=6, size=(32.0, 20.0), speed=4.0, every=every)
        self.traffic = Traffic(self.road, total, 0)
        self.corners: Corners = {}
        self._period_ns = round(1e9 / rate)
        self._empty = self.road.empty()
        self._empty[:, BRIDGE] = 60
        self._frame = self._empty

    def step(self, number: int) -> Image:
        """Drive on to the image `number`."""
        self.corners = self.traffic.step(number)
        # The bridge after the vehicles: it covers them.
        self._frame = self.road.painted(self._empty, self.corners)
        self._frame[:, BRIDGE] = 60
        return self.image(number)

    def image(self, number: int) -> Image:
        """Make the image `number` of where the vehicles are now."""
        return image_message(header_at(FIRST_NS + number * self._period_ns), self._frame)

    def detect(self) -> Array:
        """Detect the vehicles that no bridge hides."""
        boxes = self.traffic.detect(self.corners)
        # By the middle of the box: a vehicle that is half under the bridge is still found.
        middle = boxes[:, 0] + boxes[:, 2] / 2
        is_hidden = (middle >= BRIDGE.start) & (middle < BRIDGE.stop)
        return boxes[~is_hidden & (boxes[:, 2] >= LEAST)]

    def target(self) -> PolygonStamped | None:
        """Return a vehicle that has just come; None where there is none."""
        # In the first part of the road, so that it is followed through the bridge.
        for x, y in self.corners.values():
            if 0 < x < BRIDGE.start / 2:
                made = PolygonStamped(header=header_at(0))
                width, height = self.road.size
                made.polygon.points = [Point32(x=x, y=y), Point32(x=x + width, y=y + height)]
                return made
        return None


class Soak:
    """Images for several nodes at a rate, and their answers.

    Parameters
    ----------
    tester : Tester
        Sends and hears.
    request : Request
        Nodes, rate, length and faults.
    folder : Path
        Folder for messages that are built, and the line at which vehicles are counted.
    """

    def __init__(self, tester: Tester, request: Request, folder: Path) -> None:
        # As many as come in the time; at least one, or it would be over at once.
        total = max(1, round(request.minutes * 60 * request.rate / request.every))
        self._tester = tester
        self._rate = request.rate
        self._share = request.share
        self._scene = scene = Scene(total, request.every, request.rate)
        self._faults = Faults(scene.image, request.seed)
        self._random = random.Random(request.seed)
        names = request.nodes.split(",")
        lines = folder / "lines.yaml"
        lines.write_text(f"lines: {{exit: {{from: [{LINE}, {HEIGHT}], to: [{LINE}, 0]}}}}\n")
        has_detector = TRAFFIC_VARIANT.name in names and not request.motion
        self._detector = (
            Detector(tester, vision(folder), round(self._rate)) if has_detector else None
        )
        kind = "topic" if has_detector else "motion"
        of_traffic = [f"detector.kind:={kind}", f"lines:={lines}"]
        self._ledgers = {}
        for name in names:
            words = list(of_traffic) if name == TRAFFIC_VARIANT.name else []
            # Reliable images wait in the queue while another process has the processor.
            words += [f"queue_depth:={_DEPTH if request.best_effort else _LONG_DEPTH}"]
            node = NodeProcess(tester, name, *words, is_reliable=not request.best_effort)
            self._ledgers[name] = Ledger(node, may_wait=True)
        # Of the changes those that the node has a parameter for.
        self._changes = {
            name: [one for one in CHANGES if one[0] in Configuration.of(find_node(name)).specs()]
            for name in names
            if name != TRAFFIC_VARIANT.name
        }
        self._ways = itertools.cycle(self._detector.faults.items() if self._detector else ())
        self._fault: Fault | None = None
        self._tracks = tester.collect(PointCloud2, f"/{TRAFFIC_VARIANT.executable}/tracks")
        self._numbers = Numbers(scene.road, total)
        self._corners: dict[int, Corners] = {}

    def run(self) -> None:
        """Show images until all vehicles have gone, and wait for the last answers."""
        first = self._scene.step(0)
        for ledger in self._ledgers.values():
            ledger.begin(self._tester, first)
        began = time.monotonic()
        number = 0
        while not self._scene.traffic.is_over:
            number += 1
            # 1. At times a faulty image before the good one.
            if self._random.random() < self._share:
                self._send(self._faults.image(number), is_good=False)
            # 2. The good image, its detections, and what else is due.
            image = self._scene.step(number)
            self._corners[stamp_ns(image.header)] = self._scene.corners
            self._send(image, is_good=True)
            self._faults.good()
            self._detect(number, image)
            self._turn(number)
            # 3. Until the next is due: by the clock of the whole run, so that delays do not add up.
            while (left := began + number / self._rate - time.monotonic()) > 0:
                self._hear(min(left, 0.01))
            # Answers are taken also where the next image is late already.
            self._hear(LATE)
        # Two seconds for the last answers.
        for _ in range(100):
            self._hear(0.02)
        # An answer without vehicles closes all numbers.
        self._numbers.judge((), {})
        for ledger in self._ledgers.values():
            ledger.close()

    def report(self) -> bool:
        """Print what came of it; return whether all held."""
        results = []
        for name, ledger in self._ledgers.items():
            results.append(ledger.report())
            if name == TRAFFIC_VARIANT.name:
                self._numbers.report()
                results.append(not self._numbers.reissued)
            said = Counter(VARYING_PARTS.sub("", line) for line in ledger.node.output.splitlines())
            for sentence, count in said.most_common(20):
                print(f"  said {count} times: {sentence[:160]}")
        return all(results)

    def _send(self, image: Image, *, is_good: bool) -> None:
        for ledger in self._ledgers.values():
            ledger.note(image, is_good=is_good)
        self._tester.show(image)

    def _detect(self, number: int, image: Image) -> None:
        """Publish the detections of an image, or what a detector that fails makes of them."""
        if self._detector is None:
            return
        boxes = self._scene.detect()
        since = number % round(FAULT_EVERY * self._rate)
        # At first it works: the node must have vehicles before it can lose them.
        if not self._share or number < FAULT_EVERY * self._rate or since > LASTS * self._rate:
            self._detector.right(image.header, boxes)
            return
        if since == 0 or self._fault is None:
            words, self._fault = next(self._ways)
            self._ledgers[TRAFFIC_VARIANT.name].counts[f"detector: {words}"] += 1
        self._fault(image.header, boxes)

    def _turn(self, number: int) -> None:
        """Weigh the nodes, and give a target or a parameter to single trackers, in their turn."""
        # Every ten seconds: six points a minute show growth well.
        if number % round(10 * self._rate) == 0:
            for ledger in self._ledgers.values():
                ledger.weigh()
        target = self._scene.target() if self._is_due(number, TARGET_EVERY, 2) else None
        for name, changes in self._changes.items():
            node = self._ledgers[name].node
            if target is not None:
                node.give_target(target)
            if self._is_due(number, CHANGE_EVERY):
                node.set_parameter(*changes[number // round(5 * self._rate) % len(changes)])

    def _is_due(self, number: int, every: float, offset: int = 0) -> bool:
        return number % round(every * self._rate) == offset

    def _hear(self, seconds: float) -> None:
        self._tester.spin(seconds)
        for ledger in self._ledgers.values():
            ledger.hear()
        while self._tracks:
            # In order; an image that was answered is not needed any more.
            cloud = self._tracks.pop(0)
            corners = self._corners.pop(stamp_ns(cloud.header), {})
            self._numbers.judge(sightings(cloud), corners)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Nodes at a camera's rate for hours, with faults mixed in, which have to stay as they were."""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sensor_msgs.msg import Image, PointCloud2

from laboratory.faults.bridge_scene import HEIGHT, BridgeScene
from laboratory.faults.detector import Detector
from laboratory.faults.failing_detector import FailingDetector
from laboratory.faults.faulty_messages import FaultyMessages
from laboratory.faults.lanes import Corners, Road
from laboratory.faults.ledger import VARYING_PARTS, Ledger
from laboratory.faults.node_process import NodeProcess, Tester
from laboratory.faults.numbers import Numbers, sightings
from laboratory.faults.parameter_changes import CHANGES
from laboratory.faults.vision_messages import vision_messages
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT, find_node

if TYPE_CHECKING:
    from laboratory.faults.request import Request

LINE = 260
"""Column of the line at which vehicles are counted, px: behind the bridge."""
TARGET_EVERY = 5.0
"""Seconds from one target to the next."""
CHANGE_EVERY = 5.0
"""Seconds from one change of a parameter to the next."""
WEIGHED_EVERY = 10.0
"""Seconds from one look at the memory to the next: six points a minute show growth well."""
LATE = 0.005
"""Seconds to listen before an image that is late: time for the some eight answers to one image."""
LAST_ANSWERS = 5.0
"""Seconds without an answer, after the last image, that end the wait for others: nodes that are
behind on a busy machine answer meanwhile."""
SECOND_ANSWERS = 1.0
"""Seconds in which a second answer to the last images would come."""
_DEPTH, _LONG_DEPTH = 10, 100
"""Images that wait for a node: two thirds of a second of a camera, and more than any pause."""
MOST_WAITING = 50
"""Reliable images without an answer from which the next one is held back: half of a long queue. On
a machine that is too busy for the rate, a full queue would lose images by no fault of the node."""


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
        names = request.nodes.split(",")
        has_detector = TRAFFIC_VARIANT.name in names and not request.motion
        self._tester = tester
        self._rate = request.rate
        self._holds_back = not request.best_effort
        self._share = request.share
        self._random = random.Random(request.seed)
        self._scene = BridgeScene(total, request.every, request.rate)
        self._faults = FaultyMessages(self._scene.image, request.seed)
        detector = None
        if has_detector:
            # Before the nodes: they inherit the path to messages that are built.
            detector = Detector(tester, vision_messages(folder), round(request.rate))
        self._ledgers = {
            name: Ledger(_start(tester, name, request, folder, has_detector), may_wait=True)
            for name in names
        }
        self._detector = None
        if detector is not None:
            counts = self._ledgers[TRAFFIC_VARIANT.name].counts
            self._detector = FailingDetector(
                detector, request.rate, counts, never_fails=not request.share
            )
        self._changes = {name: _changes(name) for name in names if name != TRAFFIC_VARIANT.name}
        self._numbers = _HeardNumbers(tester, self._scene.road, total)

    def run(self) -> None:
        """Show images until all vehicles have gone, and wait for the last answers."""
        first = self._scene.step(0)
        for ledger in self._ledgers.values():
            ledger.begin(self._tester, first)
        began = time.monotonic()
        number = 0
        while not self._scene.traffic.is_over:
            number += 1
            if self._holds_back:
                self._let_catch_up()
            # 1. At times a faulty image before the good one.
            if self._random.random() < self._share:
                self._send(self._faults.image(number), is_good=False)
            # 2. The good image, its detections, and what else is due.
            image = self._scene.step(number)
            self._numbers.expect(image, self._scene.corners)
            self._send(image, is_good=True)
            self._faults.note_good()
            if self._detector is not None:
                self._detector.publish(number, image.header, self._scene.detect())
            self._do_what_is_due(number)
            # 3. Until the next is due: by the clock of the whole run, so that delays do not add up.
            while (left := began + number / self._rate - time.monotonic()) > 0:
                self._hear(min(left, 0.01))
            # Answers are taken also where the next image is late already.
            self._hear(LATE)
        self._hear_last()
        for ledger in self._ledgers.values():
            ledger.close()

    def report(self) -> bool:
        """Print what came of it; return whether all held."""
        results = []
        for name, ledger in self._ledgers.items():
            results.append(ledger.report())
            if name == TRAFFIC_VARIANT.name:
                self._numbers.judged.report()
                results.append(not self._numbers.judged.reissued)
            said = Counter(VARYING_PARTS.sub("", line) for line in ledger.node.output.splitlines())
            for sentence, count in said.most_common(20):
                print(f"  said {count} times: {sentence[:160]}")
        return all(results)

    def _send(self, image: Image, *, is_good: bool) -> None:
        for ledger in self._ledgers.values():
            ledger.note(image, is_good=is_good)
        self._tester.show(image)

    def _do_what_is_due(self, number: int) -> None:
        """Weigh the nodes, and give a target or a parameter to single trackers, in their turn."""
        if self._is_due(number, WEIGHED_EVERY):
            for ledger in self._ledgers.values():
                ledger.weigh()
        # Two images after a change: the node has taken it.
        target = self._scene.target() if self._is_due(number, TARGET_EVERY, 2) else None
        for name, changes in self._changes.items():
            node = self._ledgers[name].node
            if target is not None:
                node.give_target(target)
            if self._is_due(number, CHANGE_EVERY):
                turn = number // round(CHANGE_EVERY * self._rate)
                node.set_parameter(*changes[turn % len(changes)])

    def _is_due(self, number: int, every: float, offset: int = 0) -> bool:
        return number % round(every * self._rate) == offset

    def _hear(self, seconds: float) -> None:
        self._tester.spin(seconds)
        for ledger in self._ledgers.values():
            ledger.hear()
        self._numbers.hear()

    @property
    def _answered(self) -> int:
        return sum(ledger.answered for ledger in self._ledgers.values())

    @property
    def _unanswered(self) -> int:
        return sum(ledger.unanswered for ledger in self._ledgers.values())

    def _let_catch_up(self) -> None:
        self._hear_while(lambda: self._most_unanswered > MOST_WAITING)
        # Images that were lost have no answer: they are reported, and waited for once.
        self._holds_back = self._most_unanswered <= MOST_WAITING

    @property
    def _most_unanswered(self) -> int:
        return max(ledger.unanswered for ledger in self._ledgers.values())

    def _hear_while(self, waits: Callable[[], object]) -> None:
        """Hear while there is something to wait for, until `LAST_ANSWERS` s bring no answer."""
        heard = self._answered
        deadline = time.monotonic() + LAST_ANSWERS
        while waits() and time.monotonic() < deadline:
            self._hear(0.02)
            if self._answered > heard:
                heard = self._answered
                deadline = time.monotonic() + LAST_ANSWERS

    def _hear_last(self) -> None:
        self._hear_while(lambda: self._unanswered)
        # No second answers follow.
        self._hear(SECOND_ANSWERS)
        self._numbers.close()


class _HeardNumbers:
    """Numbers of vehicles as ~/tracks has them, and where the vehicles were in each image."""

    def __init__(self, tester: Tester, road: Road, total: int) -> None:
        self.judged = Numbers(road, total)
        self._tracks = tester.collect(PointCloud2, f"/{TRAFFIC_VARIANT.executable}/tracks")
        self._corners: dict[int, Corners] = {}

    def expect(self, image: Image, corners: Corners) -> None:
        """Note where the vehicles are in an image that is sent."""
        self._corners[stamp_ns(image.header)] = corners

    def hear(self) -> None:
        """Judge the answers that have come."""
        while self._tracks:
            # In order; an image that was answered is not needed any more.
            cloud = self._tracks.pop(0)
            self.judged.judge(sightings(cloud), self._corners.pop(stamp_ns(cloud.header), {}))

    def close(self) -> None:
        """Judge all numbers that are still on a vehicle."""
        # An answer without vehicles closes them.
        self.judged.judge((), {})


def _start(
    tester: Tester, name: str, request: Request, folder: Path, has_detector: bool
) -> NodeProcess:
    """Start the node of a variant."""
    # Reliable images wait in the queue while another process has the processor.
    words = [f"queue_depth:={_DEPTH if request.best_effort else _LONG_DEPTH}"]
    if name == TRAFFIC_VARIANT.name:
        lines = folder / "lines.yaml"
        lines.write_text(f"lines: {{exit: {{from: [{LINE}, {HEIGHT}], to: [{LINE}, 0]}}}}\n")
        words += [f"detector.kind:={'topic' if has_detector else 'motion'}", f"lines:={lines}"]
    return NodeProcess(tester, name, *words, is_reliable=not request.best_effort)


def _changes(name: str) -> Sequence[tuple[str, object]]:
    """Return the changes that the node of a variant has a parameter for."""
    known = Configuration.of(find_node(name)).specs()
    return [(parameter, value) for parameter, value in CHANGES if parameter in known]

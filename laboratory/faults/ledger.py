# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The judge of a node: every image that reaches it is answered exactly once, and rightly."""

from __future__ import annotations

import re
import time
from collections import Counter, deque
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import Image

from laboratory.faults.node_process import TIMEOUT, FaultError, NodeProcess, Tester
from vehicle_pf_tracker.ros.messages import NOT_READY, REJECTED_MESSAGE, WAITING_MESSAGE, stamp_ns

VARYING_PARTS = re.compile(r"^.*?\]: |\d+")
"""Parts in which sentences of one kind, that a node says, differ."""
MB = 1e6
"""Bytes of a megabyte."""
SETTLED = 600.0
"""Seconds until memory has to stay as it is; a shorter run shows its second half."""
GROWTH = 5.0
"""MB that a node's resident memory may grow by from then on."""
_TRACKED = frozenset({"TRACKING", "OCCLUDED", "LOST"})
_SHOWN = 10
"""Wrong answers that are quoted."""


@dataclass(frozen=True, slots=True)
class _Sent:
    """An image on its way: its size in px, when it was sent, and whether it is a good one."""

    width: int
    height: int
    when: float
    is_good: bool


@dataclass
class Ledger:
    """Images sent to a node, and its answers.

    Two images may have one stamp, as faulty clocks give them: each has to be answered once.

    Attributes
    ----------
    node : NodeProcess
        The node.
    may_wait : bool
        True where a good image may be answered without an estimate, as before there is a target.
    counts : Counter of str
        Answers by the kind of image and their mode, and other events.
    second_answers, wrong_answers : list of str
        Answers to images that had theirs, and answers that are wrong in themselves.
    lost : int
        Images that never reached the node; known after `close`.
    """

    node: NodeProcess
    may_wait: bool = False
    counts: Counter[str] = field(default_factory=Counter)
    second_answers: list[str] = field(default_factory=list)
    wrong_answers: list[str] = field(default_factory=list)
    lost: int = 0
    _waiting: dict[int, deque[_Sent]] = field(default_factory=dict)
    _latencies: list[float] = field(default_factory=list)
    _sizes: list[tuple[float, int]] = field(default_factory=list)
    _first: int | None = None
    _began: float = field(default_factory=time.monotonic)

    def begin(self, tester: Tester, image: Image) -> None:
        """Wait until the node answers `image`, which is sent again and again."""
        # Sent several times, it is answered several times, the last perhaps after this.
        self._first = stamp_ns(image.header)
        deadline = time.monotonic() + TIMEOUT
        while not self.node.modes or _is_loading(self.node.modes[-1]):
            if self.node.modes:
                deadline = time.monotonic() + TIMEOUT  # it lives, and compiles
            if time.monotonic() > deadline or not self.node.is_alive:
                raise FaultError(f"{self.node.name} does not answer:\n{self.node.output[-4000:]}")
            tester.show(image)
            tester.spin(0.2)
        self.node.modes.clear()
        self._began = time.monotonic()

    def note(self, image: Image, *, is_good: bool) -> None:
        """Note that an image is sent now."""
        sent = _Sent(image.width, image.height, time.monotonic(), is_good)
        self._waiting.setdefault(stamp_ns(image.header), deque()).append(sent)

    def hear(self) -> list[int]:
        """Judge the answers that have come; return the stamps of those that answer an image."""
        heard = []
        while self.node.modes:
            answer = self.node.modes.pop(0)
            key = stamp_ns(answer.header)
            if key == self._first:
                continue
            # The image has had its answer, or was never sent.
            if key not in self._waiting:
                self.second_answers.append(f"{key}: {answer}")
                continue
            # The oldest of those with this stamp.
            sent = self._waiting[key].popleft()
            if not self._waiting[key]:
                del self._waiting[key]
            heard.append(key)
            self._judge(answer, sent)
        return heard

    def _judge(self, answer: DiagnosticArray, sent: _Sent) -> None:
        mode = str(answer.status[0].message)
        values = {pair.key: pair.value for pair in answer.status[0].values}
        self.counts[f"{'good' if sent.is_good else 'faulty'}: {mode}"] += 1
        # Faulty images are answered without a step, and would make the node look fast.
        if sent.is_good:
            self._latencies.append(time.monotonic() - sent.when)
        if not _is_right(mode, values, sent, may_wait=self.may_wait):
            self.wrong_answers.append(f"{sent} is answered {mode}: {values}")

    def take(self, tester: Tester, image: Image, *, is_good: bool) -> None:
        """Send an image and wait for its answer, and a moment longer for no second one."""
        self.note(image, is_good=is_good)
        tester.show(image)
        # In lock-step: the answer has to be there before the next image.
        deadline = time.monotonic() + TIMEOUT
        while not self.hear():
            tester.spin(0.002)
            if time.monotonic() > deadline or not self.node.is_alive:
                raise FaultError(f"no answer to {image.header}:\n{self.node.output[-4000:]}")
        if self.second_answers or self.wrong_answers:
            raise FaultError((self.second_answers + self.wrong_answers)[0])

    def weigh(self) -> None:
        """Note the node's memory."""
        self._sizes.append((time.monotonic() - self._began, self.node.resident))

    @property
    def unanswered(self) -> int:
        """Number of images without an answer."""
        return sum(map(len, self._waiting.values()))

    @property
    def answered(self) -> int:
        """Number of images with one."""
        return sum(n for words, n in self.counts.items() if words.startswith(("good:", "faulty:")))

    def close(self) -> None:
        """Count the images that were lost, and end the node."""
        self.lost = self.node.lost()
        self.node.end()

    def report(self) -> bool:
        """Print what came of it; return whether all held."""
        growth = self._growth()
        print(f"{self.node.name}: {self.answered} images answered, {self.lost} lost in transit")
        print(f"  others without an answer: {max(self.unanswered - self.lost, 0)}")
        print(f"  second answers: {len(self.second_answers)}", end="; ")
        print(f"wrong answers: {len(self.wrong_answers)}")
        for words, count in sorted(self.counts.items()):
            print(f"  {words:18} {count}")
        middle, high, most = np.percentile(np.array(self._latencies or [0.0]) * 1e3, [50, 95, 99])
        print(f"  answers after {middle:.1f} ms (p50), {high:.1f} (p95), {most:.1f} (p99)")
        for words in [*self.second_answers, *self.wrong_answers][:_SHOWN]:
            print(f"  {words}")
        # An image that DDS lost on its way needs no answer.
        is_complete = (
            self.unanswered <= self.lost and not self.second_answers and not self.wrong_answers
        )
        return is_complete and growth <= GROWTH and all(self.node.changes)

    def _growth(self) -> float:
        """Print how the memory went; return by how many MB it grew once settled."""
        times, sizes = np.array(self._sizes or [(0.0, 0)]).T
        # A short run shows its second half, and is not judged by it.
        since = min(SETTLED, times[-1] / 2)
        settled = sizes[times >= since] / MB
        print(
            f"{self.node.name}: resident memory {settled[0]:.1f} MB after {since / 60:.1f} "
            f"minutes, {settled[-1]:.1f} MB at the end, {settled.max():.1f} MB at most"
        )
        return float(settled[-1] - settled[0]) if times[-1] > SETTLED else 0.0


def _is_loading(answer: DiagnosticArray) -> bool:
    return any(pair.value.startswith(NOT_READY) for pair in answer.status[0].values)


def _is_right(mode: str, values: Mapping[str, str], sent: _Sent, *, may_wait: bool) -> bool:
    if mode == REJECTED_MESSAGE:
        # A reason is needed, and one that the node has foreseen.
        return not sent.is_good and not values.get("reason", "unexpected").startswith("unexpected")
    if mode == WAITING_MESSAGE:
        return may_wait
    # An estimate has a position; before there is a target there is none.
    if mode not in _TRACKED or "x" not in values:
        return may_wait
    x, y, confidence = (float(values[name]) for name in ("x", "y", "confidence"))
    return 0 <= x <= sent.width and 0 <= y <= sent.height and 0 <= confidence <= 1

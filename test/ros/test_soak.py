# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The soak listens to its nodes, however late it is, without real nodes."""

from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from laboratory.faults import soak


class NotingTester:
    """Notes what happens in which order."""

    def __init__(self):
        self.events = []

    def collect(self, kind, topic):
        return []

    def show(self, image):
        self.events.append("image")

    def spin(self, seconds):
        self.events.append(seconds)


class Ledger:
    answered = unanswered = 0

    def __init__(self, node, *, may_wait):
        self.counts = {}

    def begin(self, tester, image): ...
    def note(self, image, *, is_good): ...
    def weigh(self): ...
    def hear(self): ...
    def close(self): ...


class LateLedger(Ledger):
    """Of a node that answers at every other look."""

    unanswered = most = looks = 0

    def note(self, image, *, is_good):
        self.unanswered += 1
        LateLedger.most = max(LateLedger.most, self.unanswered)

    def hear(self):
        self.looks += 1
        self.unanswered = max(0, self.unanswered - self.looks % 2)


class LostLedger(Ledger):
    """Of a node that gets no image."""

    unanswered = 0

    def note(self, image, *, is_good):
        self.unanswered += 1


REQUEST = SimpleNamespace(
    nodes="traffic",
    motion=True,
    rate=1e6,
    share=0.0,
    minutes=1e-9,
    every=1.0,
    seed=0,
    best_effort=False,
)


def test_images_are_held_back_before_the_queue_is_full(tmp_path, monkeypatch):
    monkeypatch.setattr(soak, "_start", lambda *words: None)
    monkeypatch.setattr(soak, "Ledger", LateLedger)
    monkeypatch.setattr(soak, "MOST_WAITING", 5)
    soak.Soak(NotingTester(), REQUEST, tmp_path).run()
    assert LateLedger.most == 6


def test_images_that_were_lost_hold_the_next_ones_back_once(tmp_path, monkeypatch):
    monkeypatch.setattr(soak, "_start", lambda *words: None)
    monkeypatch.setattr(soak, "Ledger", LostLedger)
    monkeypatch.setattr(soak, "MOST_WAITING", 5)
    clock = iter(range(100_000))
    monkeypatch.setattr(soak.time, "monotonic", lambda: float(next(clock)))
    tester = NotingTester()
    soak.Soak(tester, REQUEST, tmp_path).run()
    looks = tester.events.count(0.02)
    # Before the seventh image, and after the last one.
    assert looks == 2 * (soak.LAST_ANSWERS - 1)


def test_answers_are_heard_between_images_that_are_all_late(tmp_path, monkeypatch):
    monkeypatch.setattr(soak, "_start", lambda *words: None)
    monkeypatch.setattr(soak, "Ledger", Ledger)
    tester = NotingTester()
    # A million images a second: each is late as soon as the one before it is painted.
    soak.Soak(tester, REQUEST, tmp_path).run()
    images = tester.events.count("image")
    assert images > 50
    assert tester.events == [*["image", soak.LATE] * images, soak.SECOND_ANSWERS]

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


def test_answers_are_heard_between_images_that_are_all_late(tmp_path, monkeypatch):
    monkeypatch.setattr(soak, "_start", lambda *words: None)
    monkeypatch.setattr(soak, "Ledger", Ledger)
    tester = NotingTester()
    # A million images a second: each is late as soon as the one before it is painted.
    request = SimpleNamespace(
        nodes="traffic", motion=True, rate=1e6, share=0.0, minutes=1e-9, every=1.0, seed=0
    )
    soak.Soak(tester, request, tmp_path).run()
    images = tester.events.count("image")
    assert images > 50
    assert tester.events == [*["image", soak.LATE] * images, soak.SECOND_ANSWERS]

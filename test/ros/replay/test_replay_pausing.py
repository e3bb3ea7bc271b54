# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pausing a replay, by services and by the space bar."""

import os
import pty
import sys

import pytest

pytest.importorskip("rclpy")

from replay_rig import StubTracker, record, spinning, stamps
from std_srvs.srv import Trigger

from vehicle_pf_tracker.ros.replay import pausing
from vehicle_pf_tracker.ros.replay.pace import ReplayPace
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replaying import replay

pytestmark = pytest.mark.ros

TICK = 0.02
TICKS = 20
"""Ticks in which a replay that does not pause publishes its first image: it waits for nothing."""
KEYS = """
from vehicle_pf_tracker.ros.replay.pausing import keys_at_once, pressed_keys
with keys_at_once():
    print("ready", flush=True)
    while " " not in (keys := pressed_keys()):
        pass
print(f"heard {keys!r}", flush=True)
"""


def test_a_replay_stands_until_a_service_lets_it_go_on(bench, tmp_path):
    stub = StubTracker(bench)
    client = stub.node.create_client(Trigger, "/bag_replay/toggle_paused")
    ticks, answers, told = [], [], []

    def tick():
        if "reset" not in stub.events:
            return
        ticks.append(len(stub.stamps))
        if len(ticks) == TICKS:
            call = client.call_async(Trigger.Request())
            call.add_done_callback(lambda done: answers.append(done.result().message))

    stub.node.create_timer(TICK, tick)
    options = ReplayOptions(lockstep=True, nodes=("stub_tracker",), start_paused=True)
    with spinning(bench):
        report = replay(record(tmp_path / "bag"), options, tell=told.append)
    assert ticks[:TICKS] == [0] * TICKS
    assert stub.stamps == stamps()
    assert report.nodes[0].answered == len(stamps())
    assert answers == ["playing"]
    assert "playing" in told


class Node:
    """A node that only notes its services."""

    def __init__(self):
        self.services = {}

    def create_service(self, _kind, name, callback):
        self.services[name] = callback

    def create_timer(self, _period, callback, clock):
        self.look = callback

    def call(self, name):
        return self.services[f"~/{name}"](None, Trigger.Response()).message


def test_pause_and_resume_say_where_nothing_changes():
    node, pace, told = Node(), ReplayPace(1.0), []
    pausing.offer_pausing(node, pace, told.append)
    assert node.call("resume") == "not paused"
    assert node.call("pause").startswith("paused; ")
    assert pace.is_paused
    assert node.call("pause") == "paused already"
    assert node.call("toggle_paused") == "playing"
    assert not pace.is_paused
    assert len(told) == 2


def test_the_space_bar_pauses_and_continues(monkeypatch):
    keys = iter(["", " ", "x", " "])
    monkeypatch.setattr(pausing, "is_at_terminal", lambda: True)
    monkeypatch.setattr(pausing, "pressed_keys", lambda: next(keys))
    node, pace = Node(), ReplayPace(1.0)
    pausing.offer_pausing(node, pace, lambda _: None)
    states = []
    for _ in range(4):
        node.look()
        states.append(pace.is_paused)
    assert states == [False, True, True, False]


def test_without_a_terminal_no_key_is_read(monkeypatch, tmp_path):
    with (tmp_path / "file").open("w+") as file:
        monkeypatch.setattr(sys, "stdin", file)
        with pausing.keys_at_once():
            assert pausing.pressed_keys() == ""


def test_a_terminal_gives_each_key_at_once_and_without_an_echo():
    child, terminal = pty.fork()
    if not child:
        os.execv(sys.executable, [sys.executable, "-c", KEYS])
    heard = b""
    while b"ready" not in heard:
        heard += os.read(terminal, 100)
    os.write(terminal, b"a ")
    while b"heard" not in heard or not heard.endswith(b"\n"):
        heard += os.read(terminal, 100)
    assert os.waitpid(child, 0)[1] == 0
    os.close(terminal)
    assert heard.count(b" ") == 2  # of the words that the program prints: no key was echoed

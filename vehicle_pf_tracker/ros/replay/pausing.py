# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pausing a replay: services of the player's node, and the space bar of its terminal.

The names are the rosbag2 player's. Its service types are in no package that comes with nodes, so
that these are triggers.
"""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from std_srvs.srv import Trigger

from vehicle_pf_tracker.ros.replay.pace import ReplayPace

_LOOKS = 10.0
"""Looks at the keyboard per second: a tenth of a second is at once for a person."""


def offer_pausing(node: Node, pace: ReplayPace, tell: Callable[[str], None]) -> None:
    """Let services of `node`, and the space bar, stop and continue `pace`.

    Parameters
    ----------
    node : Node
        The player's own node.
    pace : ReplayPace
        ReplayPace of the replay.
    tell : callable
        Called with a sentence when it stops or continues.
    """

    def set_paused(paused: bool) -> str:
        if paused == pace.is_paused:
            return "paused already" if paused else "not paused"
        pace.set_paused(paused)
        sentence = "paused; space or ~/resume continues" if paused else "playing"
        tell(sentence)
        return sentence

    actions: dict[str, Callable[[], bool]] = {
        "pause": lambda: True,
        "resume": lambda: False,
        "toggle_paused": lambda: not pace.is_paused,
    }

    def answer(action: Callable[[], bool], response: Trigger.Response) -> Trigger.Response:
        response.success = True
        response.message = set_paused(action())
        return response

    for name, action in actions.items():
        node.create_service(
            Trigger, f"~/{name}", lambda _, response, action=action: answer(action, response)
        )

    def look() -> None:
        if " " in pressed_keys():
            set_paused(not pace.is_paused)

    if is_at_terminal():
        node.create_timer(1 / _LOOKS, look, clock=Clock(clock_type=ClockType.STEADY_TIME))


@contextmanager
def keys_at_once() -> Iterator[None]:
    """Have the terminal give each key as it is pressed, without the return key or an echo."""
    if not is_at_terminal():
        yield
        return
    before = termios.tcgetattr(sys.stdin)
    tty.setcbreak(sys.stdin, termios.TCSADRAIN)
    try:
        yield
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)


def pressed_keys() -> str:
    """Return the keys that were pressed since the last call."""
    keys = ""
    while is_at_terminal() and select.select([sys.stdin], [], [], 0.0)[0]:
        # Past Python's buffer, which `select` does not see.
        if not (read := os.read(sys.stdin.fileno(), 64)):
            break
        keys += read.decode(errors="replace")
    return keys


def is_at_terminal() -> bool:
    """Test whether this process has the keyboard: reading in the background would stop it."""
    try:
        return os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (OSError, ValueError, AttributeError):  # no terminal, closed, or none at all
        return False

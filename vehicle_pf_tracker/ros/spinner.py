"""Waiting while callbacks run, until something holds, a time has come or the user interrupts."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

_SLICE = 0.05
"""Longest uninterrupted wait in s: changes of the graph and signals wake no executor."""


class Interrupted(Exception):  # noqa: N818 (no error: the user wants it so)
    """The user asked to end."""


class Spinner:
    """Runs the callbacks of one node while waiting.

    Parameters
    ----------
    node : Node
        The node; its context must outlive this object.
    """

    def __init__(self, node: Node) -> None:
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._interrupted = False

    def interrupt(self) -> None:
        """End the present or the next wait with `Interrupted`."""
        self._interrupted = True

    def check(self) -> None:
        """Raise `Interrupted` if the user asked to end."""
        if self._interrupted:
            raise Interrupted

    def until(self, holds: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until `holds()`; False if it does not within `timeout` s (None: however long)."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not holds():
            self.check()
            left = _SLICE if deadline is None else deadline - time.monotonic()
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=min(left, _SLICE))
        return True

    def until_time(self, moment: float) -> None:
        """Wait until the monotonic clock shows `moment` s."""
        self.until(lambda: time.monotonic() >= moment, moment - time.monotonic())
        self.check()

    def close(self) -> None:
        """Let go of the node."""
        self._executor.shutdown()


@contextmanager
def interruptible(spinner: Spinner) -> Iterator[None]:
    """Turn SIGINT and SIGTERM into `Interrupted` at the next wait, however often they come.

    Launch files send SIGINT twice; the second must not break the cleaning up. Outside of the main
    thread, where Python allows no handlers, signals stay as they are.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def handle(*_: Any) -> None:
        spinner.interrupt()

    before = {number: signal.signal(number, handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)

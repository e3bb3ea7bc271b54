"""Ctrl-C as a wish that is noted, not as an exception that comes anywhere."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def noted_interrupts() -> Iterator[threading.Event]:
    """Give an event that SIGINT, SIGTERM and SIGHUP set, however often they come.

    SIGHUP, from a terminal that closes, would otherwise leave the segments in shared memory. Launch
    files send SIGINT twice, and the second must not break the cleaning up. Outside of the main
    thread, where Python allows no handlers, signals stay as they are.
    """
    noted = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield noted
        return

    def note(*_: Any) -> None:
        noted.set()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as nohup sets it
        numbers.append(signal.SIGHUP)
    before = {number: signal.signal(number, note) for number in numbers}
    try:
        yield noted
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)

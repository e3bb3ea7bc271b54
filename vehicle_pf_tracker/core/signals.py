# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signals that end a program, taken for a while."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TypeAlias

Handle: TypeAlias = Callable[[int, FrameType | None], None]
"""Handler of a signal, called with its number and the frame of code that it interrupts."""


def ending_signals() -> list[signal.Signals]:
    """Return SIGINT, and SIGTERM and SIGHUP unless they are ignored, as SIGHUP is under nohup."""
    others = (signal.SIGTERM, signal.SIGHUP)
    heard = [other for other in others if signal.getsignal(other) is not signal.SIG_IGN]
    return [signal.SIGINT, *heard]


@contextmanager
def handled(numbers: Iterable[signal.Signals], handle: Handle) -> Iterator[None]:
    """Handle signals meanwhile; outside of the main thread, where none can be, they stay."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, handle) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)

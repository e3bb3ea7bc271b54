# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signals that end a command: partial files are removed, and what was tracked is kept."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from contextlib import contextmanager
from types import FrameType
from typing import TypeVar

from vehicle_pf_tracker.core.signals import ending_signals, handled

T = TypeVar("T")

SIGNALS_STATUS = 128
"""Exit status of a program that a signal ended, less the signal's number, as shells have it."""
_PATIENCE = 1.0
"""Seconds that a computation has to end by itself after a signal: a person who presses Ctrl-C has
the terminal back within two."""
_POLL = 0.1
"""Seconds from one check whether it has ended to the next, too short to be felt."""


class Terminated(BaseException):
    """SIGTERM or SIGHUP came; raised as `KeyboardInterrupt` is, so that partial files go."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number

    def end(self) -> None:
        """End the process by the signal, as the one who sent it expects."""
        signal.signal(self.number, signal.SIG_DFL)
        os.kill(os.getpid(), self.number)


@contextmanager
def raising_terminated() -> Iterator[None]:
    """Raise `Terminated` where SIGTERM or SIGHUP would end the process; a second one ends it."""

    def raise_terminated(number: int, _frame: FrameType | None) -> None:
        signal.signal(number, signal.SIG_DFL)
        raise Terminated(number)

    # Who has set a handler of their own, or ignores it as under nohup, keeps that.
    ending = signal.SIGTERM, signal.SIGHUP
    unset = [number for number in ending if signal.getsignal(number) is signal.SIG_DFL]
    with handled(unset, raise_terminated):
        yield


class StillAtWork(BaseException):
    """A computation was left that did not end after a signal."""


class Stop:
    """Record of a signal that ends the command, and the way out of work that does not end then.

    Attributes
    ----------
    number : int or None
        Number of that signal.
    has_left : bool
        True once a computation was left at work: it would abort or hold up Python's own exit.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self.has_left = False

    @property
    def came(self) -> bool:
        """True once a signal has come."""
        return self.number is not None

    @property
    def status(self) -> int:
        """Exit status by the signal; 0 if none has come."""
        return 0 if self.number is None else SIGNALS_STATUS + self.number

    def end_unbegun(self) -> None:
        """End a command whose signal came before there was anything to keep.

        Raises
        ------
        KeyboardInterrupt, Terminated
            As without a `Stop`; neither if no signal has come.
        """
        if self.number == signal.SIGINT:
            raise KeyboardInterrupt
        if self.number is not None:
            raise Terminated(self.number)

    def ended(self, status: int) -> int:
        """Return the exit status, or end the process with it where a computation was left."""
        if self.has_left:
            sys.stdout.flush()
            os._exit(status)
        return status

    def leaving(self, compute: Callable[[], T]) -> T:
        """Compute in a thread of its own, so that code that never returns can be left.

        Raises
        ------
        StillAtWork
            If a signal came a second ago.
        """
        future: Future[T] = Future()

        def work() -> None:
            try:
                future.set_result(compute())
            except BaseException as error:
                future.set_exception(error)

        threading.Thread(target=work, daemon=True).start()
        patience = _PATIENCE
        while not wait([future], _POLL).done:
            patience -= _POLL if self.came else 0.0
            if patience < 0:
                self.has_left = True
                raise StillAtWork
        return future.result()


@contextmanager
def stopping(stop: Stop) -> Iterator[None]:
    """Take SIGINT, SIGTERM and SIGHUP as a stop, once; a second one acts as usual."""
    before = {number: signal.getsignal(number) for number in ending_signals()}

    def note(number: int, _frame: FrameType | None) -> None:
        stop.number = number
        signal.signal(number, before[signal.Signals(number)])

    with handled(before, note):
        yield

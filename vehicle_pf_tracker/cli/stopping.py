# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signals that end a command: partial files are removed, and what was tracked is kept.

The part of a source that a verb tracks in: from one moment to another, or to a signal.
"""

from __future__ import annotations

import itertools
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, wait
from contextlib import contextmanager, suppress
from functools import partial
from types import FrameType
from typing import TYPE_CHECKING, TypeVar

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.signals import ending_signals, handled

if TYPE_CHECKING:
    from vehicle_pf_tracker.cli.tracking_options import Moment
    from vehicle_pf_tracker.following.processes import OnProgress
    from vehicle_pf_tracker.recordings.reader import StampedFrame
    from vehicle_pf_tracker.recordings.source import ImageSource
    from vehicle_pf_tracker.showing.pictures import Numbered

T = TypeVar("T")

SIGNALS_STATUS = 128
"""Exit status of a program that a signal ended, less the signal's number, as shells have it."""
_PATIENCE = 1.0
"""Seconds that a computation has to end by itself after a signal: a person who presses Ctrl-C has
the terminal back within two."""
_POLL = 0.1
"""Seconds between two looks whether it has ended, which nobody feels."""


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
    """Tells that a signal has come, and leaves a computation that does not end then.

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
        """Exit status that tells of the signal; 0 if none has come."""
        return 0 if self.number is None else SIGNALS_STATUS + self.number

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


def numbered_part(
    source: ImageSource, start: Moment | None, end: Moment | None, stop: Stop, progress: OnProgress
) -> tuple[tuple[int, StampedFrame], Numbered]:
    """Return the first frame from `start` on, and all to `end`, with their numbers in the source.

    They end when `stop` comes; `progress` takes the number of each.

    Raises
    ------
    InputError
        If there is none.
    """
    frames = _numbered(source, start, end, stop, progress)
    first = next(frames, None)
    if first is None:
        raise InputError("the source ended before its first image")
    return first, itertools.chain([first], frames)


def _numbered(
    source: ImageSource, start: Moment | None, end: Moment | None, stop: Stop, progress: OnProgress
) -> Iterator[tuple[int, StampedFrame]]:
    first_ns: int | None = None
    number = 0
    is_empty = True
    frames = source.frames()
    if source.frame_count is None:  # it may stall
        frames = _leavable(frames, stop)
    frames = itertools.takewhile(lambda _: not stop.came, frames)
    for number, found in enumerate(frames, start=1):
        first_ns = found.stamp_ns if first_ns is None else first_ns
        elapsed = (found.stamp_ns - first_ns) * 1e-9
        if start is not None and start.after(number, elapsed) > 0:
            continue
        if end is not None and end.after(number, elapsed) < 0:
            break
        is_empty = False
        progress(number, source.frame_count)
        yield number, found
    if is_empty and (start is not None or end is not None):
        raise InputError(
            f"no frame lies between --start and --end; {number} frames were read from the source"
        )


def _leavable(frames: Iterator[StampedFrame], stop: Stop) -> Iterator[StampedFrame]:
    """Yield frames until one does not come after a signal."""
    with suppress(StillAtWork):
        while (found := stop.leaving(partial(next, frames, None))) is not None:
            yield found


def cut_short(stop: Stop, source: ImageSource, done: int) -> list[str]:
    """Say that a signal ended the run after `done` frames; empty if it is whole.

    A live source ends by a signal, and so its run is whole then.
    """
    if not stop.came or source.frame_count is None:
        return []
    return [f"a signal ended the run after {done} of {source.frame_count} frames"]

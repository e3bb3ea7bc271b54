# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Attempts of a tracker at images: its unexpected errors, and when it starts anew for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from vehicle_pf_tracker.core.errors import InputError

ResultT = TypeVar("ResultT")


class TrackerError(Exception):
    """Unexpected error of a tracker in one image; its cause is the error itself.

    Attributes
    ----------
    persists : bool
        True where the tracker failed again as soon as it had started anew: it is broken.
    """

    def __init__(self, error: Exception, *, persists: bool) -> None:
        super().__init__(unexpected(error))
        self.persists = persists


def unexpected(error: Exception) -> str:
    """Describe an error that nobody expected."""
    if isinstance(error, TrackerError):
        return str(error)
    return f"unexpected {type(error).__name__}: {error}"


class Attempts:
    """Takes the steps of one tracker, and lets it start anew where it fails.

    The first unexpected error costs its image: it may be that image's fault. After the second one
    in a row the tracker starts anew and takes the same image again. If that fails too, the tracker
    is broken.

    Attributes
    ----------
    events : list of str
        Irregularities of the image, for logs and diagnostics.
    recovered : bool
        True where the tracker failed and started anew in the image.
    """

    def __init__(self) -> None:
        self.events: list[str] = []
        self.recovered = False
        self._errors_in_a_row = 0

    def begin_image(self) -> None:
        """Note that the next image has come."""
        self.events = []
        self.recovered = False

    def take(self, step: Callable[[], ResultT], start_anew: Callable[[], None]) -> ResultT:
        """Take a step, once more after a new start.

        Parameters
        ----------
        step : callable
            Tracks in the image, and returns the result.
        start_anew : callable
            Discards the tracker's state, so that the same image can be taken again.

        Raises
        ------
        TrackerError
            If it fails, and the tracker does not start anew for it.
        """
        try:
            result = step()
        except InputError:  # the tracker is not at fault
            raise
        except Exception as error:  # whatever a tracker or a network raises
            self._errors_in_a_row += 1
            # 1: cost one image. 2: start anew. 3, within the new start: it is broken.
            if self._errors_in_a_row % 2:
                raise TrackerError(error, persists=self._errors_in_a_row > 1) from error
            self.events.append(
                f"the tracker failed twice in a row and has started anew: {unexpected(error)}"
            )
            start_anew()
            self.recovered = True
            return self.take(step, start_anew)
        self._errors_in_a_row = 0
        return result

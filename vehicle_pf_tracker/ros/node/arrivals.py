# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arrivals of images at a node: how many, how fast, how old, and how many were lost on the way."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any


class Arrivals:
    """Counts the images that reach a node, since it was configured.

    Parameters
    ----------
    clock : callable
        Steady time in s.

    Attributes
    ----------
    images : int
        Images that arrived.
    dropped : int
        Images that were sent but never arrived.
    age : float
        Time from the last image's stamp to its arrival, s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.images = 0
        self.dropped = 0
        self.age = 0.0
        self._clock = clock
        self._heard = self._reported = clock()
        self._images_reported = 0
        self._number: int | None = None

    @property
    def silence(self) -> float:
        """Seconds since the last image, or since listening began."""
        return self._clock() - self._heard

    def listen(self) -> None:
        """Start waiting for images: neither the time nor the images missed before count."""
        self._heard = self._clock()
        # The publisher may be another one by now, or have sent to others meanwhile.
        self._number = None

    def add(self, info: Mapping[str, Any], age: float, count_publishers: Callable[[], int]) -> None:
        """Count an image.

        Parameters
        ----------
        info : mapping
            The message's info; gaps in its publication sequence number are dropped images.
        age : float
            Time from the image's stamp to now, in s.
        count_publishers : callable
            Returns the number of publishers on the topic; is called where images seem to be
            missing, as the numbers of several publishers cannot be separated.
        """
        self.images += 1
        self._heard = self._clock()
        self.age = age
        number = info.get("publication_sequence_number")
        if number is not None and self._number is not None:
            # A publisher that was restarted counts from 1 again.
            missing = number - self._number - 1
            if missing > 0 and count_publishers() == 1:
                self.dropped += missing
        # Also where it went back: the next gap is counted from here.
        self._number = number

    def rate(self) -> float:
        """Return the images per second since the last call, and begin the next interval."""
        now = self._clock()
        new = self.images - self._images_reported
        seconds = now - self._reported
        self._images_reported = self.images
        self._reported = now
        # Two reports in one instant have no rate.
        return new / seconds if seconds > 0 else 0.0

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images with their times, as any source yields them, and footage with its truth."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth

START_NS = 1_000_000_000
"""Stamp of the first image. Not 0, which many ROS programs take for "no time"."""
LOWEST_FPS = 1e-4
"""Least frame rate that is believed, 1/s: an image every three hours."""
HIGHEST_FPS = 1e6
"""Highest frame rate that is believed, 1/s: the fastest cameras reach it."""
LARGEST_PX = 2.0**24
"""Largest coordinate of a true box, px: beyond it a polygon's single precision loses whole px."""
LAST_STAMP_NS = (2**31 - 1) * 10**9
"""Last stamp: `builtin_interfaces/Time` has a signed 32-bit number of seconds."""


@dataclass(frozen=True, slots=True)
class StampedFrame:
    """An image and the stamp of its header in ns; no frame where it cannot be read."""

    stamp_ns: int
    frame: Frame | None


@dataclass(frozen=True, slots=True)
class Picture(StampedFrame):
    """One image of the footage.

    Attributes
    ----------
    name : str
        Name of the image in an error.
    coded_format : str or None
        ``jpeg`` or ``png`` where it comes as such a file; else None.
    coded : bytes
        The bytes of that file.
    truth : Truth or None
        True state of the vehicle; None where it is unknown.
    """

    frame: Frame
    name: str
    coded_format: str | None = None
    coded: bytes = b""
    truth: Truth | None = None


class Footage(ABC):
    """Images of a video file, a folder, a camera or a stream; a source without topics.

    Attributes
    ----------
    fps : float
        Frames per second.
    frame_count : int or None
        Number of images; None where it is unknown.
    """

    image_topic = ""
    fps: float
    frame_count: int | None
    _notices: Sequence[str] = ()

    @abstractmethod
    def frames(self) -> Iterator[StampedFrame]:
        """Yield the images in the order of time, those that can be read as `Picture`.

        Raises
        ------
        InputError
            If none can be read, or the source breaks.
        """

    def truth(self) -> Sequence[Truth]:
        """Return the truth that is known before the images are read, in the order of time."""
        return ()

    @property
    def notices(self) -> list[str]:
        """Irregularities, a sentence each; complete when all images are read."""
        return list(self._notices)


def check_fps(fps: float, source: Path | str) -> float:
    """Return the frame rate that `source` states, in 1/s.

    Raises
    ------
    InputError
        If it is not between `LOWEST_FPS` and `HIGHEST_FPS`.
    """
    if not LOWEST_FPS <= fps <= HIGHEST_FPS:
        raise InputError(
            f"the frame rate (fps) in {source} must be a number from {LOWEST_FPS:g} to "
            f"{HIGHEST_FPS:g} frames per second"
        )
    return float(fps)


def stamp_of(index: int, fps: float) -> int:
    """Return the stamp in ns of the picture `index` (from 0) at `fps` pictures per second.

    Raises
    ------
    InputError
        If it is later than ROS can express.
    """
    if index * 1e9 / fps > LAST_STAMP_NS - START_NS:
        raise InputError(
            f"image {index} at {fps:g} frames per second is later than the last time that ROS can "
            "express, 2^31 s"
        )
    # From the index, not from the stamp before: rounding errors do not add up.
    return START_NS + round(index * 1e9 / fps)

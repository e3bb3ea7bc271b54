"""What an importer reads: pictures with their times, and the truth where it is known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth

START_NS = 1_000_000_000
"""Stamp of the first image. Not 0, which many ROS programs take for "no time"."""


@dataclass(frozen=True, slots=True)
class Picture:
    """One image of the footage.

    Attributes
    ----------
    stamp_ns : int
        Its stamp in ns.
    frame : Frame
        Its pixels.
    name : str
        What to call it in an error.
    coded_format : str or None
        ``jpeg`` or ``png`` where it comes as such a file; else None.
    coded : bytes
        The bytes of that file.
    truth : Truth or None
        Where the vehicle is, if that is known.
    """

    stamp_ns: int
    frame: Frame
    name: str
    coded_format: str | None = None
    coded: bytes = b""
    truth: Truth | None = None


class Footage(Protocol):
    """A source of pictures: `total` of them as far as that is known, `fps` in each second."""

    fps: float
    total: int | None

    def pictures(self) -> Iterator[Picture]:
        """Yield the pictures in the order of time; raise `InputError` for one that is broken."""
        ...

    def notices(self) -> list[str]:
        """Tell what was not as it should be, after reading."""
        ...


def stamp_of(index: int, fps: float) -> int:
    """Return the stamp in ns of the picture `index` (from 0) at `fps` pictures per second."""
    return START_NS + round(index * 1e9 / fps)

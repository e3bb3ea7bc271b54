# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Decisions of `traffic` and of its detectors: constants that are tried at other values."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE

_PACKAGE = "vehicle_pf_tracker"


@dataclass(frozen=True, slots=True)
class Decision:
    """One constant that decides something.

    Attributes
    ----------
    place : str
        Module, in the package, and name: ``detection.blobs:_PIECE``; a field of an object after a
        dot.
    values : tuple of float
        Values to try beside the shipped one.
    without : float or None
        Value by which nothing is decided; None where there is none.
    is_of_scores : bool
        True where it decides by the scores of a network, which shapes have not.
    """

    place: str
    values: tuple[float, ...]
    without: float | None = None
    is_of_scores: bool = False

    def matters(self, boxes: str) -> bool:
        """Tell whether it decides anything with these boxes, ``motion`` or of a detector."""
        if self.place.startswith("detection."):
            return boxes == MOTION_SOURCE
        return boxes != MOTION_SOURCE or not self.is_of_scores

    def get(self) -> float:
        """Return the shipped value."""
        owner, name = self._owner()
        return float(getattr(owner, name))

    @contextmanager
    def at(self, value: float) -> Iterator[None]:
        """Decide by another value for a while."""
        owner, name = self._owner()
        shipped = getattr(owner, name)
        # Past the freezing of tables of constants, which only a laboratory may do.
        object.__setattr__(owner, name, type(shipped)(value))
        try:
            yield
        finally:
            object.__setattr__(owner, name, shipped)

    def _owner(self) -> tuple[object, str]:
        module, _, path = self.place.partition(":")
        owner: object = importlib.import_module(f"{_PACKAGE}.{module}")
        *parents, name = path.split(".")
        for parent in parents:
            owner = getattr(owner, parent)
        return owner, name


_MOTION = "detection.motion_thresholds:SHIPPED_THRESHOLDS"
FITTED_DECISIONS: tuple[Decision, ...] = (
    Decision(f"{_MOTION}.colour_threshold", (24.0, 42.0)),
    Decision(f"{_MOTION}.patience", (2.0, 8.0), 0.0),
    Decision(f"{_MOTION}.shadow", (0.5, 0.7), 1.0),
    Decision(f"{_MOTION}.apart", (0.5, 2.0), 1e9),
    Decision("detection.blobs:_LEAST_PART", (0.1, 0.2)),
    Decision("detection.blobs:_PIECE", (0.7, 0.9), 1e9),
    Decision("detection.blobs:_SPECK", (-3.0, -6.0), -1e9),
    Decision("trackers.traffic.first_state:_THIN", (0.3, 0.7), 0.0),
    Decision("trackers.traffic.correction:_WHOLE", (0.75, 0.95), 0.0),
    Decision("trackers.traffic.correction:_FOLLOWED", (0.15, 0.4)),
    Decision("trackers.traffic.existence:_SAID_OF_NOTHING", (3.0, 8.0), 1e9, True),
    Decision("trackers.traffic.existence:_SCORE_DOUBT", (0.3, 0.7), 0.0, True),
    Decision("trackers.traffic.misses:_MISSED", (0.15, 0.5)),
    Decision("trackers.traffic.parts:_REST_REACH", (0.25, 0.75), 0.0),
    Decision("trackers.traffic.parts:_LEAST_REST", (0.15, 0.5), 1e9),
    Decision("trackers.traffic.driving:_STRAIGHT_SHAPE", (14.0, 22.0), 7.0),
    Decision("trackers.traffic.parts:_INSIDE", (0.55, 0.85), 1e9),
    Decision("trackers.traffic.pixel_hold:_HELD_SHARE", (0.2, 0.45)),
)
"""Values that are tried, by parameter: a factor of about 1.4 apart, as fine as a clip can tell."""

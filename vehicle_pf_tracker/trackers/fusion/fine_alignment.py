"""Alignment of the estimate with the following template, as long as that fits as it used to."""

from __future__ import annotations

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.trackers.fusion.appearance import Aligned, Appearance
from vehicle_pf_tracker.trackers.fusion.view import View

_BAND = 0.06
"""Fall of the correlation below its level that is borne; from twice that on it is not trusted."""
_LEAST = 0.5
_RATE = 0.05
_SINKING_RATE = 0.02


class FineAlignment:
    """Trust in alignments, by the level of their correlation.

    A half-covered target still aligns, with what is left of it, and shrinks. Its correlation falls
    first.
    """

    def __init__(self) -> None:
        self._level: float | None = None

    def forget(self) -> None:
        """Begin a new level, since the looks have changed."""
        self._level = None

    def improve(
        self, appearance: Appearance, view: View, place: Position, scale: float, expected: float
    ) -> tuple[Position, float]:
        """Move a place (px) and scale towards their alignment, as far as it is trusted.

        `expected` is the scale that the motion foretells.
        """
        found = appearance.align(view, place, scale, expected)
        trust = self._trust(found)
        if found.coefficient <= _LEAST:
            return place, scale
        x, y = place
        better = x + trust * (found.place[0] - x), y + trust * (found.place[1] - y)
        return better, scale * (found.scale / scale) ** trust

    def _trust(self, found: Aligned) -> float:
        level = found.coefficient if self._level is None else self._level
        trust = min(max((found.coefficient - level) / _BAND + 2.0, 0.0), 1.0)
        if trust >= 1:
            self._level = level + _RATE * (found.coefficient - level)
        else:
            self._level = level + _SINKING_RATE * (max(found.coefficient, level - _RATE) - level)
        return trust

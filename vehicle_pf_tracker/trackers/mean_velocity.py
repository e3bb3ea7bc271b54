"""Mean velocity of the estimates, which gives P1 its principal motion direction."""

from __future__ import annotations

from collections import deque


class MeanVelocity:
    """Mean of the last displacements per nominal frame (P1, section III-B; READINGS 5).

    Parameters
    ----------
    window : int
        Number of displacements that count; 0 counts all.
    """

    def __init__(self, window: int) -> None:
        self._moves: deque[tuple[float, float, float]] = deque(maxlen=window or None)
        self._sum_x = self._sum_y = self._sum_elapsed = 0.0

    @property
    def value(self) -> tuple[float, float]:
        """Velocity in px per nominal frame; (0, 0) while nothing has moved in time."""
        if self._sum_elapsed <= 0:
            return 0.0, 0.0
        return self._sum_x / self._sum_elapsed, self._sum_y / self._sum_elapsed

    def add(self, before: tuple[float, float], after: tuple[float, float], elapsed: float) -> None:
        """Count the move from `before` to `after` in `elapsed` nominal frame periods."""
        move = after[0] - before[0], after[1] - before[1], elapsed
        if self._moves.maxlen is None:
            self._accumulate(move)
            return
        self._moves.append(move)
        # Summed afresh, since a running sum would gather rounding over months.
        self._sum_x = self._sum_y = self._sum_elapsed = 0.0
        for kept in self._moves:
            self._accumulate(kept)

    def resized(self, window: int) -> MeanVelocity:
        """Return the same history seen through another window."""
        other = MeanVelocity(window)
        other._moves.extend(self._moves)
        totals = list(self._moves) or [(self._sum_x, self._sum_y, self._sum_elapsed)]
        for move in totals[-window:] if window else totals:
            other._accumulate(move)
        return other

    def _accumulate(self, move: tuple[float, float, float]) -> None:
        self._sum_x += move[0]
        self._sum_y += move[1]
        self._sum_elapsed += move[2]

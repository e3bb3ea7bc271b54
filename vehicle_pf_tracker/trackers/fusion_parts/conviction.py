"""Whether what is followed still is the target: alike enough, and where its motion takes it.

An occluder that takes a target over is seldom unlike it at once. It is told by its motion: the
estimate falls behind the path that confident frames foretold, stops, or changes its size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from vehicle_pf_tracker.trackers.evidence import EvidenceParameters
from vehicle_pf_tracker.trackers.fusion_parts.appearance import Likeness
from vehicle_pf_tracker.trackers.fusion_parts.history import History

Place = tuple[float, float]

CERTAIN = 0.9
"""Share of the clear level above which looks leave no doubt."""
_FEWEST = 8
"""Sightings that a path is foretold from."""
_COLOURED = 0.85
_COLOURED_IN_TURNS = 0.6
"""A vehicle that turns fills less of its box."""
_OFF_PATH = 0.25
_OFF_PATH_COLOURED = 0.6
_OFF_PER_FRAME = 0.1
_STALLED = 0.45
_STALLED_AFTER = 2
_FLUENT = 0.85
_LAG = 0.03
_LAG_IN_TURNS = 0.7
"""A vehicle that turns leaves its path sideways; one that is being hidden falls behind on it."""
_LARGEST_GROWTH = 1.33
_SINKING = 0.25
_SETTLED = 10


class Levels:
    """Usual similarities in frames without doubt; they sink slowly, as occlusions make them."""

    def __init__(self) -> None:
        self.template = 0.0
        self.whole = 0.0
        self._frames = 0

    def follow(self, likeness: Likeness, rate: float) -> None:
        """Count a frame without doubt."""
        self._frames += 1
        rate = max(rate, 1.0 / self._frames)
        self.template += self._paced(rate, likeness.template - self.template)
        self.whole += self._paced(rate, likeness.whole - self.whole)

    def _paced(self, rate: float, change: float) -> float:
        sinks = change < 0 and self._frames > _SETTLED
        return (rate * _SINKING if sinks else rate) * change

    @property
    def empty(self) -> bool:
        """Whether there is no level to hold anything against."""
        return self._frames == 0

    def share(self, evidence: float) -> float:
        """Evidence as a share of its clear level, 0 to 1."""
        return min(evidence / self.template, 1.0) if self.template > 0 else evidence


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a frame's estimate is worth.

    Attributes
    ----------
    holds : bool
        Whether it is still the target.
    sure : bool
        Whether looks or smooth motion leave no doubt, so that it counts as a sighting.
    learns : bool
        Whether references may learn from it.
    fluent : bool
        Whether it looks different but keeps its colours and its speed, as in a turn.
    """

    holds: bool
    sure: bool = False
    learns: bool = False
    fluent: bool = False


class Conviction:
    """Judges the estimates of one track."""

    def __init__(self) -> None:
        self.levels = Levels()
        self.doubted = 0
        self._turning = False

    def judge(
        self,
        likeness: Likeness,
        place: Place,
        scale: float,
        history: History,
        size: float,
        parameters: EvidenceParameters,
        *,
        gate: bool,
    ) -> Verdict:
        """Judge the estimate `place` (px), `scale` of a target of `size` px at scale 1."""
        speed = history.follow(place)
        share = self.levels.share(likeness.evidence)
        if share < max(parameters.minimum, parameters.occluded_below):
            return Verdict(holds=False)
        alike = self.levels.empty or self.levels.share(likeness.template) >= CERTAIN
        if alike or self.levels.share(likeness.part) >= CERTAIN or len(history) < _FEWEST:
            self.doubted, self._turning = 0, False
            return Verdict(holds=True, sure=True, learns=alike)
        self.doubted += 1
        if not gate:
            return Verdict(holds=True)
        path, time = history.fit(size, retrospect=True, projective=True)
        expected, expected_scale = path.at(time)
        expected_speed = math.hypot(*path.velocity_at(time))
        coloured = likeness.colour > (_COLOURED_IN_TURNS if self._turning else _COLOURED)
        limit = (_OFF_PATH_COLOURED if coloured else _OFF_PATH) * size * scale + 1.0
        off = math.dist(expected, place) < limit + _OFF_PER_FRAME * expected_speed * self.doubted
        stalled = (
            speed < _STALLED * expected_speed
            and 4 * expected_speed > 0.1 * size * scale
            and self.doubted > _STALLED_AFTER
        )
        grown = max(scale / expected_scale, expected_scale / scale) > _LARGEST_GROWTH
        lag, aside = _offset(place, expected, path.velocity_at(time))
        keeps_up = lag < _LAG * size * scale + _LAG_IN_TURNS * aside
        fluent = self._turning = coloured and keeps_up and speed > _FLUENT * expected_speed
        holds = off and not stalled and not grown
        return Verdict(holds, sure=fluent, learns=fluent, fluent=fluent)


def _offset(place: Place, expected: Place, velocity: Place) -> tuple[float, float]:
    """How far `place` is behind and beside `expected`, seen along the motion, px."""
    speed = math.hypot(*velocity)
    if speed == 0:
        return 0.0, math.dist(place, expected)
    dx, dy = place[0] - expected[0], place[1] - expected[1]
    along = (dx * velocity[0] + dy * velocity[1]) / speed
    return -along, abs(dx * velocity[1] - dy * velocity[0]) / speed

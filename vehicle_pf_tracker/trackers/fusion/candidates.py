"""Places that a hidden target may have come back at, until one chain of them is proof enough."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, replace
from itertools import pairwise

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.history import carried

_KEPT = 24
_LARGEST_GAP = 2.0
"""Frame periods between two candidates of one chain."""
_SAME_SIZE = 0.2
"""Largest change of the logarithm of the size between two of them."""
_PLAUSIBLE_FRAMES = 5
_PLAUSIBLE_SHARE = 0.7
_LOOKS_ALONE_FRAMES = 12
_LOOKS_ALONE_SHARE = 0.8
_FAR_TAKES_LONGER = 5.0
"""Frames more, for each unit of distance beyond the first."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A place in px and a scale that look like the target, `age` frames ago.

    `strong` ones look as the target does in clear frames.
    """

    place: Position
    scale: float
    strong: bool
    age: float = 0.0


@dataclass(frozen=True, slots=True)
class Chain:
    """Candidates of successive frames that move smoothly.

    Attributes
    ----------
    links : tuple of Candidate
        From the first to that of the present frame, at least two.
    """

    links: tuple[Candidate, ...]

    @property
    def frames(self) -> int:
        """Number of candidates."""
        return len(self.links)

    @property
    def strong(self) -> float:
        """Share of strong ones among them."""
        return sum(one.strong for one in self.links) / len(self.links)

    @property
    def velocity(self) -> Position:
        """Their mean velocity, px per frame."""
        return _velocity(self.links[0], self.links[-1])

    def proves(self, expected: Position, tolerance: float, confirm: int, away: float = 0.0) -> bool:
        """Whether these are the target.

        One that moves as foretold is believed soon; one that is only plausible has to look right
        for longer, and one that moves against all expectation for longest.

        Parameters
        ----------
        expected : (float, float)
            Velocity that the target should have, px per frame.
        tolerance : float
            Difference from it that is within the noise, px per frame.
        confirm : int
            Frames needed at best.
        away : float
            Distance from the foretold place, in units of what may be expected. A twin drives on
            elsewhere as the target does: what is further away has to last until the target, if
            that is another one, would have come back.
        """
        if self.frames < confirm + _FAR_TAKES_LONGER * max(away - 1.0, 0.0):
            return False
        if math.dist(self.velocity, expected) < tolerance:
            return True
        if self.strong > _PLAUSIBLE_SHARE and self.frames >= _PLAUSIBLE_FRAMES:
            return _is_plausible(self.velocity, expected) or (
                self.strong > _LOOKS_ALONE_SHARE and self.frames >= _LOOKS_ALONE_FRAMES
            )
        return False


def _is_plausible(velocity: Position, expected: Position) -> bool:
    """Whether a vehicle may have braked, sped up or swerved that far."""
    speed = math.hypot(*expected)
    if speed < 1:
        return True
    along = (velocity[0] * expected[0] + velocity[1] * expected[1]) / speed
    across = abs(velocity[0] * expected[1] - velocity[1] * expected[0]) / speed
    return 0.3 * speed < along < 2 * speed and across < 0.6 * speed


class Candidates:
    """The latest candidates, one of a frame at most."""

    def __init__(self) -> None:
        self._all: deque[Candidate] = deque(maxlen=_KEPT)

    def age(self, elapsed: float, motion: CameraMotion) -> None:
        """Let `elapsed` frames pass in which the camera made `motion`."""
        for index, one in enumerate(self._all):
            place = one.place if motion.still else carried(one.place, motion)
            self._all[index] = replace(
                one, place=place, scale=one.scale * motion.scale, age=one.age + elapsed
            )

    def add(self, found: Candidate) -> None:
        """Keep what was found in this frame."""
        self._all.append(found)

    def chain(self, size: float) -> Chain | None:
        """Link the newest candidates; `size` is the target's in px.

        None where this frame has no candidate, or none before it that it agrees with.
        """
        newest_first = list(reversed(self._all))
        if not newest_first or newest_first[0].age > 0:
            return None
        chain = newest_first[:1]
        for later, earlier in pairwise(newest_first):
            if not _agree(chain, later, earlier, size):
                break
            chain.append(earlier)
        return Chain(tuple(reversed(chain))) if len(chain) > 1 else None


def _agree(chain: list[Candidate], later: Candidate, earlier: Candidate, size: float) -> bool:
    """Whether `earlier` continues the chain backwards."""
    if not 0 < earlier.age - later.age <= _LARGEST_GAP:
        return False
    if abs(math.log(later.scale / earlier.scale)) > _SAME_SIZE:
        return False
    if len(chain) < 2:
        return True
    reference = _velocity(chain[-1], chain[0])
    off = math.dist(_velocity(earlier, later), reference)
    return off <= max(2.0, 0.08 * size, 0.5 * math.hypot(*reference))


def _velocity(earlier: Candidate, later: Candidate) -> Position:
    time = earlier.age - later.age
    return (
        (later.place[0] - earlier.place[0]) / time,
        (later.place[1] - earlier.place[1]) / time,
    )

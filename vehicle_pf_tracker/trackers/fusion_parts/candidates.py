"""Places that a hidden target may have come back at, followed until one of them is certain."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from vehicle_pf_tracker.features.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion_parts.history import carried

Place = tuple[float, float]

_FAR_TAKES_LONGER = 0.5
_FAR_MUST_BE_MORE_ALIKE = 0.04
_SAME_SIZE = 0.3
"""Largest change of the logarithm of the size from frame to frame."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A place that has looked like the target for some frames.

    Attributes
    ----------
    place, origin : (float, float)
        Now, and where it was found first, px.
    scale : float
        Relative to the first box.
    share : float
        Running similarity, of the clear level.
    frames : int
        How many it has been followed for.
    time : float
        The same in frame periods.
    """

    place: Place
    origin: Place
    scale: float
    share: float
    frames: int = 1
    time: float = 0.0

    @property
    def velocity(self) -> Place | None:
        """Mean velocity since it was found, px per frame; None at first."""
        if self.time <= 0:
            return None
        return (
            (self.place[0] - self.origin[0]) / self.time,
            (self.place[1] - self.origin[1]) / self.time,
        )

    def carried(self, motion: CameraMotion) -> Candidate:
        """Take it along with the background."""
        return replace(
            self,
            place=carried(self.place, motion),
            origin=carried(self.origin, motion),
            scale=self.scale * motion.scale,
        )

    def is_certain(self, expected: Place, uncertainty: float, confirm: int, least: float) -> bool:
        """Whether it may be taken for the target.

        Parameters
        ----------
        expected : (float, float)
            Where the target should be, px.
        uncertainty : float
            Of that, px: further away it has to be more alike, and for longer.
        confirm : int
            Frames that it has to be followed for at the expected place.
        least : float
            Share of the clear level that it has to reach there.
        """
        away = math.dist(self.place, expected) / uncertainty
        return (
            self.frames >= confirm * (1 + _FAR_TAKES_LONGER * away)
            and self.share >= least + _FAR_MUST_BE_MORE_ALIKE * away
        )


class Candidates:
    """All that are followed at present."""

    def __init__(self) -> None:
        self._all: list[Candidate] = []

    def carry(self, motion: CameraMotion) -> None:
        """Take them along with the background."""
        self._all = [one.carried(motion) for one in self._all]

    def follow(
        self, found: list[Candidate], velocity: Place, elapsed: float, size: float
    ) -> list[Candidate]:
        """Link what was found in this frame to the candidates of the last one.

        Parameters
        ----------
        found : list of Candidate
            Places alike enough in this frame.
        velocity : (float, float)
            That the target should have, px per frame: what moves otherwise is none.
        elapsed : float
            Frames since the last one.
        size : float
            Of the target, px.

        Returns
        -------
        list of Candidate
            All that are followed now.
        """
        linked = (self._link(one, velocity, elapsed, size) for one in found)
        self._all = [one for one in linked if one is not None]
        return self._all

    def _link(
        self, found: Candidate, velocity: Place, elapsed: float, size: float
    ) -> Candidate | None:
        speed = math.hypot(*velocity)
        near = 0.12 * size + 0.5 * speed * elapsed + 1
        before = [
            one
            for one in self._all
            if math.dist(found.place, _along(one.place, velocity, elapsed)) < near
            and abs(math.log(found.scale / one.scale)) < _SAME_SIZE
        ]
        if not before:
            return found
        best = max(before, key=lambda one: one.frames)
        time = best.time + elapsed
        off = math.dist(found.place, _along(best.origin, velocity, time))
        if off > 0.5 * speed * time + 0.1 * size + 1:
            return None
        return Candidate(
            found.place, best.origin, found.scale, 0.5 * (best.share + found.share),
            best.frames + 1, time,
        )  # fmt: skip


def _along(place: Place, velocity: Place, time: float) -> Place:
    return place[0] + velocity[0] * time, place[1] + velocity[1] * time

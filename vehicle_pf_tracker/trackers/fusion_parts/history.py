"""Where the target was seen, in px of the present frame."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.features.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion_parts.projective_motion import ProjectiveMotion, fit_motion

Place = tuple[float, float]

_KEPT = 30
_FITTED = 26
"""Latest sightings that a motion is fitted to."""
_DISTRUSTED = 4
"""Latest sightings that are left out in retrospect: an occluder may have dragged them along."""
_TRAIL = 5


@dataclass(frozen=True, slots=True)
class Sighting:
    """Place in px and scale of the target, `age` frames ago."""

    place: Place
    scale: float
    age: float = 0.0


def carried(place: Place, motion: CameraMotion) -> Place:
    """Take a place along with the background."""
    x, y = motion.apply(np.array(place)).tolist()
    return x, y


class History:
    """The last confident sightings, and the trail of all last estimates."""

    def __init__(self) -> None:
        self._sightings: deque[Sighting] = deque(maxlen=_KEPT)
        self._trail: deque[Sighting] = deque(maxlen=_TRAIL)

    def __len__(self) -> int:
        return len(self._sightings)

    def age(self, elapsed: float, motion: CameraMotion) -> None:
        """Let `elapsed` frames pass in which the camera made `motion`."""
        for kept in (self._sightings, self._trail):
            for index, one in enumerate(kept):
                kept[index] = Sighting(
                    carried(one.place, motion), one.scale * motion.scale, one.age + elapsed
                )

    def see(self, place: Place, scale: float) -> None:
        """Keep a confident sighting of this frame."""
        self._sightings.append(Sighting(place, scale))

    def forget_all_but(self, count: int) -> None:
        """Keep the latest `count` sightings only: the motion has changed."""
        while len(self._sightings) > count:
            self._sightings.popleft()

    def follow(self, place: Place) -> float:
        """Keep an estimate of this frame; returns the speed over the last few, px per frame."""
        self._trail.append(Sighting(place, 1.0))
        first = self._trail[0]
        return math.dist(first.place, place) / first.age if first.age > 0 else 0.0

    def fit(
        self, size: float, *, retrospect: bool, projective: bool
    ) -> tuple[ProjectiveMotion, float]:
        """Fit a motion to the sightings.

        Parameters
        ----------
        size : float
            Of the target at scale 1, px.
        retrospect : bool
            Leave the latest ones out.
        projective : bool
            Let the size change.

        Returns
        -------
        motion : ProjectiveMotion
            With time 0 at the last sighting that it was fitted to.
        time : float
            Frames since then.
        """
        sightings = list(self._sightings)[-_FITTED:]
        if retrospect and len(sightings) > 2 * _DISTRUSTED:
            sightings = sightings[:-_DISTRUSTED]
        last = sightings[-1].age
        motion = fit_motion(
            np.array([last - one.age for one in sightings]),
            np.array([one.place for one in sightings]),
            np.array([one.scale for one in sightings]),
            size,
            projective=projective,
        )
        return motion, last

    def restarted(self, sighting: Sighting) -> History:
        """Begin anew from one sighting."""
        other = History()
        other._sightings.append(replace(sighting))
        return other

"""Where the target was seen, in px of the present frame, and where that leads."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.projective_motion import ProjectiveMotion, fit_motion

_KEPT = 80
_FITTED = 24
"""Latest sightings that a motion is fitted to."""
_FEWEST = 4
_GROWTH_OVER = 12
_GROWTH_NEEDS = 8
_LARGEST_GROWTH = 0.03
_GROWTH_GAIN = 0.8
"""Of a measured growth, what is believed: it is noisy."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """Place in px of the present frame and scale of the target, and when it was seen, in frames."""

    place: Position
    scale: float
    time: float


@dataclass(frozen=True, slots=True)
class Trend:
    """A motion, and how long ago in frames its time 0 was."""

    motion: ProjectiveMotion
    age: float

    @classmethod
    def still(cls, place: Position, scale: float) -> Trend:
        """Stay where it is, since nothing better is known."""
        return cls(ProjectiveMotion(place, (0.0, 0.0), scale, 0.0), 0.0)

    def now(self) -> tuple[Position, float]:
        """Place in px and scale in the present frame."""
        return self.motion.at(self.age)

    def velocity(self) -> Position:
        """Velocity in the present frame, px per frame."""
        return self.motion.velocity_at(self.age)

    def after(self, elapsed: float) -> Trend:
        """Let `elapsed` frames pass."""
        return Trend(self.motion, self.age + elapsed)

    def carried(self, motion: CameraMotion) -> Trend:
        """Take it along with the background."""
        return Trend(self.motion.moved(motion.shift, motion.scale), self.age)


def carried(place: Position, motion: CameraMotion) -> Position:
    """Take a place along with the background."""
    x, y = motion.apply(np.array(place)).tolist()
    return x, y


class History:
    """The last confident sightings.

    Parameters
    ----------
    size : float
        Of the target at scale 1, px.
    """

    def __init__(self, size: float) -> None:
        self._size = size
        self._now = 0.0
        self._sightings: deque[Sighting] = deque(maxlen=_KEPT)

    def age(self, elapsed: float, motion: CameraMotion) -> None:
        """Let `elapsed` frames pass in which the camera made `motion`."""
        self._now += elapsed
        if motion.still:
            return
        for index, one in enumerate(self._sightings):
            place = carried(one.place, motion)
            self._sightings[index] = Sighting(place, one.scale * motion.scale, one.time)

    def see(self, place: Position, scale: float, age: float = 0.0) -> None:
        """Keep a confident sighting, of this frame or of one `age` frames ago."""
        self._sightings.append(Sighting(place, scale, self._now - age))

    def keep(self, count: int) -> None:
        """Forget all but the latest `count` sightings."""
        while len(self._sightings) > count:
            self._sightings.popleft()

    def reshape(self, size: float) -> None:
        """Count scales from a box of another size on, px."""
        self._size = size
        for index, one in enumerate(self._sightings):
            self._sightings[index] = Sighting(one.place, 1.0, one.time)

    def trend(self, before: float, *, projective: bool, unsized: float = 0.0) -> Trend | None:
        """Fit a motion to the sightings that are at least `before` frames old.

        Parameters
        ----------
        before : float
            In frames.
        projective : bool
            Let the size change.
        unsized : float
            Frames before the last sighting in which sizes are not believed.

        Returns
        -------
        Trend or None
            None where these are too few.
        """
        chosen = [one for one in self._sightings if self._now - one.time >= before][-_FITTED:]
        if len(chosen) < _FEWEST:
            return None
        last = chosen[-1].time
        motion = fit_motion(
            np.array([one.time - last for one in chosen]),
            np.array([one.place for one in chosen]),
            np.array([one.scale for one in chosen]),
            self._size,
            projective=projective,
            sized_until=self._sightings[-1].time - last - unsized,
        )
        return Trend(motion, self._now - last)

    def growth(self) -> float:
        """Rate at which the logarithm of the scale changed lately, per frame."""
        latest = list(self._sightings)[-_GROWTH_OVER:]
        if len(latest) < _GROWTH_NEEDS:
            return 0.0
        times = np.array([one.time for one in latest])
        times -= times.mean()
        logs = np.log([one.scale for one in latest])
        slope = float(times @ logs) / max(float(times @ times), 1e-9)
        return _GROWTH_GAIN * min(max(slope, -_LARGEST_GROWTH), _LARGEST_GROWTH)

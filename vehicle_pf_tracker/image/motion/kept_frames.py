# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames of a standing camera, as they are: the latest ones, and those of the background.

They are carried along with a camera that sways, and discarded when it moves.
"""

from __future__ import annotations

import itertools
from collections import deque
from typing import NamedTuple

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.carried_grey import CarriedGrey
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

_KEPT_EVERY = 4
"""Frames between two that are kept for the background: those in a row show the same vehicles. With
`_FRAMES_KEPT` two seconds at 30 Hz."""
_LARGEST_SPACING = 16
"""The same for the outline of the vehicle itself once the camera has stood for long: of two seconds
a slow one takes most for its length, and becomes a part of the background; of eight it does not.
Chosen on scene `turn`, where a lorry of 69 px at 2 px per frame takes 35 frames of 60. What else
moves stays with two seconds: with eight 15 of 17 painted signs are recovered from, instead of 16
(laboratory/notes/fusion_tried.md)."""
_FRAMES_KEPT = 15
"""Frames that a background is the median of: a vehicle that moves by its length within half of
their time is no part of it."""
_FEWEST_FRAMES = 6
"""Frames below which there is no background yet, a choice: the median of six is wrong only where
three of them show vehicles."""
_LATEST = 24
"""Latest frames kept besides, 0.8 s at 30 Hz: outlines of just before a doubt are what later ones
are compared with, and where a turn is slow the last clear sighting is 15 frames old by then (scene
`turn` at 2 px per frame, on which it was chosen)."""


class Kept(NamedTuple):
    """A frame, and the frame periods from the first one to it."""

    grey: CarriedGrey
    time: float


class KeptFrames:
    """Frames that a standing camera has shown.

    Attributes
    ----------
    spread : deque of Kept
        Those of the last two seconds, at equal distances.
    lasting : deque of Kept
        Those of up to eight seconds, at equal distances.
    latest : deque of Kept
        The latest in a row.
    number : int
        Number of frames since the camera has moved.
    """

    def __init__(self) -> None:
        self.spread: deque[Kept] = deque(maxlen=_FRAMES_KEPT)
        self.lasting: deque[Kept] = deque(maxlen=_FRAMES_KEPT)
        self.latest: deque[Kept] = deque(maxlen=_LATEST)
        self.number = 0
        self._spacing = _KEPT_EVERY
        self._time = 0.0

    def keep(self, small: SmallGrey, camera: CameraMotion, elapsed: float, *, stands: bool) -> None:
        """Keep a frame; see `Foreground.keep`."""
        self._time += elapsed
        # A background of another view is worse than none.
        if not stands or (self.latest and self.present.image.shape != small.image.shape):
            self.spread.clear()
            self.lasting.clear()
            self.latest.clear()
            self.number = 0
            self._spacing = _KEPT_EVERY
        elif not camera.still:
            # Most frames are kept in several places.
            for grey in {each.grey for each in (*self.spread, *self.lasting, *self.latest)}:
                grey.carry(camera)
        kept = Kept(CarriedGrey(small), self._time)
        # Frames in a row show the same vehicles: those farther apart separate road from traffic.
        if self.number % _KEPT_EVERY == 0:
            self.spread.append(kept)
        if self.number % self._spacing == 0:
            self.lasting.append(kept)
            self._spread_out()
        self.latest.append(kept)
        self.number += 1

    def _spread_out(self) -> None:
        """Once all places are taken, go on with every second frame, so that they last longer."""
        if len(self.lasting) == _FRAMES_KEPT and self._spacing < _LARGEST_SPACING:
            self.lasting = deque(list(self.lasting)[::2], maxlen=_FRAMES_KEPT)
            self._spacing *= 2

    @property
    def are_enough(self) -> bool:
        """True once they show a background."""
        return len(self.spread) >= _FEWEST_FRAMES

    @property
    def present(self) -> SmallGrey:
        """The latest frame."""
        return self.latest[-1].grey.small

    def age(self, kept: Kept) -> float:
        """Frame periods from a kept frame to the latest."""
        return self._time - kept.time

    def periods_since(self, age: float) -> list[float] | None:
        """Periods from each of the latest frames to the next, from the one of this age on.

        Oldest first; None where that one is no longer kept.
        """
        # Where frames were dropped there are fewer of them than periods have passed.
        times = [each.time for each in self.latest]
        wanted = self._time - age
        if wanted < times[0] - 0.5:
            return None
        first = min(range(len(times)), key=lambda number: abs(times[number] - wanted))
        return [after - before for before, after in itertools.pairwise(times[first:])]

# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The turning branch: in doubt, a vehicle that leaves its path is followed by its outline.

In a fast turn response and points end as they do behind an occluder, and the track is frozen and
predicted straight on. Beside it the outline of what moves is followed. Where an occluder stands the
outline is cut from one side, and where one drives by it becomes larger at once; only a vehicle that
turns moves as a whole to one side of the predicted path.

One that was hidden as a whole is followed the same way where it comes out beside its path
(`emergence.py`). Outlines are found before a standing camera.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.camera_motion import SmallGrey
from vehicle_pf_tracker.image.foreground import Foreground, Outline
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.emergence import Emergence
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sighting,
)

_ASIDE = 0.15
"""Distance of both sides from the predicted path, of the size, that proves a turn."""
_ACROSS = 0.25
"""Velocity to that side, of the speed: that of a heading changed by 15 degrees. What a wall leaves
of an outline may lie aside, but it does not move there."""
_CONFIRMED = 2
"""Frames in a row that prove it: single outlines jump with the noise at their rim."""
_LARGEST_LOG_CHANGE = np.log(1.3)
"""Largest change of a side's logarithm in a frame; a merged outline changes by more."""
_LEAST_COVERED, _MOST_COVERED = 0.6, 2.0
"""Area of the outline in the last clear sighting, of the box, between which it is the vehicle's."""
_FURTHEST = 40.0
"""Frames after the doubt began within which a turn is proven."""
_CALM = 8
"""Clear frames after which the turn is over."""
_VELOCITY_GAIN = 0.3


class Turned(NamedTuple):
    """The vehicle in a turn.

    Attributes
    ----------
    position, size : (2,) arrays
        Centre, and width and height, px.
    velocity : (2,) array
        px per frame.
    """

    position: Array
    size: Array
    velocity: Array


@dataclass(slots=True, eq=False)
class _Branch:
    """State since the doubt began."""

    motion: PerspectiveMotion
    size: Array
    margins: tuple[Array, Array]
    outline: Outline
    velocity: Array
    age: float
    aside: int = 0
    proven: bool = False
    calm: int = 0


Unlike = Callable[[Array, Array], float]


class TurningBranch:
    """Follows outlines while the vehicle is in doubt."""

    def __init__(self) -> None:
        self._foreground = Foreground()
        self._branch: _Branch | None = None
        self._emergence: Emergence | None = None

    @property
    def can_begin(self) -> bool:
        """True where outlines can be seen: before a camera that has stood for a while."""
        return self._foreground.is_known

    def keep(self, small: SmallGrey, *, still: bool) -> None:
        """Take the next frame; a camera that moves ends the branch."""
        self._foreground.keep(small, still=still)
        if not self.can_begin:
            self._branch = self._emergence = None

    def begin(self, motion: PerspectiveMotion, last: Sighting) -> None:
        """Begin where the vehicle was last seen clearly, of which `last.age` frames passed."""
        self._branch = self._emergence = None
        if self.can_begin:
            earlier, image_size = self._foreground.history(), self._foreground.extent
            self._emergence = Emergence(last, motion, image_size, earlier)
        ago = round(last.age)
        first = self._foreground.outline(last.position, last.size, ago)
        if first is None:
            return
        covered = float(first.size.prod() / last.size.prod())
        if not _LEAST_COVERED < covered < _MOST_COVERED:
            return
        half = last.size / 2
        margins = (
            (first.low - (last.position - half)) / last.size,
            (first.high - (last.position + half)) / last.size,
        )
        self._branch = _Branch(motion, last.size, margins, first, motion.velocity, 0.0)
        for back in range(ago - 1, -1, -1):
            self._step(1.0, back)

    def follow(self, elapsed: float, view: View, unlike: Unlike) -> Turned | None:
        """Follow the outline into the present frame; give the vehicle once it is proven to turn.

        Parameters
        ----------
        view : View
            Tells when the filter has long recognised the vehicle again, which ends the branch.
        unlike : callable
            Difference of the paint in a box of a size and position, px, from the vehicle's.
        """
        self._step(elapsed, 0)
        emerged = self._emerged(elapsed, unlike)
        branch = self._branch = self._branch or emerged
        if branch is None:
            return None
        position, size = _box(branch.outline, branch.margins)
        branch.aside = branch.aside + 1 if _leaves(branch, position, size) else 0
        branch.proven |= branch.aside >= _CONFIRMED
        if branch.proven:
            self._emergence = None
            branch.calm = branch.calm + 1 if view.at(position) > CLEAR_RESPONSE else 0
        if branch.calm > _CALM or (not branch.proven and branch.age > _FURTHEST):
            self._branch = None
            return None
        return Turned(position, size, branch.velocity) if branch.proven else None

    def _emerged(self, elapsed: float, unlike: Unlike) -> _Branch | None:
        """Find a vehicle that has come out beside its path."""
        emergence = self._emergence
        if emergence is None or not emergence.is_alone:
            return None
        found = emergence.step(self._foreground.boxes(), elapsed)
        if found is None:
            return None
        outline, velocity, margins = Outline(*found[0]), found[1], (np.zeros(2), np.zeros(2))
        if not emergence.has_paint(unlike(outline.size, outline.centre)):
            return None
        return _Branch(emergence.motion, outline.size, margins, outline, velocity, 0.0, proven=True)

    def end(self) -> None:
        """End the branch: the vehicle was found another way."""
        self._branch = self._emergence = None

    def _step(self, elapsed: float, ago: int) -> None:
        branch = self._branch
        if branch is None:
            return
        before = branch.outline
        branch.age += elapsed
        centre = before.centre + branch.velocity * elapsed
        after = self._foreground.outline(centre, before.size, ago)
        if after is None or np.abs(np.log(after.size / before.size)).max() > _LARGEST_LOG_CHANGE:
            self._branch = None
            return
        if elapsed:
            moved = (after.centre - before.centre) / elapsed
            branch.velocity = branch.velocity + _VELOCITY_GAIN * (moved - branch.velocity)
        branch.outline = after


def _leaves(branch: _Branch, position: Array, size: Array) -> bool:
    """Test whether a box is, and moves, to one side of the predicted one."""
    velocity = branch.motion.velocity_at(branch.age)
    speed = float(np.hypot(*velocity))
    if not speed:
        return False
    normal = np.array([-velocity[1], velocity[0]]) / speed
    predicted = branch.size * branch.motion.scale_at(branch.age)
    off = float((position - branch.motion.position_at(branch.age)) @ normal)
    wider = float(np.abs(normal) @ (size - predicted)) / 2
    aside = (abs(off) - abs(wider)) / float(np.sqrt(predicted.prod()))
    return aside > _ASIDE and float(branch.velocity @ normal) * np.sign(off) > _ACROSS * speed


def _box(outline: Outline, margins: tuple[Array, Array]) -> tuple[Array, Array]:
    """Centre and size of the box that an outline belongs to."""
    size = outline.size / (1 + margins[1] - margins[0])
    return outline.low - margins[0] * size + size / 2, size

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

Outlines are found before a standing camera. Nothing is computed before it is asked for: frames are
kept as they are, and their median around the vehicle is the background.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.camera_motion import SmallGrey
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.perspective import (
    CLEAR_RESPONSE,
    PerspectiveMotion,
    Sighting,
)

_KEPT_EVERY = 4
"""Frames between two that are kept for the background."""
_KEPT = 15
"""Frames that the background is the median of: two seconds, of which a vehicle that moves by its
length within one hides less than half."""
_FEWEST = 6
"""Frames below which there is no background yet."""
_LATEST = 12
"""Frames kept besides: outlines of just before a doubt are what later ones are compared with."""
_AROUND = 1.5
"""Half sides of the neighbourhood, of the box's longer side."""
_LEAST_CONTRAST, _NOISE_FACTOR = 12.0, 4.0
"""Difference in grey levels from which a pixel is foreground: at least that of a shadow's rim, and
so many times the median difference around."""
_GROWN = 1.3
"""Size of the box, of itself, whose inside an outline has mostly to lie in."""
_LEAST_PIECE = 4
"""Area in px below which a connected piece is noise."""


class Outline(NamedTuple):
    """Bounding box of what moves.

    Attributes
    ----------
    low, high : (2,) arrays
        Left and upper, right and lower side, px.
    """

    low: Array
    high: Array

    @property
    def centre(self) -> Array:
        """Centre, px."""
        return np.asarray((self.low + self.high) / 2)

    @property
    def size(self) -> Array:
        """Width and height, px."""
        return np.asarray(self.high - self.low)


class Foreground:
    """Keeps frames of a camera that stands."""

    def __init__(self) -> None:
        self._background: deque[SmallGrey] = deque(maxlen=_KEPT)
        self._latest: deque[SmallGrey] = deque(maxlen=_LATEST)
        self._frames = 0

    def keep(self, small: SmallGrey, *, still: bool) -> None:
        """Keep a frame; all earlier ones are discarded if the camera has moved."""
        if not still:
            self._background.clear()
            self._latest.clear()
            self._frames = 0
        if self._frames % _KEPT_EVERY == 0:
            self._background.append(small)
        self._latest.append(small)
        self._frames += 1

    @property
    def is_known(self) -> bool:
        """True once the background has been seen for long enough, by a camera that stands."""
        return len(self._background) >= _FEWEST

    def outline(self, centre: Array, size: Array, ago: int = 0) -> Outline | None:
        """Outline of what moves in a box of this centre and size, px, some frames `ago`.

        None where there is no background, nothing moves, or it reaches out of the neighbourhood.
        """
        if not self.is_known or ago >= len(self._latest):
            return None
        small = self._latest[-1 - ago]
        if any(each.image.shape != small.image.shape for each in self._background):
            return None
        rows, columns, corner = _neighbourhood(small, centre, size)
        piece = small.image[rows, columns]
        if min(piece.shape) < 3:
            return None
        usual = median([each.image[rows, columns] for each in self._background])
        change = cv2.absdiff(piece, usual)
        level = max(_LEAST_CONTRAST, _NOISE_FACTOR * float(np.median(change)))
        moving = (cv2.GaussianBlur(change, (3, 3), 0) > level).astype(np.uint8)
        closed = cv2.morphologyEx(moving, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
        inner = centre * small.zoom - corner
        bounds = _bounds(np.asarray(closed, np.uint8), inner, size * small.zoom)
        if bounds is None:
            return None
        low, high = bounds
        return Outline((low + corner) / small.zoom, (high + corner) / small.zoom)


def median(images: list[npt.NDArray[np.uint8]]) -> npt.NDArray[np.uint8]:
    """Upper median, pixel by pixel.

    Sorted by exchanges of whole images (odd-even transposition), which takes a tenth of the time of
    sorting the values of each pixel.
    """
    images = images.copy()
    for turn in range(len(images)):
        for first in range(turn % 2, len(images) - 1, 2):
            pair = images[first], images[first + 1]
            images[first], images[first + 1] = np.minimum(*pair), np.maximum(*pair)
    return np.ascontiguousarray(images[len(images) // 2])


def _neighbourhood(small: SmallGrey, centre: Array, size: Array) -> tuple[slice, slice, Array]:
    """Rows and columns of the reduced frame around a box, and the first of them as x and y."""
    height, width = small.image.shape
    half = _AROUND * float(size.max()) * small.zoom
    low = np.clip(np.floor(centre * small.zoom - half), 0, (width, height)).astype(int)
    high = np.clip(np.ceil(centre * small.zoom + half), 0, (width, height)).astype(int)
    return slice(int(low[1]), int(high[1])), slice(int(low[0]), int(high[0])), low.astype(float)


def _bounds(
    moving: npt.NDArray[np.uint8], centre: Array, size: Array
) -> tuple[Array, Array] | None:
    """Bounds of the connected pieces that lie mostly in a box; None where they touch the rim."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(moving)
    shape, half = np.array(moving.shape[::-1]), _GROWN * size / 2
    box = np.clip([centre - half, centre + half], 0, shape).astype(int)
    inside = np.bincount(
        labels[box[0, 1] : box[1, 1], box[0, 0] : box[1, 0]].ravel(), minlength=count
    )
    areas = stats[:, cv2.CC_STAT_AREA]
    own = (areas >= _LEAST_PIECE) & (inside >= 0.5 * areas)
    own[0] = False  # the background
    if not own.any():
        return None
    low = stats[own, :2].min(axis=0)
    high = (stats[own, :2] + stats[own, 2:4]).max(axis=0)
    touches = (low <= 0).any() or (high >= shape).any()
    return None if touches else (low.astype(float), high.astype(float))


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


class TurningBranch:
    """Follows outlines while the vehicle is in doubt."""

    def __init__(self) -> None:
        self._foreground = Foreground()
        self._branch: _Branch | None = None

    @property
    def can_begin(self) -> bool:
        """True where outlines can be seen: before a camera that has stood for a while."""
        return self._foreground.is_known

    def keep(self, small: SmallGrey, *, still: bool) -> None:
        """Take the next frame; a camera that moves ends the branch."""
        self._foreground.keep(small, still=still)
        if not still:
            self._branch = None

    def begin(self, motion: PerspectiveMotion, last: Sighting) -> None:
        """Begin where the vehicle was last seen clearly, of which `last.age` frames passed."""
        self._branch = None
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

    def follow(self, elapsed: float, view: View) -> Turned | None:
        """Follow the outline into the present frame; give the vehicle once it is proven to turn.

        `view` tells when the filter has long recognised the vehicle again, which ends the branch.
        """
        self._step(elapsed, 0)
        branch = self._branch
        if branch is None:
            return None
        position, size = _box(branch.outline, branch.margins)
        branch.aside = branch.aside + 1 if _leaves(branch, position, size) else 0
        branch.proven |= branch.aside >= _CONFIRMED
        if branch.proven:
            branch.calm = branch.calm + 1 if view.at(position) > CLEAR_RESPONSE else 0
        if branch.calm > _CALM or (not branch.proven and branch.age > _FURTHEST):
            self._branch = None
            return None
        return Turned(position, size, branch.velocity) if branch.proven else None

    def end(self) -> None:
        """End the branch: the vehicle was found another way."""
        self._branch = None

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

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

"""A scene: actors on paths in front of a backdrop, seen by a camera, with exact truth."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.scenes.compositing import (
    Image,
    PixelWindow,
    Sprite,
    overlap,
    paint,
    visible_fraction,
)
from vehicle_pf_tracker.scenes.paths import Path

FIRST_STAMP_NS = 1_000_000_000
"""Stamp of frame 0: a stamp of zero means "unknown" to many tools."""


Look: TypeAlias = Callable[[float], Sprite]
"""Sprite by frame number, of an actor whose appearance changes (by turning)."""


class Eye(Protocol):
    """Interface of the cameras in module `cameras`."""

    def offset(self, index: int) -> tuple[float, float]:
        """Return the image's top-left corner on the stage in frame `index`, px."""
        ...

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed stage of frame `index` into an 8-bit frame; may alter `picture`."""
        ...


@dataclass(frozen=True, slots=True)
class SceneFrame:
    """One frame of a scene and the truth about its target."""

    frame: Frame
    truth: Truth


@dataclass(frozen=True, slots=True)
class Actor:
    """A sprite on a path.

    Attributes
    ----------
    sprite : Sprite or Look
        Appearance, constant or by frame number.
    path : Path
        The box it fills on the stage, by frame number.
    hides : bool
        False for what darkens or tints without hiding, such as shadows.
    """

    sprite: Sprite | Look
    path: Path
    hides: bool = True

    def seen(self, frame: float) -> Sprite:
        """Give the sprite it shows in `frame`."""
        return self.sprite if isinstance(self.sprite, Sprite) else self.sprite(frame)


@dataclass(frozen=True, slots=True)
class Scene:
    """Synthetic traffic; the same scene, parameters and seed give bit-identical frames.

    Things are placed on a stage, which the backdrop fills. The image is the part of it that the
    camera shows, and moves with the camera; truth is in coordinates of the image.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    width, height : int
        Image size in px.
    frame_rate : float
        Frames per second.
    frame_count : int
        Number of frames.
    backdrop : callable
        Draws what never moves and hides nothing; called once per pass over the frames.
    actors : tuple of Actor
        All actors in painting order, far to near.
    target : int
        Index in `actors` of the vehicle the truth is about.
    camera : Eye
        Takes the picture.
    """

    name: str
    width: int
    height: int
    frame_rate: float
    frame_count: int
    backdrop: Callable[[], Image]
    actors: tuple[Actor, ...]
    target: int
    camera: Eye

    def frames(self) -> Iterator[SceneFrame]:
        """Render every frame in order, with its truth."""
        backdrop = self.backdrop()
        for index in range(self.frame_count):
            picture = backdrop.copy()
            for actor in self.actors:
                box = actor.path(index)
                if not PixelWindow.of(box, picture.shape[1], picture.shape[0]).empty:
                    paint(picture, actor.seen(index), box)
            yield SceneFrame(self.camera.capture(picture, index), self.truth(index))

    def truths(self) -> Iterator[Truth]:
        """Give the truth of every frame, as `frames` does, without rendering a pixel."""
        return map(self.truth, range(self.frame_count))

    def truth(self, index: int) -> Truth:
        """Exact truth of frame `index`, counted from 0."""
        box = self._in_image(self.actors[self.target].path(index), index)
        visible = self._visible_fraction(index, box)
        return Truth(self.stamp_ns(index), box, Occlusion.of(visible), visible)

    def stamp_ns(self, index: int) -> int:
        """Stamp of frame `index`: 1 s, and one period more for each frame, to the nearest ns."""
        return FIRST_STAMP_NS + round(index * 1e9 / self.frame_rate)

    def _visible_fraction(self, index: int, box: Box) -> float:
        covers = (
            (actor.seen(index), place)
            for actor in self.actors[self.target + 1 :]
            if actor.hides and overlap(place := self._in_image(actor.path(index), index), box)
        )
        target = (self.actors[self.target].seen(index), box)
        return visible_fraction(target, covers, self.width, self.height)

    def _in_image(self, box: Box, index: int) -> Box:
        left, top = self.camera.offset(index)
        return Box(box.x - left, box.y - top, box.width, box.height)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A scene: actors on paths in front of a backdrop, seen by a camera, with exact truth."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import Camera, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Image, PixelWindow, Sprite

FIRST_STAMP_NS = 1_000_000_000
"""Stamp of frame 0: a stamp of zero means "unknown" to many tools."""


Path: TypeAlias = Callable[[float], Box]
"""Gives the box (px) a sprite fills at a frame number, counted from 0."""
Look: TypeAlias = Callable[[float], Sprite]
"""Sprite by frame number, of an actor whose appearance changes (by turning)."""


def noise_parameter(default: float) -> Any:
    """Make the parameter of a camera's noise."""
    return parameter(
        default,
        "more makes histograms differ from frame to frame",
        bounds=(0.0, 60.0),
        unit="levels of 255",
    )


def stamps_parameter(default: float, stays: str, source: str = "") -> Any:
    """Make the parameter of a frame rate that moves nothing; `stays` says what does not change."""
    return parameter(
        default,
        f"changes the stamps only: {stays} per frame",
        bounds=(1.0, 240.0),
        unit="frames/s",
        source=source,
    )


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

    def paint(self, picture: Image, frame: float) -> None:
        """Paint it over `picture` where it is in `frame`; what lies outside is clipped."""
        box = self.path(frame)
        window = PixelWindow.of(box, picture.shape[1], picture.shape[0])
        if not window.empty:
            layer = self.seen(frame).layer(box, window)
            region = picture[window.slices]
            # The "over" operator for colours multiplied with their opacity (Porter and Duff 1984).
            region *= 1 - layer[..., 3:]
            region += layer[..., :3]

    def seen(self, frame: float) -> Sprite:
        """Return the sprite it shows in `frame`."""
        return self.sprite if isinstance(self.sprite, Sprite) else self.sprite(frame)


@dataclass(frozen=True, slots=True)
class Stage(ABC):
    """Synthetic traffic; the same scene, parameters and seed give bit-identical frames.

    Things are placed on a stage, which the backdrop fills. The image is the part of it that the
    camera shows, and moves with the camera; truth is in coordinates of the image.

    Attributes
    ----------
    width, height : int
        Image size in px.
    frame_rate : float
        Frames per second.
    frame_count : int
        Number of frames.
    backdrop : callable
        Draws what never moves and hides nothing; called once per pass over the frames.
    camera : Camera or OutdoorCamera
        Takes the picture.
    """

    width: int
    height: int
    frame_rate: float
    frame_count: int
    backdrop: Callable[[], Image]
    camera: Camera | OutdoorCamera

    @abstractmethod
    def painted(self, index: int) -> Iterable[Actor]:
        """Return the actors of frame `index` in painting order."""

    def images(self, indices: Iterable[int] | None = None) -> Iterator[Frame]:
        """Render every frame in order, or those with the given indices."""
        backdrop = self.backdrop()
        for index in range(self.frame_count) if indices is None else indices:
            # A copy: actors and camera paint into it, and the backdrop is drawn once per pass.
            picture = backdrop.copy()
            for actor in self.painted(index):
                actor.paint(picture, index)
            yield self.camera.capture(picture, index)


@dataclass(frozen=True, slots=True)
class Scene(Stage):
    """A scene with one target.

    Attributes
    ----------
    actors : tuple of Actor
        All actors in painting order, far to near.
    target : int
        Index in `actors` of the vehicle the truth is about.
    """

    actors: tuple[Actor, ...]
    target: int

    def painted(self, index: int) -> Iterable[Actor]:
        """Return all actors."""
        return self.actors

    def frames(self, indices: Iterable[int] | None = None) -> Iterator[SceneFrame]:
        """Render every frame in order, or those with the given indices, with their truths."""
        chosen = range(self.frame_count) if indices is None else tuple(indices)
        return map(SceneFrame, self.images(chosen), map(self.truth, chosen))

    def truths(self) -> Iterator[Truth]:
        """Return the truth of every frame, as `frames` does, without rendering a pixel."""
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
        """Share (0 to 1) of the target's silhouette in `box` that is inside and not covered."""
        window = PixelWindow.of(box, self.width, self.height)
        # Out of the image there is nothing to see, and no pixel to average over.
        if window.empty:
            return 0.0
        sprite = self.actors[self.target].seen(index)
        # Of the silhouette, not of the box: a wheel's gap that is covered hides nothing.
        seen = sprite.coverage(box, window)
        # Only actors painted later can hide it.
        for actor in self.actors[self.target + 1 :]:
            place = self._in_image(actor.path(index), index)
            # Boxes first: most actors are nowhere near the target.
            if actor.hides and place.iou(box) > 0:
                # Within a pixel what two actors cover is taken as independent: the product.
                seen = seen * (1 - actor.seen(index).coverage(place, window))
        # Rounded because sums of floats must not make a free vehicle look 1e-16 hidden.
        return round(float(min(max(seen.sum() / sprite.area(box), 0.0), 1.0)), 9)

    def _in_image(self, box: Box, index: int) -> Box:
        # Paths are on the stage, truth in the image, and a shaken camera moves one over the other.
        left, top = self.camera.offset(index)
        return Box(box.x - left, box.y - top, box.width, box.height)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A scene: actors on paths in front of a backdrop, seen by a camera, with exact truth.

Cameras are fixed with sensor noise, or on a mast that shakes and flickers.
"""

from __future__ import annotations

import functools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.compositing import Colour, Image, PixelWindow, Sprite, stream

FIRST_STAMP_NS = 1_000_000_000
"""Stamp of frame 0: a stamp of zero means "unknown" to many tools."""

MARGIN = 12
"""Stage around the image, px on each side: room for the camera to shake."""

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
            region *= 1 - layer[..., 3:]
            region += layer[..., :3]

    def seen(self, frame: float) -> Sprite:
        """Give the sprite it shows in `frame`."""
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
        """Give the actors of frame `index` in painting order."""

    def images(self) -> Iterator[Frame]:
        """Render every frame in order."""
        backdrop = self.backdrop()
        for index in range(self.frame_count):
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
        """Give all actors."""
        return self.actors

    def frames(self) -> Iterator[SceneFrame]:
        """Render every frame in order, with its truth."""
        return map(SceneFrame, self.images(), self.truths())

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
        """Share (0 to 1) of the target's silhouette in `box` that is inside and not covered."""
        window = PixelWindow.of(box, self.width, self.height)
        if window.empty:
            return 0.0
        sprite = self.actors[self.target].seen(index)
        seen = sprite.coverage(box, window)
        for actor in self.actors[self.target + 1 :]:
            place = self._in_image(actor.path(index), index)
            if actor.hides and place.iou(box) > 0:
                seen = seen * (1 - actor.seen(index).coverage(place, window))
        # Rounded because sums of floats must not make a free vehicle look 1e-16 hidden.
        return round(float(min(max(seen.sum() / sprite.area(box), 0.0), 1.0)), 9)

    def _in_image(self, box: Box, index: int) -> Box:
        left, top = self.camera.offset(index)
        return Box(box.x - left, box.y - top, box.width, box.height)


@dataclass(frozen=True, slots=True)
class Camera:
    """A fixed camera with sensor noise.

    Attributes
    ----------
    noise : float
        Standard deviation of the white Gaussian noise on each channel, in levels of 0 to 255.
    seed : int
        Seed of the scene; each frame has its own stream, so that frames do not depend on order.
    """

    noise: float
    seed: int

    def offset(self, index: int) -> tuple[float, float]:
        """Give the image's top-left corner on the stage, px: it shows the whole stage."""
        return 0.0, 0.0

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed `picture` of frame `index` into an 8-bit frame; alters `picture`."""
        if self.noise > 0:
            grain = stream(self.seed, "sensor noise", index)
            noise = grain.standard_normal(picture.shape, dtype=np.float32)
            noise *= np.float32(self.noise)
            picture += noise
        return _quantised(picture)


def _quantised(picture: Image) -> Frame:
    np.rint(picture, out=picture)
    np.clip(picture, 0, 255, out=picture)
    return picture.astype(np.uint8)


@dataclass(frozen=True, slots=True)
class Disturbance:
    """Disturbance of a camera.

    Attributes
    ----------
    noise : float
        Standard deviation of the white Gaussian noise, levels of 0 to 255.
    shake : float
        Largest displacement of the image in x and y, px.
    flicker : float
        Standard deviation of the exposure from frame to frame, as a share of it.
    """

    noise: float
    shake: float
    flicker: float


DISTURBANCES = {"clean": Disturbance(2.0, 0.0, 0.0), "rough": Disturbance(8.0, 3.0, 0.03)}


@dataclass(frozen=True, slots=True)
class OutdoorCamera:
    """Shows the stage without its margin, shaken by the wind; see `Disturbance`."""

    disturbance: Disturbance
    seed: int

    def offset(self, index: int) -> tuple[float, float]:
        """Give the image's top-left corner on the stage in frame `index`, px.

        The mast swings at two rates in each direction, and trembles.
        """
        shake = self.disturbance.shake
        if shake == 0:
            return float(MARGIN), float(MARGIN)
        phases = stream(self.seed, "mast").uniform(0, 2 * math.pi, (2, 2))
        tremble = stream(self.seed, "tremble", index).uniform(-0.2, 0.2, 2)
        x, y = (
            MARGIN
            + shake * (0.55 * math.sin(index / 3.1 + slow) + 0.25 * math.sin(index + fast) + jump)
            for (slow, fast), jump in zip(phases.tolist(), tremble.tolist(), strict=True)
        )
        return x, y

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed stage of frame `index` into an 8-bit frame."""
        image = _shown(picture, self.offset(index))
        image *= np.asarray(self.gain(index), np.float32)
        image += _noise(image.shape, self.disturbance.noise, self.seed, index)
        return _quantised(image)

    def gain(self, index: int) -> Colour:
        """Give the gains of red, green and blue in frame `index`."""
        noise = float(stream(self.seed, "flicker", index).standard_normal())
        flicker = 1.0 + self.disturbance.flicker * noise
        return flicker, flicker, flicker


def _shown(picture: Image, offset: tuple[float, float]) -> Image:
    """Cut the image whose corner is at `offset` (x, y; px) out of the stage, bilinearly."""
    height, width = (size - 2 * MARGIN for size in picture.shape[:2])
    left, top = (math.floor(value) for value in offset)
    right, down = (np.float32(value - math.floor(value)) for value in offset)
    image: Image = picture[top : top + height + 1, left : left + width + 1]
    if right == 0 and down == 0:
        whole: Image = image[:-1, :-1].copy()
        return whole
    rows: Image = image[:-1] * (1 - down)
    rows += image[1:] * down
    shown: Image = rows[:, :-1] * (1 - right)
    shown += rows[:, 1:] * right
    return shown


def _noise(shape: tuple[int, ...], deviation: float, seed: int, index: int) -> Image:
    """White Gaussian noise of its own for each frame.

    Sixteen random bits choose each value: several times faster than drawing normal numbers.
    """
    bits = stream(seed, "sensor bits", index).bytes(2 * math.prod(shape))
    levels: Image = _quantiles() * np.float32(deviation)
    noise: Image = levels[np.frombuffer(bits, "<u2")].reshape(shape)
    return noise


@functools.cache
def _quantiles() -> npt.NDArray[np.float32]:
    """Values of the normal distribution at 65536 evenly spaced probabilities."""
    normal = NormalDist()
    return np.array([normal.inv_cdf((step + 0.5) / 65536) for step in range(65536)], np.float32)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cameras of synthetic scenes: fixed with sensor noise, or on a mast that shakes and flickers."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.scenes.compositing import Colour, Image
from vehicle_pf_tracker.scenes.random_streams import stream

SHAKE_MARGIN = 12
"""Stage around the image, px on each side: room for the camera to shake."""


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
        """Return the image's top-left corner on the stage, px: it shows the whole stage."""
        return 0.0, 0.0

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed `picture` of frame `index` into an 8-bit frame; alters `picture`."""
        if self.noise > 0:
            # A stream by frame: the noise of one does not depend on which were rendered before.
            grain = stream(self.seed, "sensor noise", index)
            noise = grain.standard_normal(picture.shape, dtype=np.float32)
            noise *= np.float32(self.noise)
            picture += noise
        return _quantised(picture)


def _quantised(picture: Image) -> Frame:
    # Rounded before the cast: `astype` truncates, which would darken all by half a level.
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


# The numbers are a choice: the shake has to stay below `SHAKE_MARGIN` less the one pixel that
# bilinear interpolation reads beyond the image.
DISTURBANCES = {"clean": Disturbance(2.0, 0.0, 0.0), "rough": Disturbance(8.0, 3.0, 0.03)}
"""Cameras by name: a steady one, and one that the wind shakes, with more noise and flicker."""


@dataclass(frozen=True, slots=True)
class OutdoorCamera:
    """Shows the stage without its margin, shaken by the wind; see `Disturbance`."""

    disturbance: Disturbance
    seed: int

    def offset(self, index: int) -> tuple[float, float]:
        """Return the image's top-left corner on the stage in frame `index`, px.

        The mast swings at two rates in each direction, and trembles.
        """
        shake = self.disturbance.shake
        if shake == 0:
            return float(SHAKE_MARGIN), float(SHAKE_MARGIN)
        # Two rates without a common period, as a mast swings: no frame repeats another.
        phases = stream(self.seed, "mast").uniform(0, 2 * math.pi, (2, 2))
        tremble = stream(self.seed, "tremble", index).uniform(-0.2, 0.2, 2)
        # Periods of 19.5 (2 pi * 3.1) and 6.3 (2 pi) frames.
        # The three amplitudes, 0.55, 0.25 and the tremble's 0.2, add up to 1: `shake` is the most.
        x, y = (
            SHAKE_MARGIN
            + shake * (0.55 * math.sin(index / 3.1 + slow) + 0.25 * math.sin(index + fast) + jump)
            for (slow, fast), jump in zip(phases.tolist(), tremble.tolist(), strict=True)
        )
        return x, y

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed stage of frame `index` into an 8-bit frame."""
        image = _shown(picture, self.offset(index))
        # The gain before the noise: the light flickers, and the sensor's noise does not with it.
        image *= np.asarray(self.gain(index), np.float32)
        image += _noise(image.shape, self.disturbance.noise, self.seed, index)
        return _quantised(image)

    def gain(self, index: int) -> Colour:
        """Return the gains of red, green and blue in frame `index`."""
        noise = float(stream(self.seed, "flicker", index).standard_normal())
        flicker = 1.0 + self.disturbance.flicker * noise
        return flicker, flicker, flicker


def _shown(picture: Image, offset: tuple[float, float]) -> Image:
    """Cut the image whose corner is at `offset` (x, y; px) out of the stage, bilinearly."""
    height, width = (size - 2 * SHAKE_MARGIN for size in picture.shape[:2])
    left, top = (math.floor(value) for value in offset)
    right, down = (np.float32(value - math.floor(value)) for value in offset)
    # One row and one column more than the image has: the last pixel needs its neighbour, too.
    image: Image = picture[top : top + height + 1, left : left + width + 1]
    if right == 0 and down == 0:
        whole: Image = image[:-1, :-1].copy()
        return whole
    # Along y and then along x: bilinear in two passes over the picture.
    rows: Image = image[:-1] * (1 - down)
    rows += image[1:] * down
    shown: Image = rows[:, :-1] * (1 - right)
    shown += rows[:, 1:] * right
    return shown


def _noise(shape: tuple[int, ...], deviation: float, seed: int, index: int) -> Image:
    """White Gaussian noise of its own for each frame.

    Sixteen random bits choose each value: several times faster than drawing normal numbers.
    """
    # Little-endian by name: the same bytes give the same frames on every machine.
    bits = stream(seed, "sensor bits", index).bytes(2 * math.prod(shape))
    levels: Image = _quantiles() * np.float32(deviation)
    noise: Image = levels[np.frombuffer(bits, "<u2")].reshape(shape)
    return noise


@functools.cache
def _quantiles() -> npt.NDArray[np.float32]:
    """Values of the normal distribution at 65536 evenly spaced probabilities."""
    normal = NormalDist()
    # At the middle of each step: the ends, 0 and 1, have no finite value. The largest is about 4.3.
    return np.array([normal.inv_cdf((step + 0.5) / 65536) for step in range(65536)], np.float32)

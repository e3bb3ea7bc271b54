# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Changes of a sequence's images that leave its truth as it is, or move it along exactly."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from laboratory.stress.footage import StressFootage, is_grey
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.scenes.random_streams import stream

Size: TypeAlias = tuple[int, int]
"""Width and height of an image in px."""
Painter: TypeAlias = Callable[[Frame, int], Frame]
"""Changes the frame of an index of the sequence; never writes to the frame it is given."""


class Change(Protocol):
    """A change of the footage, and what becomes of the truth."""

    def size(self, size: Size) -> Size:
        """Return the size of a changed image of the size `size`."""
        ...

    def truth(self, truth: Truth, index: int, size: Size, seed: int) -> Truth:
        """Return the truth of frame `index` after the change, from that before it."""
        ...

    def painter(self, footage: StressFootage, seed: int) -> Painter:
        """Prepare to change the frames of one case."""
        ...


class Unmoved:
    """A change in which everything stays where it is."""

    def size(self, size: Size) -> Size:
        """Return `size`."""
        return size

    def truth(self, truth: Truth, _index: int, _size: Size, _seed: int) -> Truth:
        """Return `truth`."""
        return truth


@dataclass(frozen=True, slots=True)
class Brightness(Unmoved):
    """Multiply all levels by `gain`."""

    gain: float

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare a look-up table."""
        # Rounded and cut at 255, as a camera does that is exposed for too long.
        return _look_up(np.arange(256) * self.gain)


@dataclass(frozen=True, slots=True)
class Gamma(Unmoved):
    """Raise all levels, as shares of white, to the power `exponent`."""

    exponent: float

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare a look-up table."""
        # As shares of white: 0 and 255 stay what they are, whatever the exponent.
        return _look_up(255 * (np.arange(256) / 255) ** self.exponent)


@dataclass(frozen=True, slots=True)
class Noise(Unmoved):
    """Add Gaussian noise of the standard deviation `deviation`, in grey levels."""

    deviation: float

    def painter(self, _footage: StressFootage, seed: int) -> Painter:
        """Prepare a random stream for every frame."""

        def paint(frame: Frame, index: int) -> Frame:
            # Footage without colour stays so: a grey camera has one sensor.
            channels = 1 if is_grey(frame) else 3
            rng = stream(seed, "noise", index)
            noise = rng.standard_normal((*frame.shape[:2], channels), dtype=np.float32)
            return _levels(frame + np.float32(self.deviation) * noise)

        return paint


@dataclass(frozen=True, slots=True)
class Jpeg(Unmoved):
    """Compress each frame as JPEG of the quality `quality`, 1 to 100."""

    quality: int

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare nothing: every frame is coded on its own."""

        def paint(frame: Frame, _index: int) -> Frame:
            # In OpenCV's order: JPEG weighs red and blue differently.
            image = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
            _, coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, self.quality])
            decoded = cv2.imdecode(coded, cv2.IMREAD_COLOR)
            assert decoded is not None
            return np.asarray(cv2.cvtColor(decoded, cv2.COLOR_BGR2RGB), np.uint8)

        return paint


@dataclass(frozen=True, slots=True)
class Blur(Unmoved):
    """Blur with a Gaussian of the standard deviation `deviation`, in px."""

    deviation: float

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare nothing."""

        def paint(frame: Frame, _index: int) -> Frame:
            return np.asarray(cv2.GaussianBlur(frame, (0, 0), self.deviation), np.uint8)

        return paint


@dataclass(frozen=True, slots=True)
class Mirror:
    """Swap left and right."""

    def size(self, size: Size) -> Size:
        """Return `size`."""
        return size

    def truth(self, truth: Truth, _index: int, size: Size, _seed: int) -> Truth:
        """Mirror the box."""
        box = truth.box
        mirrored = Box(size[0] - box.x - box.width, box.y, box.width, box.height)
        return replace(truth, box=mirrored)

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare nothing."""
        return lambda frame, _index: np.ascontiguousarray(frame[:, ::-1])


@dataclass(frozen=True, slots=True)
class Reduction:
    """Reduce images to the share `factor` of their sides."""

    factor: float

    def size(self, size: Size) -> Size:
        """Return the reduced size, rounded to whole pixels."""
        return max(1, round(size[0] * self.factor)), max(1, round(size[1] * self.factor))

    def truth(self, truth: Truth, _index: int, size: Size, _seed: int) -> Truth:
        """Scale the box by what the rounded size amounts to."""
        # By the rounded size: with the factor itself boxes would drift by half a pixel.
        reduced = self.size(size)
        x, y = reduced[0] / size[0], reduced[1] / size[1]
        box = truth.box
        return replace(truth, box=Box(box.x * x, box.y * y, box.width * x, box.height * y))

    def painter(self, _footage: StressFootage, _seed: int) -> Painter:
        """Prepare nothing."""

        def paint(frame: Frame, _index: int) -> Frame:
            size = self.size(frame_size(frame))
            return np.asarray(cv2.resize(frame, size, interpolation=cv2.INTER_AREA), np.uint8)

        return paint


_SWAYS = ((0.021, 0.55), (0.09, 0.3), (0.23, 0.15))
"""Cycles per frame and share of the amplitude: a mast in wind, a bridge under a lorry, its engine
(0.6, 2.7 and 7 Hz at 30 frames/s). Each axis has a phase of its own in each."""


@dataclass(frozen=True, slots=True)
class Shake:
    """Shift images as a swaying camera does, by at most `amplitude` px along each axis.

    Pixels that come in at the border repeat the outermost ones.
    """

    amplitude: float

    def size(self, size: Size) -> Size:
        """Return `size`."""
        return size

    def shift(self, index: int, seed: int) -> tuple[float, float]:
        """Return the shift (x, y) of frame `index` in px."""
        # Drawn anew for each frame, so that a frame does not depend on those made before.
        phases = stream(seed, "shake").uniform(0, 2 * math.pi, (len(_SWAYS), 2)).tolist()
        x, y = (
            self.amplitude
            * sum(
                share * math.sin(2 * math.pi * cycles * index + phase[axis])
                for (cycles, share), phase in zip(_SWAYS, phases, strict=True)
            )
            for axis in (0, 1)
        )
        return x, y

    def truth(self, truth: Truth, index: int, _size: Size, seed: int) -> Truth:
        """Shift the box."""
        x, y = self.shift(index, seed)
        box = truth.box
        return replace(truth, box=Box(box.x + x, box.y + y, box.width, box.height))

    def painter(self, _footage: StressFootage, seed: int) -> Painter:
        """Prepare nothing."""

        def paint(frame: Frame, index: int) -> Frame:
            x, y = self.shift(index, seed)
            matrix = np.array([[1.0, 0.0, x], [0.0, 1.0, y]])
            moved = cv2.warpAffine(
                frame,
                matrix,
                frame_size(frame),
                flags=cv2.INTER_LINEAR,
                borderMode=cv2.BORDER_REPLICATE,
            )
            return np.asarray(moved, np.uint8)

        return paint


def _look_up(levels: npt.NDArray[Any]) -> Painter:
    table = _levels(levels)
    return lambda frame, _index: np.asarray(cv2.LUT(frame, table), np.uint8)


def _levels(values: npt.NDArray[Any]) -> Frame:
    levels: Frame = np.clip(np.rint(values), 0, 255).astype(np.uint8)
    return levels

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Textures of painted occluders: concrete walls, posts, and lorries cut from the footage itself."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from laboratory.stress.coverage import Floats, coverage
from laboratory.stress.footage import StressFootage
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.scenes.grounds import value_noise
from vehicle_pf_tracker.scenes.random_streams import stream

Image = npt.NDArray[np.float32]
"""RGB levels 0 to 255, not yet rounded, (rows, columns, 3)."""

WALL, POLE, LORRY = "wall", "pole", "lorry"
_LARGEST_SIDE = 1500
"""Longest side of a texture in px; a longer occluder's is stretched."""
_BODIES = (
    (225, 225, 220),
    (70, 95, 150),
    (150, 60, 50),
    (80, 120, 85),
    (90, 90, 95),
    (190, 160, 80),
)
"""Paint of lorries, in daylight."""
_OWN_PAINT = 0.55
"""Share of a lorry's side that is paint; the rest is the patch of the footage."""
_FINE_PX = 1.0
"""Standard deviation of the blur, px, whose remainder is the grain of a surface."""
_LARGEST_GRAIN = 0.06
"""Share of its level that a surface varies by from pixel to pixel at most: foliage has more."""
_SOFTNESS_PX = 0.6
"""A lens and a JPEG blur what is painted no less than the rest."""
_EDGE = 0.55
"""Brightness of an outline, as a share of its surface's: dark enough for an edge. A choice."""


@dataclass(frozen=True, slots=True)
class Texture:
    """Surface of an occluder.

    Attributes
    ----------
    style : str
        `WALL`, `POLE` or `LORRY`.
    seed : int
        Seed of what is random in it.
    frame : int
        Index of the frame that colours and patches are taken from.
    patch : (int, int, int, int)
        Left, top, width and height in px of a part of that frame away from the vehicle.
    is_mirrored : bool
        A lorry's cab is at the left end.
    """

    style: str
    seed: int
    frame: int
    patch: tuple[int, int, int, int]
    is_mirrored: bool = False

    def make(self, footage: StressFootage, rectangle: Box) -> Image:
        """Make the texture for a rectangle, at the resolution of the images."""
        shape = _side(rectangle.height), _side(rectangle.width)
        patch = self._patch(footage)
        # A stream of its own: another occluder, or another fault, changes no pixel of this one.
        rng = stream(self.seed, "texture")
        if self.style == LORRY:
            image = _lorry(shape, patch, rng)
            image = image[:, ::-1] if self.is_mirrored else image
        elif self.style == POLE:
            image = _pole(shape, patch, rng)
        else:
            image = _wall(shape, patch, rng)
        if footage.is_grey:
            # Grey footage has grey occluders, or colour alone would tell what was painted.
            image = np.repeat(image.mean(axis=2, keepdims=True), 3, axis=2)
        soft = cv2.GaussianBlur(np.ascontiguousarray(image), (0, 0), _SOFTNESS_PX)
        return np.asarray(np.clip(soft, 0, 255), np.float32)

    def _patch(self, footage: StressFootage) -> Image:
        x, y, width, height = self.patch
        return footage.frame(self.frame)[y : y + height, x : x + width].astype(np.float32)


def blend(frame: Frame, texture: Image, corners: Floats) -> Frame:
    """Return a copy of a frame with a texture painted between corners, its edges smooth.

    Parameters
    ----------
    frame : (H, W, 3) array of uint8
        RGB image.
    texture : (h, w, 3) array
        Texture, whose corners go to `corners`.
    corners : (4, 2) array
        Corners, clockwise from the texture's top left, px.
    """
    width, height = frame_size(frame)
    left, top = np.clip(np.floor(corners.min(axis=0)), 0, (width, height)).astype(int).tolist()
    right, bottom = np.clip(np.ceil(corners.max(axis=0)), 0, (width, height)).astype(int).tolist()
    if right <= left or bottom <= top:
        return frame
    rows, columns = texture.shape[:2]
    # Pixel centres are half a pixel inside the corners, for OpenCV at whole numbers.
    ends = np.array([[0, 0], [columns, 0], [0, rows]], np.float32) - 0.5
    places = (corners[[0, 1, 3]] - (left + 0.5, top + 0.5)).astype(np.float32)
    matrix = cv2.getAffineTransform(ends, places)
    size = (right - left, bottom - top)
    painted = cv2.warpAffine(texture, matrix, size, borderMode=cv2.BORDER_REPLICATE)
    # By area and not by the nearest pixel: a hard edge would be a gradient that no lens makes.
    share = coverage(corners, (left, top, *size))[..., np.newaxis].astype(np.float32)
    result: Frame = frame.copy()
    part = result[top:bottom, left:right]
    part[:] = np.rint(share * painted + (1 - share) * part).astype(np.uint8)
    return result


def _wall(shape: tuple[int, int], patch: Image, rng: np.random.Generator) -> Image:
    """Draw concrete slabs with joints, lit from above."""
    # Warm grey, as concrete is, from three quarters of the patch's level to a third above it.
    base = np.full(3, _level(patch)) * rng.uniform(0.75, 1.3) * (1.03, 1.0, 0.94)
    shade = 1 + 0.10 * value_noise(shape, (40, 25), rng) + 0.06 * value_noise(shape, (5, 4), rng)
    shade += _grain(patch) * rng.standard_normal(shape)
    # Joints give the surface structure: a plain one would be no test of texture and edges.
    slab = max(12, round(min(shape) * rng.uniform(0.35, 0.6)))
    shade[:, ::slab] *= 0.75
    shade[::slab, :] *= 0.8
    shade *= np.linspace(1.12, 0.82, shape[0])[:, np.newaxis]
    return _outlined(_tint(base, shade))


def _pole(shape: tuple[int, int], patch: Image, rng: np.random.Generator) -> Image:
    """Draw a round post along the longer side, bright at one flank."""
    is_upright = shape[0] >= shape[1]
    across = shape[1] if is_upright else shape[0]
    # Shaded across like a cylinder: a flat post would look like the border of a sign.
    position = (np.arange(across) + 0.5) / across
    # The light comes from one side: the brightest flank is at a third of the width.
    flank = 0.55 + 0.65 * np.exp(-(((position - 0.35) / 0.28) ** 2))
    shade = (flank if is_upright else flank[:, np.newaxis]) * np.ones(shape)
    shade = shade * (1 + 0.05 * value_noise(shape, (6, 6), rng))
    # Cool grey, as galvanised steel is.
    base = np.full(3, _level(patch)) * rng.uniform(0.7, 1.3) * (0.97, 1.0, 1.04)
    return _tint(base, shade)


def _lorry(shape: tuple[int, int], patch: Image, rng: np.random.Generator) -> Image:
    """Draw a lorry from the side, its cab at the right: a patch of the footage under paint."""
    rows, columns = shape
    # In the light of the scene: a body in daylight would shine at dusk.
    paint = np.asarray(_BODIES[rng.integers(len(_BODIES))]) * _level(patch) / 128
    side = cv2.resize(patch, (columns, rows), interpolation=cv2.INTER_LINEAR)
    shade = (
        1 + 0.05 * value_noise(shape, (12, 30), rng) + _grain(patch) * rng.standard_normal(shape)
    )
    # Boards or ribs, 14 on a side.
    shade[:, :: max(5, columns // 14)] *= 0.8
    shade *= np.linspace(1.1, 0.85, rows)[:, np.newaxis]
    image = _outlined(_OWN_PAINT * _tint(paint, shade) + (1 - _OWN_PAINT) * side)
    _add_cab(image, paint * rng.uniform(0.6, 0.9))
    _add_wheels(image)
    return image


def _add_cab(image: Image, paint: Floats) -> None:
    rows, columns = image.shape[:2]
    # A quarter of the length, but never longer than nine tenths of its height.
    begin = columns - max(3, min(columns // 4, round(0.9 * rows)))
    image[:, begin:] = 0.75 * paint + 0.25 * image[:, begin:]
    image[:, begin : begin + max(1, columns // 80)] *= 0.4
    # Windows and wheels: what tells a lorry from a wall to a tracker that looks at edges.
    glass = slice(round(0.12 * rows), round(0.42 * rows))
    image[glass, begin + (columns - begin) // 4 :] *= 0.35


def _add_wheels(image: Image) -> None:
    rows, columns = image.shape[:2]
    # The underside is in shadow.
    image[round(0.86 * rows) :] *= 0.35
    radius = max(1, round(0.09 * rows))
    for share in (0.08, 0.2, 0.78, 0.9):
        centre = round(share * columns), rows - 1 - radius
        cv2.circle(image, centre, radius, (18.0, 18.0, 18.0), -1, cv2.LINE_AA)
        cv2.circle(image, centre, radius // 2, (95.0, 95.0, 95.0), -1, cv2.LINE_AA)


def _outlined(image: Image) -> Image:
    # Twice as wide on occluders that are large enough for it.
    thick = 1 if min(image.shape[:2]) < 60 else 2
    shade = np.full(image.shape[:2], _EDGE)
    shade[thick:-thick, thick:-thick] = 1.0
    image = _tint(image, shade)
    # Light catches the upper edge.
    image[thick : 2 * thick] *= 1.2
    return image


def _tint(base: Floats | Image, shade: Floats) -> Image:
    return (shade[..., np.newaxis] * base).astype(np.float32)


def _grain(patch: Image) -> float:
    """Measure how much the footage varies from pixel to pixel, as a share of its level."""
    fine = patch - cv2.GaussianBlur(patch, (0, 0), _FINE_PX)
    # Bounded: foliage in the patch would make a wall that flickers from pixel to pixel.
    return min(float(fine.std()) / _level(patch), _LARGEST_GRAIN)


def _level(patch: Image) -> float:
    """Mean level, of a dark patch somewhat more: occluders are no holes in the night."""
    return 0.85 * float(patch.mean()) + 20.0


def _side(length: float) -> int:
    return int(np.clip(np.ceil(length), 2, _LARGEST_SIDE))

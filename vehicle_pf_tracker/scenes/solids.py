# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Solids of flat faces, seen from beside the road and a little above, drawn as sprites.

Coordinates in metres: x forward, y away from the viewer, z up. The view is a parallel projection,
as through the long lens of a traffic camera, so that a solid keeps its size along the road.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.polygons import cells_inside

VIEW_ELEVATION = math.radians(35)
"""Angle of the view above the horizon: that of a camera on a bridge or a mast near the road."""
SHADOW_TINT: Colour = (12, 14, 20)
"""Colour that shadows are tinted with: bluish, as only the sky lights them."""
SHADOW_OPACITY = 0.5
"""Opacity of shadows on the road: half, as the sky lights them too."""
OVERSAMPLING = 6
"""Cells drawn per pixel and axis: 36 levels of coverage at an edge, finer than the noise."""
SAME_PLACE = 0.08
"""A face no more than this behind another (m) is taken as painted on it, if drawn later."""

_VIEW = np.array([0.0, -math.cos(VIEW_ELEVATION), math.sin(VIEW_ELEVATION)])
"""Unit vector towards the viewer."""
_DOWN = np.array([0.0, -math.sin(VIEW_ELEVATION), -math.cos(VIEW_ELEVATION)])
"""Unit vector that points down in the image."""
_SUN = np.array([0.35, 0.4, 0.85])
"""Direction of the sun, nearly of length 1: high, so that shadows stay beside their vehicles."""

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Face:
    """A flat polygon of one colour; `glow` leaves it unshaded (lamps, glass with a reflection)."""

    points: tuple[Point, ...]
    colour: Colour
    glow: bool = False

    def moved(self, to: Callable[[float, float, float], Point]) -> Face:
        """Return the face with each corner (x, y, z) moved."""
        return replace(self, points=tuple(to(*point) for point in self.points))


def side_panel(
    contour: Sequence[tuple[float, float]], y: float, colour: Colour, *, glow: bool = False
) -> Face:
    """Make an upright face along the road from (x, z) points."""
    return Face(tuple((x, y, z) for x, z in contour), colour, glow)


def strips(
    contour: Sequence[tuple[float, float]], near: float, far: float, colour: Colour
) -> list[Face]:
    """Make the faces swept by a line of (x, z) points drawn from y = `near` to `far`."""
    return [
        Face(((x0, near, z0), (x1, near, z1), (x1, far, z1), (x0, far, z0)), colour)
        for (x0, z0), (x1, z1) in pairwise(contour)
    ]


def disc(x: float, z: float, radius: float, colour: Colour) -> Face:
    """Make a round upright face along the road."""
    # 24 corners: they are 0.9 % of the radius off the circle, 0.05 px on a lorry's wheel.
    turns = [2 * math.pi * step / 24 for step in range(24)]
    contour = [(x + radius * math.cos(t), z + radius * math.sin(t)) for t in turns]
    return side_panel(contour, 0.0, colour)


def mirrored(faces: Iterable[Face]) -> list[Face]:
    """Turn a solid round so that it heads to the left."""
    return [face.moved(lambda x, y, z: (-x, y, z)) for face in faces]


def shadow(faces: Iterable[Face]) -> list[Face]:
    """Cast every face along the sun's rays onto the ground (z = 0)."""
    east, away, up = (float(part) for part in _SUN)
    cast = [
        face.moved(lambda x, y, z: (x - z * east / up, y - z * away / up, 0.0)) for face in faces
    ]
    # Unlit: a shadow is equally dark whichever way its face looked.
    return [replace(face, colour=SHADOW_TINT, glow=True) for face in cast]


def extent(faces: Iterable[Face]) -> Box:
    """Tight box of a solid as it is seen, in metres of the view plane."""
    every = np.concatenate([_project(face) for face in faces])
    left, top = every.min(axis=0).tolist()
    right, bottom = every.max(axis=0).tolist()
    return Box(left, top, right - left, bottom - top)


def draw(faces: Sequence[Face], width: float, height: float, opacity: float = 1.0) -> Sprite:
    """Draw `faces`: the nearest is seen, and of two in one place the later.

    The silhouette is stretched to touch all four sides of the sprite, so that the box the sprite
    fills is the tight box of the vehicle. `width` and `height` (px) are the size it is meant for
    and set the fineness.
    """
    bounds = extent(faces)
    columns = math.ceil(width * OVERSAMPLING)
    rows = math.ceil(height * OVERSAMPLING)
    cells_per_metre = columns / bounds.width, rows / bounds.height
    colour = np.zeros((rows, columns, 3), np.uint8)
    nearness = np.full((rows, columns), -np.inf, np.float32)
    # In the order given, which decides between faces in one place.
    for face in faces:
        outline = (_project(face) - (bounds.x, bounds.y)) * cells_per_metre
        window, inside = cells_inside(outline, rows, columns)
        # A face seen edge-on has no cells, and so is never divided by its slant of 0.
        if inside.any():
            x = bounds.x + _middles(window.left, window.right) / cells_per_metre[0]
            y = bounds.y + _middles(window.top, window.bottom) / cells_per_metre[1]
            # Deeper faces lose; what is painted on a face is drawn later and as near, and wins.
            near, depth = _nearness(face, x, y[:, np.newaxis])
            inside &= near > nearness[window.slices] - depth
            nearness[window.slices][inside] = near[inside]
            seen = face.colour if face.glow else lit(face.colour, normal_of(face))
            colour[window.slices][inside] = seen
    return Sprite(colour, np.isfinite(nearness) * opacity)


def _middles(first: int, end: int) -> Array:
    return np.arange(first, end, dtype=np.float64) + 0.5


def _nearness(face: Face, x: Array, y: Array) -> tuple[Array, float]:
    """Depth of a face towards the viewer at points (x, y) of the view plane, m.

    The second value is the depth along the view, in m, of a layer `SAME_PLACE` thick on it.
    """
    normal = normal_of(face)
    # The plane normal * p = level in the axes of the view (x, down, to the viewer), solved for
    # the last coordinate.
    level = float(normal @ np.asarray(face.points[0]))
    slant = float(normal @ _VIEW)
    return (level - normal[0] * x - float(normal @ _DOWN) * y) / slant, SAME_PLACE / slant


def _project(face: Face) -> Array:
    x, y, z = np.transpose(face.points)
    return np.stack([x, -z * math.cos(VIEW_ELEVATION) - y * math.sin(VIEW_ELEVATION)], axis=1)


def lit(colour: Colour, normal: Array) -> Colour:
    """Return `colour` as the sun lights a face of this unit normal."""
    # Ambient light and the sun's share by the angle (Lambert).
    light = 0.68 + 0.42 * max(0.0, float(normal @ _SUN))
    red, green, blue = (min(255.0, round(level * light)) for level in colour)
    return red, green, blue


def normal_of(face: Face) -> Array:
    """Return the unit normal of a face on the side of the viewer."""
    # By the first three corners: faces are flat, and these three never lie on one line.
    points = np.asarray(face.points)
    normal = np.cross(points[1] - points[0], points[2] - points[0])
    normal = normal / math.hypot(*normal)
    result: Array = normal if normal @ _VIEW >= 0 else -normal
    return result

"""Vehicles drawn as they head: sprites and tight boxes for every pose, with their shadows."""

from __future__ import annotations

import math
from collections.abc import Sequence

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.courses import Course, Pose
from vehicle_pf_tracker.scenes.headings import all_round, turned
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import Face, draw, extent, shadow

SHADOW_OPACITY = 0.5
HEADING_STEP = math.radians(2)
"""Sprites are drawn for headings this far apart; their boxes are exact for every heading."""


class Model:
    """A vehicle that can be sent along any course.

    Parameters
    ----------
    faces : sequence of Face
        The vehicle as seen from its near side.
    scale : float
        The largest scale it will be seen at, px per metre: sets how finely it is drawn.
    """

    def __init__(self, faces: Sequence[Face], scale: float) -> None:
        self._faces = all_round(faces)
        self._scale = scale
        self._sprites: dict[tuple[int, bool], Sprite] = {}
        self._extents: dict[tuple[float, bool], Box] = {}

    @property
    def size(self) -> tuple[float, float]:
        """Width and height (px) at heading 0 and the scale it is drawn for."""
        bounds = self._extent(0.0, shade=False)
        return bounds.width * self._scale, bounds.height * self._scale

    def on(self, course: Course) -> tuple[Actor, Actor]:
        """Send it along `course`; returns shadow and body, in the order to paint them."""
        return self._actor(course, shade=True), self._actor(course, shade=False)

    def _actor(self, course: Course, *, shade: bool) -> Actor:
        def look(frame: float) -> Sprite:
            return self._sprite(course(frame).heading, shade=shade)

        def path(frame: float) -> Box:
            return self._box(course(frame), shade=shade)

        return Actor(look, path, hides=not shade)

    def _box(self, pose: Pose, *, shade: bool) -> Box:
        bounds, scale = self._extent(pose.heading, shade=shade), pose.scale
        return Box(
            pose.x + bounds.x * scale,
            pose.y + bounds.y * scale,
            bounds.width * scale,
            bounds.height * scale,
        )

    def _sprite(self, heading: float, *, shade: bool) -> Sprite:
        key = round(heading / HEADING_STEP), shade
        if key not in self._sprites:
            faces = turned(self._faces, key[0] * HEADING_STEP)
            faces = shadow(faces) if shade else faces
            bounds = extent(faces)
            size = bounds.width * self._scale, bounds.height * self._scale
            self._sprites[key] = draw(faces, *size, SHADOW_OPACITY if shade else 1.0)
        return self._sprites[key]

    def _extent(self, heading: float, *, shade: bool) -> Box:
        """Tight box in metres around the point on the ground under the vehicle's middle."""
        key = heading, shade
        if key not in self._extents:
            faces = turned(self._faces, heading)
            self._extents[key] = extent(shadow(faces) if shade else faces)
        return self._extents[key]

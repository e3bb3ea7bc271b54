# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Ways that bend, and the scenes in which the target turns into a side road."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.cameras import SHAKE_MARGIN
from vehicle_pf_tracker.scenes.compositing import Colour, Image
from vehicle_pf_tracker.scenes.courses import Course, Pace, Pose
from vehicle_pf_tracker.scenes.drive import FREE_PX, TARGET_LANE, Drive, DriveParameters
from vehicle_pf_tracker.scenes.grounds import asphalt, concrete
from vehicle_pf_tracker.scenes.obstacles import opaque
from vehicle_pf_tracker.scenes.polygons import cells_inside
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION

TURN_RADIUS = 60.0
"""Radius of a turn on the ground, px: 5 m at 11.5 px/m, about as tight as a car can turn."""
SIDE_ROAD = 44.0
"""Width of each of the two lanes of a side road, px."""


@dataclass(frozen=True, slots=True)
class Bend:
    """A straight drive, an arc, and a straight drive, on flat ground seen from `VIEW_ELEVATION`.

    Attributes
    ----------
    start : Pose
        The pose from which `pace` counts.
    pace : Pace
        Distance on the ground, px.
    straight, radius : float
        Length before the arc and radius of the arc, px.
    angle : float
        Change of heading, at most pi/2, to the left if positive, rad; 0 goes straight for ever.
    """

    start: Pose
    pace: Pace
    straight: float = 0.0
    radius: float = 1.0
    angle: float = 0.0

    def __call__(self, frame: float) -> Pose:
        """Give the pose in `frame`."""
        gone = self.pace(frame)
        before = gone if self.angle == 0 else min(gone, self.straight)
        arc = min(gone - before, self.radius * abs(self.angle))
        after = gone - before - arc
        side = math.copysign(1.0, self.angle)
        turn = side * arc / self.radius
        # On the ground, where the arc is a circle; the view from above shortens it only afterwards.
        # A circle: r sin along, r (1 - cos) across; then straight on in the new heading.
        along = before + self.radius * abs(math.sin(turn)) + after * math.cos(turn)
        across = side * self.radius * (1 - math.cos(turn)) + after * math.sin(turn)
        east, north = _rotated(along, across, self.start.heading)
        return Pose(
            self.start.x + east,
            self.start.y - north * math.sin(VIEW_ELEVATION),
            self.start.heading + turn,
            self.start.scale,
        )


def _rotated(along: float, across: float, heading: float) -> tuple[float, float]:
    cosine = math.cos(heading)
    sine = math.sin(heading)
    return along * cosine - across * sine, along * sine + across * cosine


def side_road(
    picture: Image,
    begin: tuple[float, float],
    end: tuple[float, float],
    width: float,
    rng: np.random.Generator,
) -> None:
    """Draw a road with a dashed middle line from `begin` to `end` (x, y), `width` px across."""
    x0, y0 = begin
    x1, y1 = end
    # The kerb first, and the asphalt over it.
    sides = (-width / 2 - 3, width / 2 + 3), (-width / 2, width / 2)
    # The kerb is 3 px wide on each side, and lighter than the road.
    for (left, right), light in zip(sides, (1.25, 1.0), strict=True):
        outline = np.array([(x0 + left, y0), (x0 + right, y0), (x1 + right, y1), (x1 + left, y1)])
        window, inside = cells_inside(outline, *picture.shape[:2])
        rows, columns = inside.shape
        # Turned, since the grain of asphalt runs along a road.
        ground = asphalt((columns, rows), rng).transpose(1, 0, 2) * np.float32(light)
        picture[window.slices][inside] = ground[inside]
    for row in range(max(round(y0), 0), min(round(y1), picture.shape[0])):
        if row % 24 < 13:
            column = round(x0 + (x1 - x0) * (row - y0) / (y1 - y0))
            picture[row, max(column - 1, 0) : max(column + 1, 0)] = (206, 206, 198)


class TurningDrive(Drive):
    """A drive whose target turns into a side road, away from the viewer.

    There is no second carriageway.

    Parameters
    ----------
    parameters : DriveParameters
        Parameters of the drive.
    seed : int
        Seed of the scene.
    """

    def __init__(self, parameters: DriveParameters, seed: int) -> None:
        super().__init__(parameters, seed)
        # The corner differs between seeds by 2 % of the image, and is before its middle.
        self.corner = self.along(0.42 + stream(seed, "corner").uniform(-0.02, 0.02))

    @property
    def _end(self) -> float:
        # The way up the side road that is left in the image, whose depth is foreshortened.
        up = (self.row - SHAKE_MARGIN - FREE_PX - self.target.size[0]) / math.sin(VIEW_ELEVATION)
        # The quarter circle is pi/2 radii long, and one radius of `up` is driven in it.
        return self.corner + TURN_RADIUS * math.pi / 2 + up - TURN_RADIUS

    def course(self, s: float, pace: Pace, lane: int = TARGET_LANE) -> Course:
        """Make the course of a vehicle that turns too; see `Drive.course`."""
        heading, left = (0.0, 1) if self.rightward else (math.pi, -1)
        start = Pose(self.x(s), self.road.middle(lane), heading, self.scale)
        return Bend(start, pace, self.corner - s, TURN_RADIUS, left * math.pi / 2)

    def backdrop(self) -> Image:
        """Draw the empty road, and the side road."""
        rng = stream(self.seed, "backdrop")
        picture = self._ground((self.road,), rng)
        middle = self.x(self.corner + TURN_RADIUS + 0.5 * SIDE_ROAD)
        side_road(picture, (middle, -1.0), (middle, self.road.top + 4.0), 2 * SIDE_ROAD, rng)
        return picture


def turn(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road, away from the viewer."""
    return TurningDrive(parameters, seed).scene(behind=())


def turn_occluded(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road behind a house."""
    drive = TurningDrive(parameters, seed)
    return drive.scene(house_at_corner(drive), behind=())


def house_at_corner(drive: TurningDrive) -> list[Actor]:
    """Build a house on the near side that hides the turn of `drive`."""
    length, height = drive.target.size
    # From before the turn to after it, so that both straight parts are seen.
    near = drive.corner - 0.7 * length
    far = drive.corner + TURN_RADIUS + 0.6 * length
    left = min(drive.x(near), drive.x(far))
    top = drive.row - TURN_RADIUS * math.sin(VIEW_ELEVATION) - 1.2 * height
    box = Box(left, top, far - near, drive.road.rows.stop + 50 - top)
    return house(box, (196, 178, 150), stream(drive.seed, "house"))


def house(box: Box, walls: Colour, rng: np.random.Generator) -> list[Actor]:
    """Make the rear of a house with two rows of windows under a roof of tiles, filling `box`."""
    rows = round(box.height)
    columns = round(box.width)
    # `concrete` has a level of 164: divided by it, its texture is left, on any colour.
    colour = concrete((rows, columns), rng) / 164 * np.asarray(walls)
    eaves = round(rows * 0.3)
    colour[:eaves] = concrete((eaves, columns), rng) / 164 * np.asarray((138.0, 76.0, 58.0))
    colour[:eaves:4] *= 0.82
    colour[eaves : eaves + 3] *= 0.6
    for top in (round(rows * 0.4), round(rows * 0.7)):
        for left in range(10, columns - 18, 26):
            colour[top : top + round(rows * 0.17), left : left + 13] = (62, 72, 84)
            colour[
                top + round(rows * 0.17) : top + round(rows * 0.17) + 2, left - 1 : left + 14
            ] = 205
    return [opaque(colour, box)]

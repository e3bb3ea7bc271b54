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

"""Scenes about how the target drives: steadily, faster and slower, round a corner, into depth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import DISTURBANCES, MARGIN, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Image, cells_inside, stream
from vehicle_pf_tracker.scenes.drive import RADIUS, SIZES, Drive, DriveParameters, target_faces
from vehicle_pf_tracker.scenes.models import Model
from vehicle_pf_tracker.scenes.obstacles import house
from vehicle_pf_tracker.scenes.occluded_drives import bridge_at
from vehicle_pf_tracker.scenes.paths import Pace, Pose
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import ELEVATION, asphalt, grass


@dataclass(frozen=True, slots=True)
class BrakingParameters(DriveParameters):
    """Parameters of a change of speed during an occlusion."""

    change: float = parameter(
        0.6, "speed after the occlusion over that before; above 1 accelerates",
        minimum=0.4, maximum=1.8,
    )  # fmt: skip
    hidden: float = parameter(
        16.0, "longer occlusions leave more to prediction",
        minimum=4.0, maximum=40.0, unit="frames",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class AccelerationParameters(DriveParameters):
    """Parameters of a change of speed while visible."""

    change: float = parameter(
        2.2, "highest speed over the speed at the start and at the end", minimum=1.0, maximum=3.0
    )


def clear(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: nothing in the way, at a constant speed."""
    return Drive(parameters, seed).scene("clear")


def acceleration(parameters: AccelerationParameters, seed: int) -> Scene:
    """Make the scene: the target speeds up, holds the speed, and brakes."""
    low, high = parameters.speed, parameters.speed * parameters.change
    knots = (0.0, low), (14.0, low), (34.0, high), (48.0, high), (64.0, low)
    return Drive(parameters, seed, Pace(knots)).scene("acceleration")


def braking(parameters: BrakingParameters, seed: int) -> Scene:
    """Make the scene: the target changes its speed under a bridge."""
    before, after = parameters.speed, parameters.speed * parameters.change
    plain = Drive(parameters, seed)
    frame = plain.frame_at(plain.along(0.5))
    half = 0.35 * parameters.hidden
    drive = Drive(
        parameters, seed, Pace(((0, before), (frame - half, before), (frame + half, after)))
    )
    mean = (before + after) / 2 / before
    return drive.scene("braking", bridge_at(drive, 0.5, parameters.hidden * mean))


def turn(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road, away from the viewer."""
    return turning(parameters, seed).scene("turn", behind=())


def turn_occluded(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road behind a house."""
    drive = turning(parameters, seed)
    return drive.scene("turn_occluded", house_at_corner(drive), behind=())


def turning(parameters: DriveParameters, seed: int) -> Drive:
    """Make a drive that turns into a side road a little before the middle of the image."""
    corner = Drive(parameters, seed).along(0.42 + stream(seed, "corner").uniform(-0.02, 0.02))
    return Drive(parameters, seed, corner=corner)


def house_at_corner(drive: Drive) -> list[Actor]:
    """Build a house on the near side that hides the turn of `drive`, which has a corner."""
    assert drive.corner is not None
    length, height = drive.target.size
    near, far = drive.corner - 0.7 * length, drive.corner + RADIUS + 0.6 * length
    left = min(drive.x(near), drive.x(far))
    top = drive.row - RADIUS * math.sin(ELEVATION) - 1.2 * height
    box = Box(left, top, far - near, drive.road.rows.stop + 50 - top)
    return house(box, (196, 178, 150), stream(drive.seed, "house"))


FOCAL = 600.0
"""Focal length, px."""
NEAREST = 16.0
"""Scale where the target is nearest, px per metre."""
BEARING = math.radians(62)
"""Direction of the road on the ground: 90 degrees would be straight away from the viewer."""
HALF_WIDTH = 5.0
"""Half the width of the road, m."""
TOP, BOTTOM = 0.22, 0.84
"""Rows where the target is farthest and nearest, as shares of the image's height."""


@dataclass(frozen=True, slots=True)
class ScaleParameters(DriveParameters):
    """Parameters of a drive into depth."""

    factor: float = parameter(
        2.5, "how many times larger the target is at its nearest than at its farthest",
        minimum=1.2, maximum=3.0,
    )  # fmt: skip
    way: str = parameter("away", "shrink by driving away, or grow", choices=("away", "towards"))


@dataclass(frozen=True, slots=True)
class Depth:
    """A road into depth as the camera sees it.

    Attributes
    ----------
    width, height : int
        Size of the stage, px.
    factor : float
        Ratio of the sizes at its two ends.
    side : float
        1 where the far end is to the right, -1 to the left.
    """

    width: int
    height: int
    factor: float
    side: float

    def scale(self, share: float) -> float:
        """Size (px per metre) at a share of the way, from 0 (near) to 1 (far)."""
        return FOCAL / self._distance(share)

    def point(self, share: float, across: float = 0.0) -> tuple[float, float]:
        """Place on the stage at a share of the way and `across` metres right of the middle."""
        scale = self.scale(share)
        gone = self._distance(share) - FOCAL / NEAREST
        aside = self.side * (gone / math.tan(BEARING)) + across / math.sin(BEARING)
        start = self.width * (0.5 - 0.2 * self.side)
        span = (BOTTOM - TOP) * self.height / (NEAREST - NEAREST / self.factor)
        return start + aside * scale, BOTTOM * self.height - span * (NEAREST - scale)

    def _distance(self, share: float) -> float:
        return FOCAL / NEAREST * (1 + share * (self.factor - 1))


@dataclass(frozen=True, slots=True)
class IntoDepth:
    """Drives along a `Depth` at constant speed on the ground, in `frames` frames."""

    depth: Depth
    frames: float
    away: bool

    def __call__(self, frame: float) -> Pose:
        """Give the pose in `frame`."""
        share = frame / self.frames if self.away else 1 - frame / self.frames
        heading = BEARING if self.depth.side > 0 else math.pi - BEARING
        x, y = self.depth.point(share, -0.45 * HALF_WIDTH)
        return Pose(x, y, heading if self.away else heading - math.pi, self.depth.scale(share))


def scale(parameters: ScaleParameters, seed: int) -> Scene:
    """Make the scene; its speed is the mean in the image."""
    width, height = SIZES[parameters.resolution]
    side = 1.0 if parameters.heading == "right" else -1.0
    depth = Depth(width + 2 * MARGIN, height + 2 * MARGIN, parameters.factor, side)
    frames = math.dist(depth.point(0), depth.point(1)) / parameters.speed
    rng = stream(seed, "drive")
    model = Model(target_faces(parameters.vehicle, rng), NEAREST)
    return Scene(
        name="scale",
        width=width,
        height=height,
        frame_rate=parameters.frame_rate,
        frame_count=int(frames) + 1,
        backdrop=lambda: _backdrop(depth, seed),
        actors=model.on(IntoDepth(depth, frames, parameters.way == "away")),
        target=1,
        camera=OutdoorCamera(DISTURBANCES[parameters.disturbance], seed),
    )


def _backdrop(depth: Depth, seed: int) -> Image:
    """Draw the road with edge lines and a dashed middle line in a meadow."""
    rng = stream(seed, "backdrop")
    picture = grass((depth.height, depth.width), rng)
    road = asphalt((depth.height, depth.width), rng)
    shares = np.linspace(-0.45, 4.0, 30).tolist()
    _fill(picture, depth, shares, (-HALF_WIDTH, HALF_WIDTH), road)
    white = np.full_like(road, 208)
    for left in (-HALF_WIDTH + 0.3, HALF_WIDTH - 0.45):
        _fill(picture, depth, shares, (left, left + 0.15), white)
    for begin, end in pairwise(shares):
        dash = [begin, (begin + end) / 2]
        _fill(picture, depth, dash, (-0.08, 0.08), white)
    return picture


def _fill(
    picture: Image, depth: Depth, shares: list[float], across: tuple[float, float], paint: Image
) -> None:
    """Fill the strip of the road between two distances from its middle (m)."""
    near, far = ([depth.point(share, side) for share in shares] for side in across)
    window, inside = cells_inside(np.array([*near, *far[::-1]]), *picture.shape[:2])
    picture[window.slices][inside] = paint[window.slices][inside]

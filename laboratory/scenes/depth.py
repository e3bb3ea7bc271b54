# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A drive into depth, in which the target changes its size."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import DISTURBANCES, SHAKE_MARGIN, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.courses import Pose
from vehicle_pf_tracker.scenes.drive import PAPER_SIZES, DriveParameters, target_faces
from vehicle_pf_tracker.scenes.grounds import asphalt, grass
from vehicle_pf_tracker.scenes.polygons import cells_inside
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Scene
from vehicle_pf_tracker.scenes.turning_vehicle import TurningVehicle

FOCAL = 600.0
"""Focal length, px: a field of view of 56 degrees at 640 px. A choice."""
NEAREST = 16.0
"""Scale where the target is nearest, px per metre."""
BEARING = math.radians(62)
"""Direction of the road on the ground: 90 degrees would be straight away from the viewer."""
HALF_WIDTH = 5.0
"""Half the width of the road, m: a lane in each direction, and its shoulder."""
TOP, BOTTOM = 0.22, 0.84
"""Rows where the target is farthest and nearest, as shares of the image's height."""


@dataclass(frozen=True, slots=True)
class ScaleParameters(DriveParameters):
    """Parameters of a drive into depth."""

    factor: float = parameter(
        2.5, "how many times larger the target is at its nearest than at its farthest",
        bounds=(1.2, 3.0),
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
        # A horizontal cut through a road that runs at an angle is wider than the road.
        aside = self.side * (gone / math.tan(BEARING)) + across / math.sin(BEARING)
        # The near end on one side leaves room for the road to go to the other.
        start = self.width * (0.5 - 0.2 * self.side)
        # Scale and row below the horizon both go with 1 / distance: the row is linear in the
        # scale.
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
        # Constant on the ground: in the image it slows down as it drives away.
        share = frame / self.frames if self.away else 1 - frame / self.frames
        heading = BEARING if self.depth.side > 0 else math.pi - BEARING
        # Near the middle of the left lane: the dashed line is at 0.
        x, y = self.depth.point(share, -0.45 * HALF_WIDTH)
        return Pose(x, y, heading if self.away else heading - math.pi, self.depth.scale(share))


def scale(parameters: ScaleParameters, seed: int) -> Scene:
    """Make the scene; its speed is the mean in the image."""
    width, height = PAPER_SIZES[parameters.resolution]
    side = 1.0 if parameters.heading == "right" else -1.0
    depth = Depth(width + 2 * SHAKE_MARGIN, height + 2 * SHAKE_MARGIN, parameters.factor, side)
    # The speed of all scenes is in px per frame; here it is the mean over the way.
    frames = math.dist(depth.point(0), depth.point(1)) / parameters.speed
    rng = stream(seed, "drive")
    model = TurningVehicle(target_faces(parameters.vehicle, rng), NEAREST)
    return Scene(
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
    # Beyond both ends: the road reaches from below the image to near the horizon.
    shares = np.linspace(-0.45, 4.0, 30).tolist()
    _fill(picture, depth, shares, (-HALF_WIDTH, HALF_WIDTH), road)
    white = np.full_like(road, 208)
    for left in (-HALF_WIDTH + 0.3, HALF_WIDTH - 0.45):
        _fill(picture, depth, shares, (left, left + 0.15), white)
    # A dash over the first half of each step; in the image they get shorter with the distance.
    for begin, end in pairwise(shares):
        dash = [begin, (begin + end) / 2]
        _fill(picture, depth, dash, (-0.08, 0.08), white)
    return picture


def _fill(
    picture: Image, depth: Depth, shares: list[float], across: tuple[float, float], paint: Image
) -> None:
    """Fill the strip of the road between two distances from its middle (m)."""
    # One side there, the other side back: together the outline of the strip.
    near, far = ([depth.point(share, side) for share in shares] for side in across)
    window, inside = cells_inside(np.array([*near, *far[::-1]]), *picture.shape[:2])
    picture[window.slices][inside] = paint[window.slices][inside]

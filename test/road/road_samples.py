# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A camera 8 m above a road, looking along it and down."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.road.poses import Pose

LENS = Lens((800.0, 800.0), (319.5, 239.5))
BENT = Lens((800.0, 800.0), (319.5, 239.5), "plumb_bob", (-0.3, 0.1, 0.001, -0.002, 0.0))


def pose(pitch: float = 0.3, height: float = 8.0) -> Pose:
    """Optical frame at (0, 0, height), looking along y, `pitch` rad below the horizon."""
    down, ahead = np.sin(pitch), np.cos(pitch)
    right, below, view = (1.0, 0.0, 0.0), (0.0, -down, -ahead), (0.0, ahead, -down)
    return Pose(np.column_stack([right, below, view]), np.array([0.0, 0.0, height]))


def camera_plane(lens: Lens = LENS) -> RoadPlane:
    return RoadPlane.of_camera(lens, pose(), coarsest=1.0)


def pairs_of(plane: RoadPlane, metres) -> list[Pair]:
    pixels = plane.to_image(np.asarray(metres, float))
    return [
        Pair(tuple(p), tuple(map(float, m))) for p, m in zip(pixels.tolist(), metres, strict=True)
    ]

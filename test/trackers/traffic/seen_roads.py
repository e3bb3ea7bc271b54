# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A calibrated road for tests, seen by a camera."""

import numpy as np

from laboratory.scenes.perspective import looking
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.road.poses import Pose

SIZE = (640, 480)
LENS = Lens((800.0, 800.0), (319.5, 239.5))


def road(height=8.0, ahead=60.0, roll=0.0):
    """A road that a camera looks at, so many metres above and before it, rolled by radians."""
    pose = looking((0.0, 0.0, height), (0.0, ahead))
    c, s = np.cos(roll), np.sin(roll)
    turned = pose.rotation @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return RoadPlane.of_camera(LENS, Pose(turned, pose.position), coarsest=10.0)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.poses import Pose, PoseTree

HALF = np.sqrt(0.5)


def test_a_quarter_turn_about_z():
    pose = Pose.of((1.0, 2.0, 3.0), (0.0, 0.0, HALF, HALF))
    assert pose.rotation @ [1, 0, 0] + pose.position == pytest.approx([1, 3, 3])


@pytest.mark.parametrize("quaternion", [(0, 0, 0, 0), (0, 0, 0, 2), (np.nan, 0, 0, 1)])
def test_what_is_no_pose(quaternion):
    with pytest.raises(InputError, match="quaternion"):
        Pose.of((0.0, 0.0, 0.0), quaternion)


def test_a_tree_goes_up_and_down():
    tree = PoseTree()
    still = (0.0, 0.0, 0.0, 1.0)
    tree.put("map", "road", Pose.of((10.0, 0.0, 0.0), still))
    tree.put("/map", "/mast", Pose.of((0.0, 0.0, 8.0), (0.0, 0.0, HALF, HALF)))
    tree.put("mast", "camera", Pose.of((1.0, 0.0, 0.0), still))
    assert tree.find("camera", "road").position == pytest.approx([-10, 1, 8])
    assert tree.find("road", "camera").position == pytest.approx([-1, -10, -8])
    tree.put("mast", "camera", Pose.of((2.0, 0.0, 0.0), still))
    assert tree.find("camera", "road").position == pytest.approx([-10, 2, 8])


def test_frames_that_are_not_connected():
    tree = PoseTree()
    with pytest.raises(InputError, match="does not connect"):
        tree.find("camera", "road")
    still = Pose.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    tree.put("a", "b", still)
    tree.put("b", "a", still)  # a loop ends too
    with pytest.raises(InputError, match="does not connect"):
        tree.find("a", "road")

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import cv2
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


def test_a_third_of_a_turn_about_the_diagonal_exchanges_the_axes():
    pose = Pose.of((0.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))
    assert pose.rotation == pytest.approx(np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))


@pytest.mark.parametrize("turn", [(0.3, 0.0, 0.0), (0.0, 1.1, 0.0), (0.4, -0.7, 1.9)])
def test_turns_are_those_of_rodrigues(turn):
    angle = np.linalg.norm(turn)
    axis = np.array(turn) / angle
    pose = Pose.of((0.0, 0.0, 0.0), (*(axis * np.sin(angle / 2)), np.cos(angle / 2)))
    assert pose.rotation == pytest.approx(cv2.Rodrigues(np.array(turn))[0])


def test_a_rounded_quaternion_is_brought_to_length_one():
    pose = Pose.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.71, 0.71))  # of length 1.004
    assert pose.rotation == pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]))
    with pytest.raises(InputError, match="of length 1"):
        Pose.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.72, 0.72))  # 1.018
    with pytest.raises(InputError, match="finite"):
        Pose.of((np.inf, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def test_an_inverse_undoes_a_pose():
    pose = Pose.of((1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5))
    # A child's (4, 5, 6) is the parent's (6 + 1, 4 + 2, 5 + 3).
    there = pose.rotation @ [4, 5, 6] + pose.position
    assert there == pytest.approx([7, 6, 8])
    assert pose.inverse.rotation @ there + pose.inverse.position == pytest.approx([4, 5, 6])
    both = pose @ pose.inverse
    assert both.rotation == pytest.approx(np.eye(3))
    assert both.position == pytest.approx(np.zeros(3))


def test_poses_are_equal_to_the_last_digit():
    pose = Pose.of((1.0, 2.0, 3.0), (0.0, 0.0, HALF, HALF))
    assert pose.equals(Pose.of((1.0, 2.0, 3.0), (0.0, 0.0, HALF, HALF)))
    assert not pose.equals(Pose.of((1.0, 2.0, 3.0 + 1e-15), (0.0, 0.0, HALF, HALF)))
    assert not pose.equals(Pose.of((1.0, 2.0, 3.0), (0.0, HALF, 0.0, HALF)))
    assert not pose.equals(None)


def test_frames_are_named_with_a_slash_or_without():
    tree = PoseTree()
    tree.put("/X_map", "/X_camera", Pose.of((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
    assert tree.find("X_camera", "X_map").position == pytest.approx([1, 0, 0])
    assert tree.find("/X_camera", "/X_map").position == pytest.approx([1, 0, 0])
    assert tree.find("camera", "camera").position == pytest.approx([0, 0, 0])
    with pytest.raises(InputError, match="the frames 'camera' and 'moon'"):
        tree.find("camera", "moon")

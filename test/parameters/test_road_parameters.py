# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.parameters.table import from_mapping

PAIRS = "0,0=0,0; 100,0=10,0; 100,100=10,10; 0,100=0,10"
INTRINSICS = "800,800,319.5,239.5"
DOWN = "0,0,10,1,0,0,0"


def road(**values) -> RoadParameters:
    named = {f"road.{name}": value for name, value in values.items()}
    return from_mapping(SessionParameters, named).road


def test_no_road_by_default():
    assert not RoadParameters().is_set


def test_pairs_make_a_plane():
    parameters = road(pairs=PAIRS)
    assert parameters.is_set
    plane = parameters.plane(parameters.lens, parameters.pose)
    assert plane.to_road(plane.to_image(np.array([5.0, 5.0]))) == pytest.approx([5.0, 5.0])


def test_a_pose_makes_a_plane():
    parameters = road(camera_pose=DOWN, intrinsics=INTRINSICS)
    plane = parameters.plane(parameters.lens, parameters.pose)
    assert plane.to_image(np.array([0.0, 0.0])) == pytest.approx([320.0, 240.0])


def test_what_comes_later_is_not_asked_for_now():
    assert road(from_tf=True, from_camera_info=True).is_set
    assert road(camera_pose=DOWN, from_camera_info=True).is_set
    assert road(pairs=PAIRS, from_camera_info=True).is_set


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"pairs": "0,0=0,0; 1,1=1,1; 2,2=2,2; 5,0=5,0"}, "no three lie on a line"),
        ({"pairs": "0,0=0,0; 1,1=1,1; 2,2=2,2; 5,0=5,0", "from_camera_info": True}, "on a line"),
        ({"pairs": "0,0=0,0"}, "at least 4"),
        ({"pairs": "0,0;1,1"}, "not u,v=x,y"),
        ({"pairs": PAIRS, "camera_pose": DOWN, "intrinsics": INTRINSICS}, "not both"),
        ({"pairs": PAIRS, "from_tf": True}, "not both"),
        ({"pairs": PAIRS, "frame_id": ""}, "frame_id"),
        ({"camera_pose": DOWN}, "road.intrinsics"),
        ({"camera_pose": "0,0,-1,1,0,0,0", "intrinsics": INTRINSICS}, "above it"),
        ({"camera_pose": DOWN, "from_tf": True}, "not both"),
        ({"intrinsics": INTRINSICS, "from_camera_info": True}, "not both"),
        ({"intrinsics": "1,2,3"}, "fx,fy,cx,cy"),
        ({"from_tf": True}, "from_camera_info"),
    ],
)
def test_what_makes_no_road_is_refused(values, words):
    with pytest.raises(InputError, match=words):
        road(**values)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A drawn vehicle of 40 x 20 px before a road of noise: edges of the middle of three frames."""

import numpy as np
import pytest
from fusion_samples import contrasted, grey_road

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey
from vehicle_pf_tracker.trackers.fusion.moments import Moment, moved
from vehicle_pf_tracker.trackers.fusion.moving_edges import moving_edges

WIDTH, HEIGHT = 200, 100
EXTENT = WIDTH, HEIGHT
WIDE, TALL = 40, 20
ROAD = grey_road(WIDTH, HEIGHT)
BODY = 255 - contrasted(
    np.random.default_rng(3).integers(0, 256, (TALL, WIDE)).astype(np.uint8), 1.5
)
CELL = 1 / 20


def found(body=BODY, left=60, speed=6, off=0, wide=WIDE, pan=0, rise=0):
    """Edges beyond a box of this width that lies `off` px beside the vehicle."""
    moments = ()
    camera = CameraMotion(shift=np.array([float(pan), 0.0]))
    for time in range(3):
        image = np.roll(ROAD, pan * time, axis=1).copy()
        low = left + speed * time
        top = 40 + rise * time
        image[top : top + TALL, low : low + WIDE] = body
        moments = moved(moments, camera)
        position = np.array([low + off + wide / 2, top + TALL / 2])
        size = np.array([wide, TALL], float)
        moments = (*moments, Moment.of_frame(SmallGrey(image, 1.0), position, size))
    return moving_edges(moments, EXTENT)


@pytest.mark.parametrize("pan", [0, -3])
@pytest.mark.parametrize(("speed", "rise"), [(6, 0), (-6, 0), (6, 3), (-6, -3), (4, -3)])
def test_the_edges_are_those_of_the_vehicle(speed, rise, pan):
    assert found(speed=speed, rise=rise, pan=pan) == pytest.approx(np.zeros((2, 2)), abs=CELL)


@pytest.mark.parametrize("off", [-8, 8])
def test_a_box_beside_the_vehicle_has_its_edges_at_the_vehicle(off):
    edges = found(off=off)
    assert edges[:, 0] == pytest.approx([off / WIDE, -off / WIDE], abs=CELL)


def test_a_plain_vehicle_shows_by_its_rims():
    edges = found(body=np.full((TALL, WIDE), 20, np.uint8), wide=32, off=4)
    assert edges[:, 0] == pytest.approx([4 / 32, 4 / 32], abs=1.5 * CELL)


def test_a_side_that_is_out_of_view_has_no_edge():
    """From 1 to 13 px beside the border, while the cells go on for .4 of the width, 16 px."""
    edges = found(left=1)
    assert np.isnan(edges[0, 0])
    assert edges[1, 0] == pytest.approx(0, abs=CELL)


def test_what_only_moves_with_the_road_has_no_edges():
    assert np.isnan(found(body=ROAD[40:60, 60:100], speed=0, pan=0)).all()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Roads that speeds are measured on are those of the scene's camera, and scenes take turns."""

import numpy as np
import pytest

from laboratory.road_speed import roads_of, settings_of
from laboratory.scenes.road import RoadSceneParameters, camera_of


@pytest.mark.parametrize("mount", ["gantry", "mast"])
def test_the_roads_of_a_scene_are_those_of_its_camera(mount):
    camera = camera_of(RoadSceneParameters(mount=mount, lens="barrel"), 3)
    roads = roads_of(camera, 3)
    points = np.array([[0.0, 30.0], [2.0, 60.0]])
    pixels = camera.plane.to_image(points)
    exact = roads["camera"].plane(roads["camera"].lens, roads["camera"].pose)
    assert exact.to_road(pixels) == pytest.approx(points, abs=1e-6)
    read = roads["pairs"].plane(roads["pairs"].lens, None)
    assert read.to_road(pixels) == pytest.approx(points, abs=0.8)
    assert not np.allclose(read.to_road(pixels), points, atol=1e-3)


def test_scenes_take_turns():
    scenes = [settings_of(50.0, number) for number in range(12)]
    kinds = {(one.vehicle, one.heading, one.mount, one.lens) for one in scenes}
    assert len(kinds) == 12

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Geometry of the road in perspective: what is drawn is where the camera's own map says."""

import numpy as np
import pytest

from laboratory.scenes.road import KMH, RoadSceneParameters, camera_of, road
from vehicle_pf_tracker.core.truth import Occlusion


@pytest.mark.parametrize("mount", ["gantry", "mast"])
@pytest.mark.parametrize("lens", ["none", "barrel"])
def test_points_are_projected_as_the_plane_maps_them(mount, lens):
    camera = camera_of(RoadSceneParameters(mount=mount, lens=lens), 3)
    road_points = np.array([[0.0, 30.0], [-3.5, 60.0], [3.0, 24.0]])
    pixels = camera.project(np.column_stack([road_points, np.zeros(3)]))
    assert camera.plane.to_road(pixels) == pytest.approx(road_points, abs=1e-6)


@pytest.mark.parametrize("heading", ["coming", "going"])
def test_the_vehicle_drives_at_its_speed(heading):
    parameters = RoadSceneParameters(speed=90.0, heading=heading, frame_rate=20.0)
    scene = road(parameters, 5)
    plane = camera_of(parameters, 5).plane
    boxes = [truth.box for truth in scene.truths()]
    feet = np.array([[box.x + box.width / 2, box.y + box.height] for box in boxes])
    y = plane.to_road(feet)[:, 1]
    assert np.all(np.diff(y) < 0) == (heading == "coming")
    # The lower edge belongs to the tyres or the bumper, as the view has it.
    seconds = (len(y) - 1) / 20
    assert abs(y[-1] - y[0]) / seconds * KMH == pytest.approx(90, rel=0.03)


def test_the_target_is_in_view_all_the_time_and_drawn_in_its_box():
    scene = road(RoadSceneParameters(speed=130.0, noise=0.0), 2)
    background = np.clip(np.rint(scene.backdrop()), 0, 255)
    for each in scene.frames():
        assert each.truth.occlusion is Occlusion.NONE
        box = each.truth.box
        window = (
            slice(round(box.y) + 1, round(box.y + box.height) - 1),
            slice(round(box.x) + 1, round(box.x + box.width) - 1),
        )
        changed = np.abs(each.frame[window] - background[window]).max(axis=-1) > 8
        assert changed.mean() > 0.6

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Solids: projection, shadows and the tight box, by hand numbers."""

import math

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import PixelWindow
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION, draw, extent, shadow, side_panel
from vehicle_pf_tracker.scenes.solids import strips as sweep
from vehicle_pf_tracker.scenes.vehicles import car, coach, lorry, saloon, suv, truck, van

GREY = (100.0, 100.0, 100.0)
VEHICLES = {
    "car": car(GREY),
    "saloon": saloon(GREY),
    "van": van(GREY),
    "suv": suv(GREY),
    "truck": truck(GREY, GREY),
    "coach": coach(GREY, GREY),
    "lorry": lorry(GREY, GREY, GREY),
}


def test_an_upright_panel_is_foreshortened_by_the_view_from_above():
    box = extent([side_panel([(1, 0), (1, 2), (4, 2), (4, 0)], 0, GREY)])
    assert (box.x, box.y, box.width, box.height) == pytest.approx(
        (1, -2 * math.cos(VIEW_ELEVATION), 3, 2 * math.cos(VIEW_ELEVATION))
    )


def test_a_flat_roof_is_as_high_as_its_depth_seen_from_above():
    box = extent(sweep([(0, 1), (3, 1)], 0, 2, GREY))
    assert (box.width, box.height) == pytest.approx((3, 2 * math.sin(VIEW_ELEVATION)))


def test_a_shadow_lies_on_the_ground_and_falls_towards_the_viewer_and_to_the_left():
    (cast,) = shadow([side_panel([(0, 0), (0, 2), (4, 2), (4, 0)], 0, GREY)])
    points = np.array(cast.points)
    assert not points[:, 2].any()
    np.testing.assert_allclose(points[0], (0, 0, 0))
    np.testing.assert_allclose(points[1], (-2 * 0.35 / 0.85, -2 * 0.4 / 0.85, 0))


@pytest.mark.parametrize("name", VEHICLES)
def test_a_silhouette_touches_all_sides_of_its_box(name):
    faces = VEHICLES[name]
    bounds = extent(faces)
    width, height = 10 * bounds.width, 10 * bounds.height
    box = Box(0, 0, width, height)
    seen = draw(faces, width, height).coverage(box, PixelWindow.of(box, 999, 999))
    for side in (seen[0], seen[-2:], seen[:, 0], seen[:, -2:]):
        assert side.max() > 0.1
    assert 0.7 < seen.sum() / box.area <= 1

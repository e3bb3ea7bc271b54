# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies of vehicles among what has changed."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.bodies import LEAST_EDGE, REACH, bodies

STRONG = 3 * LEAST_EDGE


def changed(*boxes):
    mask = np.zeros((120, 160), np.uint8)
    for left, top, right, bottom in boxes:
        mask[top:bottom, left:right] = 1
    return mask


def outline(box, strength=STRONG):
    """Edges one px wide around a box."""
    left, top, right, bottom = box
    edges = np.zeros((120, 160), np.float32)
    edges[[top, bottom - 1], left:right] = strength
    edges[top:bottom, [left, right - 1]] = strength
    return edges


def box_of(mask):
    rows, columns = np.nonzero(mask)
    return columns.min(), rows.min(), columns.max() + 1, rows.max() + 1


def test_nothing_that_changed_is_nothing():
    assert not bodies(changed(), np.zeros((120, 160), np.float32)).any()


def test_light_has_no_edges_and_is_no_body():
    assert not bodies(changed((40, 30, 80, 70)), np.zeros((120, 160), np.float32)).any()


def test_a_roof_is_enclosed_by_its_edges():
    box = (30, 20, 110, 90)
    mask = bodies(changed(box), outline(box))
    assert box_of(mask) == pytest.approx(box, abs=1)
    assert mask[50:60, 60:80].all()


@pytest.mark.parametrize(
    ("box", "open_side"),
    [
        ((0, 30, 60, 90), np.s_[31:89, 0]),
        ((90, 40, 160, 100), np.s_[41:99, 159]),
        ((30, 60, 100, 120), np.s_[119, 31:99]),
    ],
)
def test_the_border_may_cut_an_outline_open(box, open_side):
    edges = outline(box)
    edges[open_side] = 0
    mask = bodies(changed(box), edges)
    assert mask[(box[1] + box[3]) // 2, (box[0] + box[2]) // 2]
    assert box_of(mask) == pytest.approx(box, abs=1)


def test_light_before_a_vehicle_is_cut_off():
    vehicle = (40, 20, 80, 60)
    mask = bodies(changed(vehicle, (40, 60, 80, 100)), outline(vehicle))
    reach = round(REACH * np.sqrt(40 * 80))
    assert box_of(mask) == pytest.approx((40, 20, 80, 60 + reach), abs=1)


def test_edges_of_large_vehicles_may_be_weaker():
    small, large = (100, 20, 125, 45), (10, 10, 90, 110)
    weak = 0.6 * LEAST_EDGE
    assert not bodies(changed(small), outline(small, weak)).any()
    assert box_of(bodies(changed(large), outline(large, weak))) == pytest.approx(large, abs=1)

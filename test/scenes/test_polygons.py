# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Filled polygons, by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.scenes.compositing import PixelWindow, cells_inside


def filled(corners, rows=8, columns=10):
    grid = np.zeros((rows, columns), bool)
    window, inside = cells_inside(np.array(corners, float), rows, columns)
    grid[window.slices] = inside
    return grid


@pytest.mark.parametrize("turn", [1, -1])
def test_a_rectangle_on_cell_edges_fills_its_cells(turn):
    grid = filled([(2, 1), (6, 1), (6, 4), (2, 4)][::turn])
    assert grid[1:4, 2:6].all()
    assert grid.sum() == 12


def test_a_cell_belongs_to_the_polygon_that_has_its_centre():
    assert filled([(2.6, 1), (6.4, 1), (6.4, 2), (2.6, 2)])[1].nonzero()[0].tolist() == [3, 4, 5]


def test_two_polygons_that_share_an_edge_share_no_cell_and_leave_no_gap():
    upper, lower = filled([(0, 0), (8, 0), (8, 8)]), filled([(0, 0), (8, 8), (0, 8)])
    assert not (upper & lower).any()
    assert (upper | lower)[:, :8].all()


def test_a_notch_stays_empty():
    grid = filled([(0, 0), (9, 0), (9, 6), (6, 6), (6, 2), (3, 2), (3, 6), (0, 6)])
    assert grid.sum() == 9 * 6 - 3 * 4
    assert not grid[2:6, 3:6].any()


def test_what_lies_outside_the_grid_is_clipped():
    assert filled([(-5, -5), (50, -5), (50, 50), (-5, 50)]).all()
    window, inside = cells_inside(np.array([(2.2, 3.1), (4.2, 3.1), (4.2, 3.3)]), 8, 10)
    assert window == PixelWindow(2, 3, 5, 4)
    assert not inside.any()


@given(st.floats(1, 30), st.floats(1, 30))
def test_area_of_an_ellipse(across, down):
    turns = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    outline = np.stack([35 + across * np.cos(turns), 35 + down * np.sin(turns)], axis=1)
    _, inside = cells_inside(outline, 70, 70)
    assert inside.sum() == pytest.approx(np.pi * across * down, abs=2.2 * (across + down))

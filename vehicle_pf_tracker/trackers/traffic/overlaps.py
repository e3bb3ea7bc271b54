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

"""Overlaps of boxes that are given by their edges: left, top, right, bottom in px."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array


def intersections(edges: Array, others: Array) -> Array:
    """Measure the common areas in px² of one box (4,) with others (N, 4)."""
    width = np.minimum(edges[2], others[:, 2]) - np.maximum(edges[0], others[:, 0])
    height = np.minimum(edges[3], others[:, 3]) - np.maximum(edges[1], others[:, 1])
    return np.asarray(np.maximum(width, 0.0) * np.maximum(height, 0.0))


def areas(edges: Array) -> Array:
    """Measure the areas in px² of boxes (..., 4), at least one."""
    sides = np.maximum(edges[..., 2:] - edges[..., :2], 0.0)
    return np.asarray(np.maximum(sides[..., 0] * sides[..., 1], 1.0))


def unions(edges: Array, others: Array) -> Array:
    """Divide intersections of one box (4,) with others (N, 4) by their unions."""
    common = intersections(edges, others)
    return np.asarray(common / (areas(edges) + areas(others) - common))


def inside_image(edges: Array, size: tuple[int, int]) -> float:
    """Measure the share of a box (4,) that lies in an image of this width and height."""
    image = np.array([[0.0, 0.0, *size]])
    return float(intersections(edges, image)[0] / areas(edges))


def clipped(edges: Array, size: tuple[int, int]) -> Array:
    """Cut boxes (N, 4) at the borders of the image, at least one px wide and high."""
    limits = np.array([*size, *size], dtype=np.float64)
    low = np.clip(edges[:, :2], 0.0, limits[:2] - 1)
    return np.hstack([low, np.maximum(np.clip(edges[:, 2:], 0.0, limits[2:]), low + 1)])

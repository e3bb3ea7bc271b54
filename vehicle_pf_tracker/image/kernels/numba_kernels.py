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

"""The kernels in numba."""

from __future__ import annotations

from typing import TypeGuard

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.colour import CHANNEL_BINS, JointColour, RgbMarginals
from vehicle_pf_tracker.image.gradients import GradientDirections
from vehicle_pf_tracker.image.kernels import numba_jit
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.kernels.numba_edges import count_directions
from vehicle_pf_tracker.image.kernels.numba_gradient_cells import gradient_cells
from vehicle_pf_tracker.image.kernels.numba_inputs import (
    CellTable,
    Placement,
    roots_up_to,
    table_of,
)
from vehicle_pf_tracker.image.kernels.numba_jit import (
    Cells,
    marginal_cells,
    pair_cells,
)
from vehicle_pf_tracker.image.kernels.numba_mean_shift import (
    Ellipse,
    Offsets,
    compare_kernels,
    ellipse,
    shift_kernels,
)
from vehicle_pf_tracker.image.kernels.numba_spectra import correlated
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Pixels,
    Reals,
    compare_counts,
    compare_joint,
    compare_windows,
    joint_cells,
)
from vehicle_pf_tracker.image.similarity import Reference
from vehicle_pf_tracker.image.textures import Cooccurrence
from vehicle_pf_tracker.image.window import (
    Coefficients,
    Positions,
    Window,
    WindowFeature,
    to_grey,
)

_COUNTED_PIXELS = {JointColour, RgbMarginals, Cooccurrence}
"""Features of which each pixel counts equally in all windows."""


class NumbaKernels(Kernels):
    """Compiled kernels; importing this module compiles them, or loads what was compiled before."""

    name = "numba"

    gradient_cells = staticmethod(gradient_cells)
    correlated = staticmethod(correlated)

    def __init__(self) -> None:
        super().__init__(numba_jit.notices())

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        if type(feature) in _COUNTED_PIXELS:
            table = table_of(reference)
            return _compare_pixels(feature, frame, positions, window, table)
        if _counts_edges(feature):
            placement, table = Placement.of(feature, frame, positions, window), table_of(reference)
            cells, totals = count_directions(feature, frame, placement, table)
            roots = roots_up_to(window.width * window.height)
            return compare_counts(cells, totals, (table.values, roots))
        return super().similarity(feature, frame, positions, window, reference)

    def kernel_similarity(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare; see `Kernels.kernel_similarity`."""
        placement = Placement.of(feature, frame, positions, window)
        return compare_kernels(*_ellipses(feature, frame, placement, window, reference))

    def mean_shift(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Positions:
        """Move; see `Kernels.mean_shift`."""
        placement = Placement.of(feature, frame, positions, window)
        steps = shift_kernels(*_ellipses(feature, frame, placement, window, reference))
        return np.where(np.isnan(steps), positions, placement.pixels + 0.5 + steps)


def _counts_edges(feature: WindowFeature) -> TypeGuard[GradientDirections]:
    """Test whether edge points of the frame's gradient are counted."""
    return type(feature) is GradientDirections and feature.in_frame


def _compare_pixels(
    feature: WindowFeature,
    frame: Frame,
    positions: Positions,
    window: Window,
    table: CellTable,
) -> Reals:
    """Compare windows by their pixels."""
    planes = 3 if type(feature) is RgbMarginals else 1
    scale = table.values, roots_up_to(planes * window.width * window.height)
    if isinstance(feature, JointColour):
        half = window.half_width, window.half_height
        return compare_joint(frame, positions, feature.bits, half, table.cells, scale)
    placement = Placement.of(feature, frame, positions, window)
    left, top, right, bottom = placement.covered()
    region = frame[top:bottom, left:right]
    if isinstance(feature, RgbMarginals):
        cells = marginal_cells(region, CHANNEL_BINS, table.cells)
    else:
        cells = pair_cells(to_grey(region), table.cells)
    return compare_windows(
        cells, placement.pixels, placement.extent, (left, top), placement.reach, scale
    )


def _ellipses(
    feature: JointColour, frame: Frame, placement: Placement, window: Window, reference: Reference
) -> tuple[Cells, Pixels, tuple[int, int], Offsets, Ellipse]:
    """Return the arguments of `compare_kernels`."""
    table = table_of(reference)
    left, top, right, bottom = placement.covered()
    cells = joint_cells(frame[top:bottom, left:right], feature.bits, table.cells)
    offsets, profile = ellipse(window)
    return cells, placement.pixels, (left, top), offsets, (profile, table.values)

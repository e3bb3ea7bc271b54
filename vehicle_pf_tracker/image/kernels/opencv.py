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

"""Kernels in OpenCV and numpy, which are always available."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image import correlation_filter, shared_motion, spectra
from vehicle_pf_tracker.image.colour import JointColour, bin_indices
from vehicle_pf_tracker.image.correlation_filter import Places
from vehicle_pf_tracker.image.gradient_cells import CellFeatures, Grey, gradient_cells
from vehicle_pf_tracker.image.kernels.interface import Kernels, PixelRange, SimilarityMap
from vehicle_pf_tracker.image.mean_shift import kernel_similarity, mean_shift
from vehicle_pf_tracker.image.shared_motion import Alive, CellBlock, Flow
from vehicle_pf_tracker.image.similarity import Reference
from vehicle_pf_tracker.image.spectra import FilterProblem, Penalty, Spectrum
from vehicle_pf_tracker.image.window import (
    Coefficients,
    Counted,
    CountedFeature,
    Positions,
    Window,
    WindowFeature,
)


class OpenCvKernels(Kernels):
    """Kernels that call the features' own methods.

    Parameters
    ----------
    notices : sequence of str
        See `Kernels`.
    """

    name = "opencv"

    def __init__(self, notices: Sequence[str] = ()) -> None:
        self.notices = notices

    def gradient_cells(self, grey: Grey, spare: int = 0) -> CellFeatures:
        """Compute gradient histograms; see `Kernels.gradient_cells`."""
        return gradient_cells(grey, spare)

    def take_filter_step(
        self, problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
    ) -> None:
        """Train a filter by one step; see `Kernels.take_filter_step`."""
        spectra.take_filter_step(problem, penalty, multiplier, confined)

    def correlated(self, spectrum: Spectrum, weights: Spectrum) -> Spectrum:
        """Correlate and sum over channels; see `Kernels.correlated`."""
        return spectra.correlated(spectrum, weights)

    def shifted(self, spectrum: Spectrum, x: float, y: float) -> Spectrum:
        """Move cells; see `Kernels.shifted`."""
        return spectra.shifted(spectrum, x, y)

    def shared_similarity(self, before: Array, after: Array) -> Array:
        """Fit a similarity; see `Kernels.shared_similarity`."""
        return shared_motion.shared_similarity(before, after)

    def staying(self, before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
        """Tell which places turn with most; see `Kernels.staying`."""
        return shared_motion.staying(before, after, alive, strayed)

    def shared_stretch(self, before: Array, after: Array, size: Array) -> Array:
        """Change of distances; see `Kernels.shared_stretch`."""
        return shared_motion.shared_stretch(before, after, size)

    def carried_share(
        self, flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
    ) -> float:
        """Share that moved with the vehicle; see `Kernels.carried_share`."""
        return shared_motion.carried_share(flow, cells, places, vehicle, background)

    def climbed(self, values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
        """Move places; see `Kernels.climbed`."""
        return correlation_filter.climbed(values, places, costs)

    def counts(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        active: npt.NDArray[np.intp],
    ) -> Counted:
        """Count windows; see `Kernels.counts`."""
        assert isinstance(feature, CountedFeature)
        return feature.counts(frame, positions, window, active)

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        return feature.similarity(frame, positions, window, reference)

    def similarity_map(
        self,
        feature: JointColour,
        frame: Frame,
        window: Window,
        reference: Reference,
        pixels: PixelRange | None = None,
    ) -> SimilarityMap:
        """Compare all windows; see `Kernels.similarity_map`."""
        width, height = frame_size(frame)
        left, top, right, bottom = pixels or PixelRange(0, 0, width, height)
        x, y = max(left - window.half_width, 0), max(top - window.half_height, 0)
        region = frame[y : bottom + window.half_height, x : right + window.half_width]
        overlap = _overlaps(bin_indices(region, feature.bits), window, reference)
        areas = _box_sums(np.ones(overlap.shape, np.uint8), window)
        rho = np.minimum(overlap / np.sqrt(areas), 1.0)
        return np.asarray(rho[top - y : bottom - y, left - x : right - x], np.float32)

    def kernel_similarity(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare; see `Kernels.kernel_similarity`."""
        histogram = reference.histogram
        return kernel_similarity(frame, positions, window, histogram, feature.bits)

    def mean_shift(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Positions:
        """Move; see `Kernels.mean_shift`."""
        return mean_shift(frame, positions, window, reference.histogram, feature.bits)


def _overlaps(
    indices: npt.NDArray[np.uint16], window: Window, reference: Reference
) -> npt.NDArray[np.float64]:
    """Sum of ``sqrt(count * value)`` over the active bins around every pixel."""
    sums = np.zeros(indices.shape)
    for number, value in zip(reference.active, reference.values, strict=True):
        counts = _box_sums((indices == number).view(np.uint8), window)
        sums += cv2.sqrt(counts * np.float32(value))
    return sums


def _box_sums(plane: npt.NDArray[np.uint8], window: Window) -> npt.NDArray[np.float32]:
    """Sum of the pixels that exist in the window around every pixel."""
    size = window.width, window.height
    sums = cv2.boxFilter(plane, cv2.CV_32F, size, normalize=False, borderType=cv2.BORDER_CONSTANT)
    return np.asarray(sums, np.float32)

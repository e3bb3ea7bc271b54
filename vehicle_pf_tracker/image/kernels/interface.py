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

"""Interface of the kernels that measure windows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.colour import JointColour
from vehicle_pf_tracker.image.correlation_filter import Places
from vehicle_pf_tracker.image.gradient_cells import CellFeatures, Grey
from vehicle_pf_tracker.image.shared_motion import Alive, CellBlock, Flow
from vehicle_pf_tracker.image.similarity import Reference
from vehicle_pf_tracker.image.spectra import FilterProblem, Penalty, Spectrum
from vehicle_pf_tracker.image.window import (
    Coefficients,
    Counted,
    CountedFeature,
    Histograms,
    Positions,
    Window,
    WindowFeature,
)

SimilarityMap: TypeAlias = npt.NDArray[np.float32]


class PixelRange(NamedTuple):
    """Pixels from `left`, `top` to before `right`, `bottom`; all inside the frame."""

    left: int
    top: int
    right: int
    bottom: int


class Kernels(ABC):
    """Measurement of windows; implementations count equally, and agree on similarities to 1e-6.

    Each gives the same bits for the same input on one machine.

    Attributes
    ----------
    name : str
        Value of the parameter `kernels` that selects them.
    notices : sequence of str
        Problems met while they were loaded, one sentence each.
    """

    name: str
    notices: Sequence[str] = ()

    @abstractmethod
    def counts(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        active: npt.NDArray[np.intp],
    ) -> Counted:
        """Count a feature that counts pixels, at some of its bins.

        Parameters
        ----------
        feature : WindowFeature
            Feature to count.
        frame : (H, W, 3) array
            RGB.
        positions : (N, 2) array
            Window centres in px; rounded and kept inside the image as in `window.bounds`.
        window : Window
            Size of all windows; over the border the pixels that exist count.
        active : (K,) array
            Bins to count, ascending.

        Returns
        -------
        Counted
            Counts of the bins (N, K), and of all bins together (N,).
        """

    def histograms(
        self, feature: WindowFeature, frame: Frame, positions: Positions, window: Window
    ) -> Histograms:
        """Describe windows; see `WindowFeature.histograms`."""
        if not isinstance(feature, CountedFeature):
            return feature.histograms(frame, positions, window)
        return self.counts(feature, frame, positions, window, np.arange(feature.bins)).histograms

    @abstractmethod
    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows with a reference.

        Parameters
        ----------
        feature, frame, positions, window
            As for `counts`; any feature is accepted.
        reference : Reference
            Histogram of this feature.

        Returns
        -------
        (N,) array
            Bhattacharyya coefficients, 0 to 1.
        """

    @abstractmethod
    def similarity_map(
        self,
        feature: JointColour,
        frame: Frame,
        window: Window,
        reference: Reference,
        pixels: PixelRange | None = None,
    ) -> SimilarityMap:
        """Compare the windows around all pixels of a range with a reference.

        Parameters
        ----------
        feature, frame, window, reference
            As for `similarity`.
        pixels : PixelRange, optional
            Where the windows' centres lie; the whole frame if left out.

        Returns
        -------
        (bottom - top, right - left) array of float32
            Bhattacharyya coefficients, 0 to 1.
        """

    @abstractmethod
    def kernel_similarity(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare kernel-weighted histograms with a reference; see `image.mean_shift`."""

    @abstractmethod
    def mean_shift(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Positions:
        """Move every position one mean-shift step; see `image.mean_shift`."""

    @abstractmethod
    def gradient_cells(self, grey: Grey, spare: int = 0) -> CellFeatures:
        """Compute histograms of oriented gradients; see `image.gradient_cells`."""

    @abstractmethod
    def take_filter_step(
        self, problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
    ) -> None:
        """Train a filter by one step; see `image.spectral_products`."""

    @abstractmethod
    def correlated(self, spectrum: Spectrum, weights: Spectrum) -> Spectrum:
        """Correlate and sum over channels; see `image.spectral_products`."""

    @abstractmethod
    def shifted(self, spectrum: Spectrum, x: float, y: float) -> Spectrum:
        """Move cells by (x, y); see `image.spectral_products`."""

    @abstractmethod
    def shared_similarity(self, before: Array, after: Array) -> Array:
        """Fit a similarity to points (N, 2); see `image.shared_motion`."""

    @abstractmethod
    def staying(self, before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
        """Tell which places (N, 2) turn with most; see `image.shared_motion`."""

    @abstractmethod
    def shared_stretch(self, before: Array, after: Array, size: Array) -> Array:
        """Change of the distances of points (N, 2); see `image.shared_motion`."""

    @abstractmethod
    def carried_share(
        self, flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
    ) -> float:
        """Share of a box that has moved with its vehicle; see `image.shared_motion`."""

    @abstractmethod
    def climbed(self, values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
        """Move places to the best value in reach; see `image.climbing`."""

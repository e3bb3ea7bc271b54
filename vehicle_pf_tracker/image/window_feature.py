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

"""Interface of image features: histograms of windows, and their similarity."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.similarity import Reference, bhattacharyya_coefficient
from vehicle_pf_tracker.image.window import Positions, Window

Grey: TypeAlias = npt.NDArray[np.uint8]
Histograms: TypeAlias = npt.NDArray[np.float64]
Coefficients: TypeAlias = npt.NDArray[np.float64]


class Counted(NamedTuple):
    """Counts of chosen bins (N, K), and of all bins together (N,)."""

    bins: npt.NDArray[Any]
    totals: npt.NDArray[Any]

    @property
    def histograms(self) -> Histograms:
        """Counts relative to all; zero where nothing was counted."""
        return np.asarray(self.bins / np.maximum(self.totals, 1)[:, np.newaxis])

    def coefficients(self, values: Histograms) -> Coefficients:
        """Bhattacharyya coefficient of each row with a reference's `values` (K,), shape (N,)."""
        overlap = np.sqrt(self.bins * values).sum(axis=1)
        return np.asarray(np.minimum(overlap / np.sqrt(np.maximum(self.totals, 1)), 1.0))


class WindowFeature(ABC):
    """A feature that describes each window by a histogram."""

    @property
    @abstractmethod
    def bins(self) -> int:
        """Number of bins."""

    @abstractmethod
    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows.

        Parameters
        ----------
        frame : (H, W, 3) array
            RGB.
        positions : (N, 2) array
            Window centres in px.
        window : Window
            Size of all windows; over the border the pixels that exist count.

        Returns
        -------
        (N, bins) array
            Each row sums to one, or is all zero where a window has nothing to count.
        """

    def similarity(
        self, frame: Frame, positions: Positions, window: Window, reference: Reference
    ) -> Coefficients:
        """Bhattacharyya coefficient of each window with `reference`, shape (N,), 0 to 1.

        Parameters
        ----------
        frame, positions, window
            As in `histograms`.
        reference : Reference
            One histogram; all zero is similar to nothing.
        """
        histograms = self.histograms(frame, positions, window)
        return bhattacharyya_coefficient(histograms, reference.histogram)


class CountedFeature(WindowFeature):
    """A feature whose histograms count pixels, so that only some bins need be counted."""

    @abstractmethod
    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count the ascending bins `active`, and all bins together."""

    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows; see `WindowFeature.histograms`."""
        return self.counts(frame, positions, window, np.arange(self.bins)).histograms

    def similarity(
        self, frame: Frame, positions: Positions, window: Window, reference: Reference
    ) -> Coefficients:
        """Compare windows by the bins of `reference` alone; see `WindowFeature.similarity`."""
        if len(reference.active) == 0:
            return np.zeros(len(positions))
        counted = self.counts(frame, positions, window, reference.active)
        return counted.coefficients(reference.values)


def to_grey(pixels: Frame) -> Grey:
    """Grey levels of RGB pixels, shape (H, W)."""
    return np.asarray(cv2.cvtColor(np.ascontiguousarray(pixels), cv2.COLOR_RGB2GRAY), np.uint8)

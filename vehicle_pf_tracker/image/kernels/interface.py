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

"""Interface of the kernels that measure windows, and its implementation in OpenCV and numpy."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image import (
    gradient_cells,
    mean_shift,
    spectra,
)
from vehicle_pf_tracker.image.colour import JointColour
from vehicle_pf_tracker.image.similarity import Reference
from vehicle_pf_tracker.image.window import (
    Coefficients,
    Positions,
    Window,
    WindowFeature,
)


class Kernels:
    """Measurement of windows by OpenCV and numpy, which are always available.

    Subclasses do the same faster, and agree on similarities to 1e-6. Each class
    gives the same bits for the same input on one machine. What needs no window is a function of
    another module, bound to the class.

    Parameters
    ----------
    notices : sequence of str
        Problems met while the kernels were loaded, one sentence each.

    Attributes
    ----------
    name : str
        Value of the parameter `kernels` that selects them.
    """

    name = "opencv"

    gradient_cells = staticmethod(gradient_cells.gradient_cells)
    correlated = staticmethod(spectra.correlated)

    def __init__(self, notices: Sequence[str] = ()) -> None:
        self.notices = notices

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
        feature : WindowFeature
            Feature to compare by.
        frame : (H, W, 3) array
            RGB.
        positions : (N, 2) array
            Window centres in px; rounded and kept inside the image as in `window.bounds`.
        window : Window
            Size of all windows; over the border the pixels that exist count.
        reference : Reference
            Histogram of this feature.

        Returns
        -------
        (N,) array
            Bhattacharyya coefficients, 0 to 1.
        """
        return feature.similarity(frame, positions, window, reference)

    def kernel_similarity(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare kernel-weighted histograms with a reference; see `image.mean_shift`."""
        histogram = reference.histogram
        return mean_shift.kernel_similarity(frame, positions, window, histogram, feature.bits)

    def mean_shift(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Positions:
        """Move every position one mean-shift step; see `image.mean_shift`."""
        return mean_shift.mean_shift(frame, positions, window, reference.histogram, feature.bits)

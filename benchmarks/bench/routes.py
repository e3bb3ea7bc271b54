# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The ways that this package measures windows: with numba, and with OpenCV and numpy alone."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.bench.naive import ThreeHistograms
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.interface import Kernels, load_kernels
from vehicle_pf_tracker.image.windows.colour import JointColour, RgbMarginals
from vehicle_pf_tracker.image.windows.gradients import GradientDirections
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.textures import Cooccurrence
from vehicle_pf_tracker.image.windows.window import Positions, Window

_THREE = RgbMarginals(), GradientDirections(), Cooccurrence()
"""The three features of `mfpf`."""


class Route(NamedTuple):
    """Kernels under the first word of their cases' names."""

    name: str
    kernels: Kernels

    def joint(
        self, frame: Frame, positions: Positions, window: Window, reference: Reference
    ) -> Array:
        """Similarity of the 512-bin histograms, shape (N,)."""
        return self.kernels.similarity(JointColour(3), frame, positions, window, reference)

    def three(
        self, frame: Frame, positions: Positions, window: Window, references: list[Reference]
    ) -> Array:
        """Similarities of P2's three features, shape (3, N)."""
        return np.array(
            [
                self.kernels.similarity(feature, frame, positions, window, reference)
                for feature, reference in zip(_THREE, references, strict=True)
            ]
        )


def three_references(histograms: ThreeHistograms) -> list[Reference]:
    """Make the references that `Route.three` takes."""
    return [Reference(histogram) for histogram in histograms]


def routes() -> list[Route]:
    """Return the routes that work here: that of numba too, if it is installed."""
    best = load_kernels("auto")
    ways = [Route("kernel", best)] if best.name == "numba" else []
    return [*ways, Route("kernel-opencv", load_kernels("opencv"))]

"""The ways that this package measures windows: with numba, and with OpenCV and numpy alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from benchmarks.bench.naive import ThreeHistograms
from vehicle_pf_tracker.features import colour_kernel
from vehicle_pf_tracker.features.colour import Histogram
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.glcm import Cooccurrence
from vehicle_pf_tracker.features.gradients import GradientDirections
from vehicle_pf_tracker.features.rgb_marginals import RgbMarginals
from vehicle_pf_tracker.features.similarity import Array
from vehicle_pf_tracker.features.window import Positions, Window


class Route(NamedTuple):
    """One implementation of the kernels, made ready."""

    name: str

    def joint(
        self, frame: Frame, positions: Positions, window: Window, reference: Histogram
    ) -> Array:
        """Similarity of the 512-bin histograms, shape (N,)."""
        return colour_kernel.joint_similarity(frame, positions, window, reference, 3)

    def three(
        self, frame: Frame, positions: Positions, window: Window, references: ThreeHistograms
    ) -> Array:
        """Similarities of P2's three features, shape (3, N)."""
        features = RgbMarginals(), GradientDirections(), Cooccurrence()
        return np.array(
            [
                feature.similarity(frame, positions, window, reference)
                for feature, reference in zip(features, references, strict=True)
            ]
        )


def routes() -> Mapping[str, Route]:
    """Return the routes that work here, by the first word of their cases' names."""
    return {"kernel-opencv": Route("opencv")}

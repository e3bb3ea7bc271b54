# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images whose features are known by hand, and the features that every test takes part in."""

import numpy as np

from vehicle_pf_tracker.image.windows.colour import JointColour, RgbMarginals
from vehicle_pf_tracker.image.windows.gradients import GradientDirections
from vehicle_pf_tracker.image.windows.textures import (
    BinaryPatterns,
    Cooccurrence,
    HaralickStatistics,
)

FEATURES = {
    "joint": JointColour(),
    "color": RgbMarginals(),
    "edge": GradientDirections(),
    "edge 80 %": GradientDirections(threshold=0.8),
    "edge unsigned": GradientDirections(signed=False),
    "edge in window": GradientDirections(in_frame=False),
    "glcm": Cooccurrence(),
    "lbp": BinaryPatterns(),
    "haralick": HaralickStatistics(),
}


def grey(levels):
    return np.asarray(levels, np.uint8)[..., np.newaxis].repeat(3, axis=2)


def step_edge(height=9, width=12, dark=20, light=220):
    """Dark to the left of column 6, light from there on."""
    levels = np.full((height, width), dark)
    levels[:, 6:] = light
    return grey(levels)


def checkerboard(height=8, width=8, dark=0, light=255):
    rows, columns = np.indices((height, width))
    return grey(np.where((rows + columns) % 2, light, dark))


def ramp(height=8, width=16, step=16):
    """Grey level `step` times the column."""
    return grey(np.tile(np.arange(width) * step, (height, 1)))

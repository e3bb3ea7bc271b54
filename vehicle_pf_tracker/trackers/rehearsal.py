# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A rehearsal of a tracker on a synthetic image, which compiles the kernels that its step needs."""

from __future__ import annotations

from typing import Any

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.registry import Variant

_SIZE = 160, 120
"""Width and height in px: a window of the usual 40 px fits with room to search around it."""
_BOX = Box(60.0, 45.0, 40.0, 30.0)
"""Target in the middle of it: of the proportions of a car."""
_FRAMES = (True, True, False, True)
"""Visibility of the target by frame: kernels of the search after an occlusion are compiled too."""


def rehearse(variant: Variant, parameters: Any) -> None:
    """Let a tracker of its own follow, so that no image has to wait for a kernel.

    Kernels are compiled, or loaded, when they are first called; so they come in the order in which
    the step needs them, and others are left alone. A kernel that only a changed parameter needs is
    compiled when an image first needs it.

    Parameters
    ----------
    variant : Variant
        From the registry.
    parameters : dataclass
        Parameters of the variant.
    """
    width, height = _SIZE
    # Noise has edges and colours of every kind, so that no feature is empty.
    textured = np.random.default_rng(0).integers(0, 256, (height, width, 3), np.uint8)
    # A plain frame is an occlusion to every variant.
    plain = np.full_like(textured, 128)
    tracker = variant.tracker(parameters)
    tracker.start(textured, _BOX)
    for is_visible in _FRAMES:
        tracker.step(textured if is_visible else plain)

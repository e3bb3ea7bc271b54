# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Type of the images that trackers take."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.errors import InputError

Frame: TypeAlias = npt.NDArray[np.uint8]
"""RGB image, shape (height, width, 3) of uint8; contiguous or a strided view, never written to."""


def check_frame(frame: Frame) -> Frame:
    """Return `frame` itself if it is an RGB image with at least one pixel.

    Raises
    ------
    InputError
        If the shape is not (height, width, 3), the type is not uint8, or there is no pixel.
    """
    if frame.ndim != 3 or frame.shape[2] != 3 or frame.dtype != np.uint8 or frame.size == 0:
        raise InputError(
            f"a frame must be a non-empty (height, width, 3) array of uint8, "
            f"got shape {frame.shape} of {frame.dtype}"
        )
    return frame


def frame_size(frame: Frame) -> tuple[int, int]:
    """Width and height of `frame` in px."""
    return int(frame.shape[1]), int(frame.shape[0])

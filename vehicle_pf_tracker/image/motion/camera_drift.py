# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drift of a camera: a mast that shakes comes back to where it was, a camera that pans does not."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion

_FADES = 60.0
"""Periods in which a displacement fades to 1 / e: two seconds at 30 Hz, as long as sightings are
kept (`perspective.KEPT_FRAMES`)."""
_STANDS = 0.005
"""Drift below which a camera stands, fraction of the image's larger side. Where one jumps by a px
or two now and then it is mostly .002 to .004; at .01 a camera that begins to fly would stand for
too long (S0601: laboratory/notes/fusion_tried.md)."""
_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])


class CameraDrift(NamedTuple):
    """Displacement of the background over the last seconds.

    Attributes
    ----------
    corners : (4, 2) array
        Displacement of the image's corners, fractions of its larger side.
    """

    corners: Array = np.zeros((4, 2))

    def moved_on(
        self, camera: CameraMotion, elapsed: float, extent: tuple[int, int]
    ) -> CameraDrift:
        """Let `elapsed` periods pass; move with a camera whose images have this extent, px."""
        if camera.still and not self.corners.any():
            return self
        # Corners, as they move in a turn and a zoom, too.
        places = _CORNERS * np.array(extent)
        moved = (camera.apply(places) - places) / max(extent)
        return CameraDrift(self.corners * math.exp(-elapsed / _FADES) + moved)

    @property
    def stands(self) -> bool:
        """True for a camera that stands, or sways about where it stands."""
        return bool(np.abs(self.corners).max() < _STANDS)

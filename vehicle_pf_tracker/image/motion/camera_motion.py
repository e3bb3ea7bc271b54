# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion of the camera between two frames: a similarity of the background."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vehicle_pf_tracker.core.array import Array

_UPRIGHT = np.eye(2)
"""Turn of a camera that stands: shared, as most frames have it, and read only."""
_NOWHERE = np.zeros(2)
"""Shift of such a camera."""
_UPRIGHT.flags.writeable = False
_NOWHERE.flags.writeable = False


@dataclass(frozen=True, slots=True, eq=False)
class CameraMotion:
    """Movement of the background from one frame to the next: ``turn @ p + shift``.

    Attributes
    ----------
    turn : (2, 2) array
        Rotation times scale.
    shift : (2,) array
        px.
    """

    turn: Array = field(default_factory=lambda: _UPRIGHT)
    shift: Array = field(default_factory=lambda: _NOWHERE)

    def apply(self, positions: Array) -> Array:
        """Move positions (..., 2) with the background."""
        # Rows are points: the transposed matrix stands on the right.
        return np.asarray(positions @ self.turn.T + self.shift)

    def apply_to_velocities(self, velocities: Array) -> Array:
        """Turn and scale velocities (..., 2) with the background."""
        return np.asarray(velocities @ self.turn.T)

    def after(self, earlier: CameraMotion) -> CameraMotion:
        """Motion of two frames, of which `earlier` is the first."""
        return CameraMotion(self.turn @ earlier.turn, self.apply(earlier.shift))

    @property
    def still(self) -> bool:
        """True if the background does not move."""
        if self.turn is _UPRIGHT and self.shift is _NOWHERE:
            return True
        (scale, across), (down, same) = self.turn.tolist()
        # Exactly: a camera that stands is reported by exactly this, see `shared_similarity`.
        return scale == same == 1 and across == down == 0 and not self.shift.any()

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimate of a tracker for one frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box

START_REGIME = "start"
"""Regime of an estimate that begins a track, by the name that tables and messages use."""


class Mode(str, Enum):
    """Claim about the target's visibility, from evidence in the image."""

    TRACKING = "TRACKING"
    OCCLUDED = "OCCLUDED"
    LOST = "LOST"


# Flat, with one field more than others have: programs of users read these names, and `~/mode` and
# the tables have them as columns.
@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """Position of the vehicle with its confidence, and the state of the filter.

    Attributes
    ----------
    position : (float, float)
        Centre of the vehicle in px, always inside the image.
    box : Box
        Box of the vehicle in px.
    velocity : (float, float)
        Velocity in px per nominal frame period.
    mode : Mode
        Visibility of the vehicle at `position`, by the evidence there.
    regime : str
        Branch that the paper's algorithm is in; not an occlusion detector.
    confidence : float
        Evidence relative to its clear level, 0 to 1; 0 where the weights carried no information.
    similarities : mapping of str to float
        Similarities that the algorithm decides by, each 0 to 1; ratios of two (`lc_*`) may be
        larger.
    effective_sample_size : float
        Effective number of particles before resampling, 1 to N.
    resampling_passes, resampled_particles : int
        Number of resamplings in the step, and of particles that they replaced.
    particles : (N, 2) array
        Positions of the particles in px; read-only view.
    weights : (N,) array
        Normalised weights; read-only view.
    duration : float
        Time that the step took, in s.
    """

    position: tuple[float, float]
    box: Box
    velocity: tuple[float, float]
    mode: Mode
    regime: str
    confidence: float
    similarities: Mapping[str, float]
    effective_sample_size: float
    resampling_passes: int
    resampled_particles: int
    particles: Array = field(repr=False)
    weights: Array = field(repr=False)
    duration: float = 0.0

    @property
    def begins(self) -> bool:
        """True of the first estimate of a target."""
        return self.regime == START_REGIME

    def scalars(self) -> Mapping[str, float | int | str]:
        """Return every scalar by the name that `~/mode` and the tables use."""
        return MappingProxyType(
            {
                "mode": self.mode.value,
                "regime": self.regime,
                "x": self.position[0],
                "y": self.position[1],
                "width": self.box.width,
                "height": self.box.height,
                "velocity_x": self.velocity[0],
                "velocity_y": self.velocity[1],
                "confidence": self.confidence,
                **self.similarities,
                "n_eff": self.effective_sample_size,
                "resampling_passes": self.resampling_passes,
                "resampled_particles": self.resampled_particles,
                "num_particles": len(self.weights),
                "step_ms": self.duration * 1e3,
            }
        )


def read_only(array: Array) -> Array:
    """Return a view of `array` that cannot be written through."""
    view: Array = array.view()
    view.flags.writeable = False
    return view

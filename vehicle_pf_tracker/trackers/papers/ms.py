# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`ms`: mean shift, the kernel-based tracker of Comaniciu et al. 2003 (P1's [27]).

From the last position, step to the mean of the window's pixels, each weighted by how much the
target has more of its colour than the window has, until a step is shorter than a pixel. Nothing is
drawn at random: the cloud is the position itself. It has no occlusion branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.similarity import Reference, hellinger_distance
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.trackers.base import BaseTracker, Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import VELOCITY_WINDOW
from vehicle_pf_tracker.trackers.papers.shared import MeanVelocity, histogram_bits_parameter
from vehicle_pf_tracker.trackers.parameters import CommonParameters


@dataclass(frozen=True, slots=True)
class MsParameters(CommonParameters):
    """Parameters of `ms`."""

    histogram_bits: int = histogram_bits_parameter(tuned=True)
    iterations: int = parameter(
        15, "More: vehicles that moved further are still reached, where steps stay long.",
        bounds=(1, 100), source="Comaniciu 2003 section 4.2 (at most 20)", tuned=True,
    )  # fmt: skip
    shortest_step: float = parameter(
        1.0, "Lower: more steps until the position counts as found.", bounds=(0.01, 100.0),
        unit="px", source="Comaniciu 2003 section 4.2 (epsilon)", tuned=True,
    )  # fmt: skip


class MsTracker(BaseTracker[MsParameters]):
    """Mean-shift tracking; step 5 of the paper (halve a step that overshoots) is left out.

    The paper finds that step needed in one of a thousand cases.
    """

    def __init__(self, parameters: MsParameters) -> None:
        super().__init__(parameters)
        self.reference = Reference(np.zeros(0))
        self._velocity = MeanVelocity(VELOCITY_WINDOW)

    def _learn(self) -> None:
        bits = self._settings.histogram_bits
        # The target model (eq. 2): its kernel counts the border least, where windows hold road.
        self.reference = self.target.kernel_reference(self.window, bits)

    def _scatter(self, centre: tuple[float, float]) -> Array:
        self._velocity = MeanVelocity(VELOCITY_WINDOW)
        # One particle: the search follows the slope from where the vehicle was, and draws nothing.
        return np.asarray([centre])

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: step from the last position until a step is short (steps 2 to 4)."""
        settings = self._settings
        place = self._cloud.positions
        measured_by = self.window, self.reference, settings.histogram_bits
        # Steps 2 to 4; the bound ends the rare walks between two places of one weight.
        for _ in range(settings.iterations):
            last = place
            place = self.kernels.mean_shift(frame, place, *measured_by)
            if np.hypot(*(place - last)[0]) < settings.shortest_step:
                break
        cloud = Cloud.uniform(place)
        position = cloud.mean()
        # Steps use the weights of pixels only: the similarity is not known before the end.
        rho = self.kernels.kernel_similarity(frame, place, *measured_by)
        similarity = float(1.0 - hellinger_distance(rho)[0])
        self._velocity.add(self._cloud.mean(), position, elapsed)
        return Outcome(
            cloud, position, self._velocity.value, "regular", similarity, {"pi": similarity}
        )

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`hpfms`: the hybrid of particle filter and mean shift of Maggio and Cavallaro 2005 (P1's [17]).

Few particles are spread according to the vehicle's speed and the confidence in the last frame. Each
then climbs a few mean-shift steps to a maximum near it, so that few are enough. It has no
occlusion branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import log_likelihood
from vehicle_pf_tracker.trackers.parameters import particles_parameter


@dataclass(frozen=True, slots=True)
class TransitionParameters:
    """Adaptation of the particles' spread, of which `sigma` is the minimum."""

    speed_share: float = parameter(
        1.0, "Higher: fast vehicles are searched for further away; 0 spreads by sigma alone.",
        bounds=(0.0, 10.0), unit="of the speed", source="Maggio 2005 section 3", tuned=True,
    )  # fmt: skip
    widest: float = parameter(
        2.0, "Higher: the spread grows more after an estimate of low similarity; 1: never.",
        bounds=(1.0, 20.0), unit="times", source="Maggio 2005 section 3",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class HpfmsParameters(ColourParameters):
    """Parameters of `hpfms`."""

    num_particles: int = particles_parameter(
        25, "More: steadier estimates, at more time per frame; mean shift makes few enough.",
        source="Maggio 2005 section 4",
    )  # fmt: skip
    iterations: int = parameter(
        3, "More: particles come closer to a maximum, and nearer to each other.", bounds=(0, 100),
        source="Maggio 2005 section 2", tuned=True,
    )  # fmt: skip
    transition: TransitionParameters = group(TransitionParameters)


class HpfmsTracker(ColourTracker[HpfmsParameters]):
    """The hybrid filter; its histograms are weighted with mean shift's kernel."""

    def __init__(self, parameters: HpfmsParameters) -> None:
        super().__init__(parameters)
        self._evidence = 0.0

    def _learn(self) -> None:
        # Mean shift needs a histogram that changes smoothly with the position, which a kernel that
        # falls to 0 at the window's border makes.
        bits = self._settings.histogram_bits
        self.reference = self.target.kernel_reference(self.window, bits)

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: resample, spread by speed and confidence, climb by mean shift, weigh."""
        settings = self._settings
        parents = self._resample(self._cloud)
        particles, left_image = self._diffuse(frame, parents, self.spread() * elapsed)
        measured_by = self.window, self.reference, settings.histogram_bits
        # Mean shift takes each particle to the next maximum, so that 25 do for hundreds.
        for _ in range(settings.iterations):
            particles = self.kernels.mean_shift(frame, particles, *measured_by)
        rho = self.similarity(frame, particles)
        cloud = Cloud(particles, *from_log(log_likelihood(rho, settings.likelihood)))
        outcome = self._report(frame, cloud, elapsed, left_image=left_image)
        # Kept for the next frame, whose spread it decides.
        self._evidence = outcome.evidence
        return outcome

    def spread(self) -> float:
        """Adaptive transition model: the Normal's sigma in px per nominal frame."""
        settings = self._settings
        transition = settings.transition
        speed = float(np.hypot(*self._velocity.value))
        # After the start there is no clear level yet: the speed is unknown, and the spread wide.
        confidence = self._judge.confidence(self._evidence)
        # Bounded: after a lost frame the confidence is near 0, and the spread must not fill the
        # image, where 25 particles are too few.
        widening = 1.0 / max(confidence, 1.0 / transition.widest)
        return widening * max(settings.sigma, transition.speed_share * speed)

    def similarity(self, frame: Frame, positions: Array) -> Array:
        """Bhattacharyya coefficient of each window with the reference, shape (N,)."""
        bits = self._settings.histogram_bits
        return self.kernels.kernel_similarity(frame, positions, self.window, self.reference, bits)

# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters that variants have in common."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TypeVar

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels.interface import KERNEL_CHOICES, load_kernels
from vehicle_pf_tracker.parameters.table import group, parameter

share = functools.partial(parameter, bounds=(0.0, 1.0))
"""Make a parameter from 0 to 1."""
particles_parameter = functools.partial(parameter, bounds=(1, 100_000))
"""Make the number of particles."""
_side = functools.partial(parameter, 0.0, bounds=(0.0, 4096.0), unit="px", effect="relearns")


frame_rate_parameter = functools.partial(
    parameter, 0.0,
    "Nominal rate that speeds in px per frame refer to; 0 takes the median of the first ten "
    "intervals.",
    bounds=(0.0, 1000.0), unit="1/s",
)  # fmt: skip
"""Make the nominal rate of the images."""


@dataclass(frozen=True, slots=True)
class WindowParameters:
    """Size of the window that features are taken from."""

    width: float = _side(
        "Wider: more of the surroundings count as the target; 0 takes the target box's width."
    )
    height: float = _side(
        "Higher: more of the surroundings count as the target; 0 takes the target box's height."
    )


@dataclass(frozen=True, slots=True)
class EvidenceParameters:
    """Thresholds of the evidence, relative to its clear level."""

    occluded_below: float = share(
        0.7, "Lower: deeper occlusions are needed before the mode leaves TRACKING.",
        unit="share of the clear level",
    )  # fmt: skip
    clear_above: float = share(
        0.8,
        "Higher: more of the vehicle must be visible again before the mode returns to TRACKING.",
        unit="share of the clear level",
    )
    minimum: float = share(
        0.3, "Similarity below which there is no evidence, whatever the clear level is."
    )
    level_rate: float = share(
        0.05, "Higher: the clear level follows the similarity faster.", unit="per frame",
    )  # fmt: skip

    def validate(self) -> None:
        """Check that the two thresholds are in order."""
        if self.occluded_below > self.clear_above:
            raise InputError(
                f"evidence.occluded_below ({self.occluded_below:g}) must not be above "
                f"evidence.clear_above ({self.clear_above:g})"
            )


ParametersT = TypeVar("ParametersT", bound="CommonParameters")


@dataclass(frozen=True, slots=True)
class CommonParameters:
    """Parameters of every variant."""

    seed: int = parameter(
        0, "Same seed, frames and parameters give the same estimates; -1 draws one and reports it.",
        bounds=(-1, 2**31 - 1), effect="restarts",
    )  # fmt: skip
    frame_rate: float = frame_rate_parameter()
    lost_after: float = parameter(
        5.0, "Longer: the mode stays OCCLUDED longer before it becomes LOST.",
        bounds=(0.0, 86_400.0), unit="s",
    )  # fmt: skip
    kernels: str = parameter(
        "auto",
        "Code that measures windows: numba is several times faster, opencv always available; "
        "auto takes numba where it is installed. Estimates may differ in their last digits.",
        choices=KERNEL_CHOICES,
    )
    window: WindowParameters = group(WindowParameters)
    evidence: EvidenceParameters = group(EvidenceParameters)

    def effective(self: ParametersT) -> ParametersT:
        """Return the effective parameters: as printed where `as_printed` is set."""
        return self.printed() if getattr(self, "as_printed", False) else self

    def printed(self: ParametersT) -> ParametersT:
        """Return the parameters with every choice that the paper prints."""
        return self

    def validate(self) -> None:
        """Check parameters against each other, and that the kernels are available."""
        self.evidence.validate()
        if self.kernels == "numba":
            load_kernels(self.kernels)


@dataclass(frozen=True, slots=True)
class ParticleParameters(CommonParameters):
    """Parameters of every particle filter."""

    num_particles: int = particles_parameter(
        200, "More: steadier estimates, at more time per frame."
    )

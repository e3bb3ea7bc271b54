# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Contract of all variants: a frame goes in, an estimate comes out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.choice import CHOICES, load_kernels
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.evidence import EvidenceParameters


@dataclass(frozen=True, slots=True)
class WindowParameters:
    """Size of the window that features are taken from."""

    width: float = parameter(
        0.0,
        "Wider: more of the surroundings count as the target; 0 takes the target box's width.",
        minimum=0.0,
        maximum=4096.0,
        unit="px",
        effect="relearns",
    )
    height: float = parameter(
        0.0,
        "Higher: more of the surroundings count as the target; 0 takes the target box's height.",
        minimum=0.0,
        maximum=4096.0,
        unit="px",
        effect="relearns",
    )


@dataclass(frozen=True, slots=True)
class CommonParameters:
    """Parameters of every variant."""

    seed: int = parameter(
        0,
        "Same seed, frames and parameters give the same estimates; -1 draws one and reports it.",
        minimum=-1,
        maximum=2**31 - 1,
        effect="restarts",
    )
    frame_rate: float = parameter(
        0.0,
        "Nominal rate that speeds in px per frame refer to; 0 takes the median of the first ten "
        "intervals.",
        minimum=0.0,
        maximum=1000.0,
        unit="1/s",
    )
    lost_after: float = parameter(
        5.0,
        "Longer: the mode stays OCCLUDED longer before it becomes LOST.",
        minimum=0.0,
        maximum=86_400.0,
        unit="s",
    )
    kernels: str = parameter(
        "auto",
        "Code that measures windows: numba is several times faster, opencv always available; "
        "auto takes numba where it is installed. Estimates may differ in their last digits.",
        choices=CHOICES,
    )
    window: WindowParameters = group(WindowParameters)
    evidence: EvidenceParameters = group(EvidenceParameters)

    def validate(self) -> None:
        """Check parameters against each other, and that the kernels are available."""
        self.evidence.validate()
        if self.kernels == "numba":
            load_kernels(self.kernels)


@dataclass(frozen=True, slots=True)
class ParticleParameters(CommonParameters):
    """Parameters of every particle filter."""

    num_particles: int = parameter(
        200,
        "More: steadier estimates, at more time per frame.",
        minimum=1,
        maximum=100_000,
    )


class Tracker(Protocol):
    """Tracker of one target through a stream of frames."""

    @property
    def seed(self) -> int:
        """Seed in use, also where the parameter asks for a drawn one."""
        ...

    frame_period: float
    """Nominal time between frames in s; the reader of the stamps keeps it up to date."""

    def start(self, frame: Frame, box: Box) -> Estimate:
        """Learn the target `box` in `frame`, with the random numbers restarted.

        Raises
        ------
        InputError
            If the box cannot be a target in this frame.
        """
        ...

    def step(self, frame: Frame, elapsed: float = 1.0) -> Estimate:
        """Find the target in the next frame, `elapsed` nominal frame periods later."""
        ...

    def reconfigure(self, parameters: Any) -> None:
        """Take new parameters between two frames; the track goes on."""
        ...

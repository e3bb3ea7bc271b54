"""Parameters of `apf` (P1), with a switch for every reading that departs from the print."""

from __future__ import annotations

from dataclasses import dataclass, replace

from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.contract import ParticleParameters
from vehicle_pf_tracker.trackers.papers.clear_level import ClearLevelParameters
from vehicle_pf_tracker.trackers.papers.likelihood import LikelihoodParameters
from vehicle_pf_tracker.trackers.papers.shared_parameters import (
    as_printed_switch,
    histogram_bits_parameter,
    resampling_parameter,
)


@dataclass(frozen=True, slots=True)
class ApfMotionParameters:
    """How particles are propagated in the two regimes."""

    sigma_w: float = parameter(
        6.0,
        "About the vehicle's speed: less loses fast vehicles, more follows look-alikes.",
        minimum=0.01,
        maximum=1000.0,
        unit="px/frame",
        source="P1 eq. 7, READINGS 11",
        tuned=True,
    )
    sigma_n: float = parameter(
        0.0,
        "Larger: occluded particles spread further across the motion; 0 takes sigma_w.",
        minimum=0.0,
        maximum=1000.0,
        unit="px/frame",
        source="P1 eq. 10",
    )
    sigma_r: float = parameter(
        0.0,
        "Larger: occluded particles drift faster along the motion; 0 takes sigma_w. "
        "Counts with drift_from_velocity off.",
        minimum=0.0,
        maximum=1000.0,
        unit="px/frame",
        source="P1 eq. 9",
    )
    drift_from_velocity: bool = parameter(
        True,
        "Drift at the vehicle's own mean speed, sigma_R = |V| / sqrt(pi / 2); off takes sigma_r.",
        source="P1 eq. 20, READINGS 11",
    )


@dataclass(frozen=True, slots=True)
class ApfReferenceParameters:
    """How the histogram that particles are held against follows the vehicle."""

    alpha: float = parameter(
        0.1,
        "Higher: the reference follows changes of the vehicle's look faster. Counts with the fixed "
        "occlusion rule.",
        minimum=0.0,
        maximum=1.0,
        source="P1 Algorithm 1 step 15",
    )
    steady_alpha: float = parameter(
        0.01,
        "Higher: as alpha, with the relative occlusion rule, which is regular in more frames.",
        minimum=0.0,
        maximum=1.0,
    )
    steady_above: float = parameter(
        0.95,
        "Higher: with the relative rule, the reference follows in fewer and better frames only.",
        minimum=0.0,
        maximum=2.0,
        unit="of Pi's clear level",
    )
    frozen_while_occluded: bool = parameter(
        True,
        "Keep the reference while occluded; off lets it learn the occluder, as printed. Counts "
        "with the fixed occlusion rule.",
        source="P1 Algorithm 1 step 15, READINGS 6",
    )


@dataclass(frozen=True, slots=True)
class ApfOcclusionParameters:
    """When the occlusion regime is entered and left."""

    rule: str = parameter(
        "relative",
        "relative holds the similarities against their own clear level; fixed against tau, as "
        "printed, which takes most of a real video for an occlusion.",
        choices=("fixed", "relative"),
        source="P1 Algorithm 1 step 4",
    )
    tau: float = parameter(
        0.8,
        "Higher: smaller changes of the histogram switch to the occlusion regime. Counts with the "
        "fixed rule.",
        minimum=0.0,
        maximum=1.0,
        source="P1 Algorithm 1 step 4, READINGS 8",
    )
    raw_histogram: bool = parameter(
        True,
        "Judge the window's own histogram; off judges the blended reference, as printed.",
        source="P1 Algorithm 1 step 16, READINGS 7",
    )
    level: ClearLevelParameters = group(ClearLevelParameters)


@dataclass(frozen=True, slots=True)
class ApfVelocityParameters:
    """The mean velocity that gives the direction of the drift."""

    window: int = parameter(
        16,
        "Longer: a steadier direction that follows turns later; 0 takes all estimates.",
        minimum=0,
        maximum=10_000,
        unit="frames",
        source="P1 section III-B, READINGS 5",
        tuned=True,
    )
    delay: int = parameter(
        12,
        "Longer: more of the estimates that an occlusion drags along before it is noticed are kept "
        "out of the drift. Counts with the relative rule, which notices later.",
        minimum=0,
        maximum=1000,
        unit="frames",
        source="READINGS 5",
    )
    from_origin: bool = parameter(
        False,
        "Count the first displacement from (0, 0), as printed.",
        source="P1 section III-B, READINGS 5",
    )
    frozen_while_occluded: bool = parameter(
        True,
        "Leave estimates of the occlusion regime out of the mean.",
        source="READINGS 5",
    )


@dataclass(frozen=True, slots=True)
class ApfParameters(ParticleParameters):
    """Parameters of `apf`."""

    as_printed: bool = as_printed_switch("READINGS 1, 5, 6, 7, 11")
    histogram_bits: int = histogram_bits_parameter()
    resampling: str = resampling_parameter("P1 Algorithm 2")
    motion: ApfMotionParameters = group(ApfMotionParameters)
    likelihood: LikelihoodParameters = group(LikelihoodParameters)
    reference: ApfReferenceParameters = group(ApfReferenceParameters)
    occlusion: ApfOcclusionParameters = group(ApfOcclusionParameters)
    velocity: ApfVelocityParameters = group(ApfVelocityParameters)

    @property
    def drift_delay(self) -> int:
        """Newest displacements that do not count for the drift yet, in frames."""
        return self.velocity.delay if self.occlusion.rule == "relative" else 0

    def effective(self) -> ApfParameters:
        """Return the parameters in force: those of the print where `as_printed` is set."""
        if not self.as_printed:
            return self
        return replace(
            self,
            likelihood=LikelihoodParameters(sigma_v=1.5, squared_distance=False),
            motion=replace(self.motion, sigma_n=0.0, sigma_r=0.0, drift_from_velocity=False),
            reference=replace(self.reference, frozen_while_occluded=False),
            occlusion=replace(self.occlusion, rule="fixed", raw_histogram=False),
            velocity=ApfVelocityParameters(
                window=0, delay=0, from_origin=True, frozen_while_occluded=False
            ),
        )
